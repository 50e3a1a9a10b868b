"""A valid scene of drogue-parachute with two canopies, and invalid variants of it."""

GOOD = """\
app = "parachute"
[fluid]
velocity = [0, 0, 5]
[grid]
cells = [40, 20, 24]
domain = [[-2, 2], [-1, 1], [-1.4, 1]]
boundary = { x = "slip", y = "slip", z = ["inflow", "outflow"] }
[[canopy]]
kind = "flat-circular"
diameter = 1.2
gores = 8
vent = 0.2
cloth = "custom"
area_density = 0.04
edge_length = 0.07
shape = "partly-closed"
closure = 0.6
angle = 0
centre = [-1, 0, 0]
lines = { length = 1.1, stiffness = 100, line_density = 0.001 }
payload = { mass = 0.5, fixed = true }
porosity = { law = "forchheimer", alpha = 10, beta = 1 }
reinforcement = { seams = 10, skirt = 10, vent = 10 }
[[canopy]]
kind = "flat-circular"
diameter = 1.2
gores = 8
edge_length = 0.07
centre = [1, 0, 0]
lines = { length = 1.1 }
[coupling]
gravity = [0, 0, -9.81]
[run]
end_time = 0.1
max_dt = 0.01
[output]
fields = ["position", "von_mises"]
[verify]
history = [{ column = "canopy_0_drag_coefficient", statistic = "mean", from = 0.05, to = 0.1, value = 1, tolerance = 1 },
  { column = "canopy_0_airspeed", statistic = "mean", from = 0.05, to = 0.1, value = 5, tolerance = 1 }]
peak_force = [{ canopy = 1, force = [1, 100], time = [0.01, 0.1] }]
force_balance = 1e-14
"""

# Replaced line, its new text, the line in the error, and words of the message.
BAD_LINES = [
    # unknown keys and names
    (8, "[[canop]]", 8, ['"canop"', 'did you mean "canopy"?']),
    (9, 'kind = "flat"', 9, ["canopy[0].kind", "flat-circular"]),
    (9, 'kynd = "flat-circular"', 9, ['"canopy[0].kynd"', "kind"]),
    (13, 'cloth = "nylon"', 13, ["canopy[0].cloth", "mil-c-7020-1"]),
    (16, 'shape = "angled-30"', 16, ["canopy[0].shape", "angled-15"]),
    (20, "lines = { lenght = 1.1 }", 20, ['"canopy[0].lines.lenght"', "length"]),
    (21, "payload = { mas = 1 }", 21, ['"canopy[0].payload.mas"', "mass"]),
    (22, 'porosity = { law = "darcy" }', 22, ["canopy[0].porosity.law", "forchheimer"]),
    (23, "reinforcement = { seam = 1 }", 23, ['"canopy[0].reinforcement.seam"', "seams"]),
    (22, "reefing = { lenght = 2.5 }", 22, ['"canopy[0].reefing.lenght"', "length"]),
    (22, "riser = { length = 1, weight = 1 }", 22, ['"canopy[0].riser.weight"']),
    (22, "vent_lines = { stifness = 100 }", 22, ['"canopy[0].vent_lines.stifness"', 'did you mean "stiffness"?']),
    # missing keys
    (22, "reefing = { cut = 1 }", 22, ['missing key "canopy[0].reefing.length"']),
    (22, "riser = { mass = 1 }", 22, ['missing key "canopy[0].riser.length"']),
    (9, 'kind = "extended-skirt"', 8, ['missing table "canopy[0].skirt"', "extended-skirt"]),
    (29, "payload = { shared = 0 }\nriser = { length = 1 }", 29, ['missing key "canopy[0].riser"', "canopy[1].payload.shared"]),
    (9, "", 8, ['missing key "canopy[0].kind"']),
    (15, "", 8, ['missing key "canopy[0].edge_length"']),
    # types and ranges
    (8, "[canopy]", 24, ["canopy", "array"]),
    (10, "diameter = 0", 10, ["canopy[0].diameter", "> 0"]),
    (11, "gores = 2", 11, ["canopy[0].gores", "3 .. 1000"]),
    (11, "gores = 8.5", 11, ["canopy[0].gores", "integer"]),
    (12, "vent = -0.1", 12, ["canopy[0].vent", ">= 0"]),
    (14, "area_density = 0", 14, ["canopy[0].area_density", "> 0"]),
    (15, "edge_length = -0.07", 15, ["canopy[0].edge_length", "> 0"]),
    (17, "closure = 1.5", 17, ["canopy[0].closure", "<= 1"]),
    (18, "angle = 270", 18, ["canopy[0].angle", "-180 .. 180"]),
    (19, "centre = [-1, 0]", 19, ["canopy[0].centre", "array of 3"]),
    (20, "lines = { length = 1.1, stiffness = 0 }", 20, ["canopy[0].lines.stiffness", "> 0"]),
    (20, "lines = { length = 1.1, strength = 0 }", 20, ["canopy[0].lines.strength", "> 0"]),
    (20, "lines = { length = 1.1, line_density = -1 }", 20, ["canopy[0].lines.line_density", ">= 0"]),
    (20, "lines = { length = 1.1, drag = { diameter = 0 } }", 20, ["canopy[0].lines.drag.diameter", "1e-06 .. 1"]),
    (20, "lines = { length = 1.1, drag = { diameter = 0.5 } }", 20, ["canopy[0].lines.drag.diameter = 0.5", "at most a cell"]),
    (20, "lines = { length = 1.1, drag = { coefficient = -1 } }", 20, ["canopy[0].lines.drag.coefficient", "0 .. 10"]),
    (20, "lines = { length = 1.1, drag = { fricton = 0.02 } }", 20, ['"canopy[0].lines.drag.fricton"', 'did you mean "friction"?']),
    (21, "payload = { drag = {} }", 21, ['missing key "canopy[0].payload.drag.area"']),
    (21, "payload = { drag = { area = 0 } }", 21, ["canopy[0].payload.drag.area", "1e-09 .. 1000000"]),
    (21, "payload = { mass = 0 }", 21, ["canopy[0].payload.mass", "> 0"]),
    (21, 'payload = { fixed = "yes" }', 21, ["canopy[0].payload.fixed"]),
    (22, 'porosity = { law = "forchheimer", alpha = -10 }', 22, ["canopy[0].porosity.alpha", ">= 0"]),
    (22, 'porosity = { law = "forchheimer", beta = -1 }', 22, ["canopy[0].porosity.beta", ">= 0"]),
    (22, 'porosity = { law = "forchheimer", alpha = 0, beta = 0 }', 22,
     ["canopy[0].porosity: alpha and beta are 0", "no obstacle", 'law = "none"']),
    (22, 'porosity = { law = "ergun", void_fraction = 1, thickness = 3e-4, grain = 1e-4 }', 22,
     ["canopy[0].porosity.void_fraction", "> 0 and < 1"]),
    (22, 'porosity = { law = "kim-peskin", pores = 1e200, conductance = 1e200 }', 22,
     ["canopy[0].porosity: alpha and beta are 0"]),
    (23, "reinforcement = { seams = -1 }", 23, ["canopy[0].reinforcement.seams", ">= 0"]),
    (12, "vent = 0", 23, ["canopy[0].reinforcement.vent", "has no vent"]),
    (18, "perturbation = { seed = 1 }", 18, ["canopy[0].perturbation.seed", "with an amplitude"]),
    (18, "perturbation = { amplitude = -1 }", 18, ["canopy[0].perturbation.amplitude", ">= 0"]),
    (18, "perturbation = { amplitude = 0.02 }", 18, ["canopy[0].perturbation.amplitude", "a quarter of edge_length, 0.0175 m"]),
    (18, "perturbation = { sede = 1 }", 18, ['"canopy[0].perturbation.sede"', 'did you mean "seed"?']),
    (18, "azimuth = 400", 18, ["canopy[0].azimuth", "-360 .. 360"]),
    (21, "payload = { release = 0 }", 21, ["canopy[0].payload.release", "> 0"]),
    (22, "reefing = { length = 2.5, cut = 0 }", 22, ["canopy[0].reefing.cut", "> 0"]),
    (22, "reefing = { length = 2.5, stiffness = 0 }", 22, ["canopy[0].reefing.stiffness", "> 0"]),
    (22, "vent_lines = { stiffness = 0 }", 22, ["canopy[0].vent_lines.stiffness", "> 0"]),
    (22, "vent_lines = { line_density = 0 }", 22, ["canopy[0].vent_lines.line_density", "> 0"]),
    (22, "riser = { length = 0 }", 22, ["canopy[0].riser.length", "> 0"]),
    (22, "riser = { length = 1, mass = 0 }", 22, ["canopy[0].riser.mass", "> 0"]),
    (21, "payload = { guided = 1 }", 21, ["canopy[0].payload.guided"]),
    (21, "payload = { fixed = true, guided = true }", 21, ["canopy[0].payload.guided", "without shared and fixed"]),
    (29, "payload = { shared = 0.5 }", 29, ["canopy[1].payload.shared", "integer"]),
    (32, 'method = "implicit"', 32, ["coupling.method", '"explicit"']),
    (32, 'method = "explicit"', 32, ["coupling.method", "canopy[0], 1.2 m", "0.468 kg/m^2", "11.7 times the 0.04 kg/m^2"]),
    (32, "allow_unstable = true", 32, ["coupling.allow_unstable", 'method = "explicit"']),
    (32, 'method = "explicit"\nallow_unstable = 1', 33, ["coupling.allow_unstable"]),
    (32, "contact = 1", 32, ["coupling.contact"]),
    (32, "contact = true\nthickness = 0", 33, ["coupling.thickness", "> 0"]),
    (32, "contact = true\nthickness = 0.1", 33, ["coupling.thickness = 0.1", "height of a triangle"]),
    (32, "thickness = 0.01", 32, ["coupling.thickness", "contact = true"]),
    (32, "gravity = 9.81", 32, ["coupling.gravity", "array of 3"]),
    (32, "gravity = [0, 0, -1e30]", 32, ["coupling.gravity: 1e+30 m/s^2", "an edge of canopy[0]", "at most 7.14e+06 m/s^2"]),
    (6, 'domain = [[-2, 2], [-1, 1], [-1.4, 1]]\nframe = "folow"', 7, ["grid.frame", '"follow"']),
    (6, 'domain = [[-2, 2], [-1, 1], [-1.4, 1]]\nframe = true', 7, ["grid.frame"]),
    # contradictions
    (6, 'domain = [[-2, 2], [-1, 1], [-1.4, 1]]\nframe = "follow"', 7, ["grid.frame", "canopy[0].payload.fixed"]),
    (12, "vent = 1.2", 12, ["canopy[0].vent = 1.2", "1.2", "smaller"]),
    (12, "vent = 1e-4", 12, ["canopy[0].vent: 0.0001 m needs some", "at most 4096, with another vent"]),
    (12, "vent = 1.1999", 12, ["canopy[0].vent: 1.2 m needs some", "with another vent"]),
    (28, "edge_length = 0.07\nvent = 0\nvent_lines = {}", 30, ["canopy[1].vent_lines", "has no vent"]),
    (13, 'cloth = "mil-c-7020-1"', 14, ["canopy[0].area_density", "custom"]),
    (15, "edge_length = 0.08", 15, ["canopy[0].edge_length = 0.08", "too coarse", "0.0714"]),
    (15, "edge_length = 1e-4", 15, ["canopy[0].edge_length", "2^20"]),
    (15, "edge_length = 1e-300", 15, ["canopy[0].edge_length", "2^20"]),
    (25, 'kind = "extended-skirt"\nskirt = { length = 2000, diameter = 1.2 }', 29, ["canopy[1].edge_length", "2^20"]),
    (16, 'shape = "flat"', 17, ["canopy[0].closure", "partly-closed"]),
    (16, 'shape = "angled-15"', 17, ["canopy[0].closure", "partly-closed"]),
    (17, "closure = 0.3", 17, ["canopy[0].closure = 0.3", "8 gores", "0.38"]),
    (19, "centre = [-1.7, 0, 0]", 19, ["canopy[0]", "along x", "between -1.9 and 1.9"]),
    (19, "centre = [-1, 0, 0.6]", 19, ["canopy[0]", "along z", "0.9"]),
    (19, "centre = [0.4, 0, 0]", 29, ["canopy[1] overlaps canopy[0]"]),
    (19, "centre = [1, 0, 0]", 29, ["canopy[1] overlaps canopy[0]"]),
    (20, "lines = { length = 0.6 }", 20, ["canopy[0].lines.length = 0.6", "payload", "0.6 m radius"]),
    (30, 'lines = { length = 1.1 }\n[[body]]\nkind = "sphere"\ncentre = [1, 0, 0.1]\nradius = 0.2\nedge_length = 0.06', 29,
     ["canopy[1] overlaps body[0]"]),
    (9, 'kind = "extended-skirt"\nskirt = { length = 0.05, diameter = 0.8 }', 10,
     ["canopy[0].skirt.length = 0.05", "at least 0.19"]),
    (9, 'kind = "guide-surface"\nskirt = { length = 0.5, diameter = 0.8 }', 17, ["canopy[0].shape", "flat-circular"]),
    (22, "skirt = { length = 1, diameter = 1 }", 22, ["canopy[0].skirt", "extended-skirt"]),
    (22, "reefing = { length = 1, cut = 0.1 }", 22, ["canopy[0].reefing.length = 1.0 m is shorter than the skirt", "2.2"]),
    (22, "reefing = { length = 2.5, cut = 0.2 }", 22, ["canopy[0].reefing.cut = 0.2 s is later than run.end_time = 0.1 s"]),
    (20, "lines = { length = 1.1, stiffness = 1e12 }", 20, ["canopy[0].lines.stiffness: 1e+12 N needs some", "at most 4096"]),
    (22, "membrane_modulus = 1e12", 22, ["canopy[0].membrane_modulus: 1e+12 N/m needs some", "run.max_dt"]),
    (22, "reefing = { length = 2.5, stiffness = 1e12 }", 22, ["canopy[0].reefing.stiffness: 1e+12 N needs some"]),
    (22, "riser = { length = 0.01, stiffness = 1e13 }", 22, ["canopy[0].riser.stiffness: 1e+13 N needs some"]),
    (22, "vent_lines = { stiffness = 1e12 }", 22, ["canopy[0].vent_lines.stiffness: 1e+12 N needs some"]),
    (23, "reinforcement = { skirt = 1e12 }", 23, ["canopy[0].reinforcement: 1e+12 N needs some"]),
    (21, "payload = { release = 0.11 }", 21, ["canopy[0].payload.release = 0.11 s is later than run.end_time = 0.1 s"]),
    (22, "reefing = { length = 5 }", 22, ["canopy[0].reefing.length = 5.0 m does not reef", "3.67"]),
    (29, "payload = { shared = 1 }\nriser = { length = 1 }", 29, ["canopy[1].payload.shared = 1", "earlier canopy"]),
    (29, "centre = [1, 0, 0]\npayload = { shared = 0 }\nriser = { length = 1 }", 29, ["canopy[1].centre", "payload.shared"]),
    (29, "payload = { shared = 0, mass = 1 }", 29, ["canopy[1].payload.mass", "without shared"]),
    (25, 'kind = "sheet"', 30, ["canopy[1].lines", "unless kind = \"sheet\""]),
    (28, "edge_length = 0.07\nmembrane_modulus = 3e4", 29, ["canopy[1].membrane_modulus", "canopy[0]"]),
    (28, "edge_length = 0.07\npoisson = 0.2", 29, ["canopy[1].poisson", "canopy[0]"]),
    # checks
    (39, 'history = [{ column = "canopy_2_drag_coefficient", statistic = "mean", from = 0.05, to = 0.1, value = 1, tolerance = 1 },', 39,
     ['verify.history[0].column = "canopy_2_drag_coefficient" is no column', 'did you mean "canopy_0_drag_coefficient"?']),
    (39, 'history = [{ column = "canopy_0_drag_coefficient", statistic = "mean", from = 0.05, to = 0.2, value = 1, tolerance = 1 },', 39,
     ["verify.history[0].to", "run.end_time"]),
    (39, 'history = [{ column = "canopy_0_drag_coefficient", statistic = "mean", from = 0.05, to = 0.05, value = 1, tolerance = 1 },', 39,
     ["verify.history[0].to", "from"]),
    (3, 'velocity = [0, 0, "5+t"]', 39, ["verify.history[0]", "a fluid.velocity that does not vary"]),
    (40, '{ column = "canopy_2_airspeed", statistic = "mean", from = 0, to = 0.1, value = 1, tolerance = 1 }]', 40, ["verify.history[1].column"]),
    (40, '{ column = "canopy_2_projected_area", statistic = "mean", from = 0, to = 0.1, value = 1, tolerance = 1 }]', 40,
     ["verify.history[1].column"]),
    (42, "leak = [{ canopy = 2, from = 0.05, to = 0.1, tolerance = 1 }]", 42, ["verify.leak[0].canopy = 2", "number of canopies is 2"]),
    (42, "leak = [{ from = 0.05, to = 0.2, tolerance = 1 }]", 42, ["verify.leak[0].to", "run.end_time"]),
    (42, "leak = [{ from = 0.05, to = 0.05, tolerance = 1 }]", 42, ["verify.leak[0].to", "from"]),
    (42, "leak = [{ from = 0.05, to = 0.1 }]", 42, ["verify.leak[0].tolerance"]),
    (42, "leak = [{ from = 0.05, to = 0.1, tolerance = -1 }]", 42, ["verify.leak[0].tolerance"]),
    (42, "leak = [{ from = 0.05, to = 0.1, tolerance = 1, rms_tolerance = -1 }]", 42, ["verify.leak[0].rms_tolerance", ">= 0"]),
    # The payload is fixed.
    (3, "velocity = [0, 0, 0]", 39, ["verify.history[0] is relative to the speed", "fluid.velocity is 0", "canopy[0].payload.fixed"]),
    (42, "intersections = 0", 42, ["verify.intersections", "coupling.contact"]),
    (41, "peak_force = [{ canopy = 2, force = [1, 100] }]", 41, ["verify.peak_force[0].canopy = 2"]),
    (41, "peak_force = [{ canopy = 1, force = [100, 1] }]", 41, ["verify.peak_force[0].force"]),
    (41, "peak_force = [{ canopy = 1, force = [1, 100], time = [0.1, 0.01] }]", 41,
     ["verify.peak_force[0].time", "smaller"]),
    (37, 'fields = ["positions"]', 37, ["output.fields", "position"]),
    (37, 'fields = ["position"]\nhistory_every = 0', 40, ["verify.history[0]", "history_every"]),
]

DRUM = """\
app = "parachute"
[fluid]
density = 1.2
viscosity = 0
[grid]
cells = [12, 12, 12]
domain = [[-1, 1], [-1, 1], [-1, 1]]
boundary = { x = "periodic", y = "periodic", z = "periodic" }
[[canopy]]
kind = "drum"
diameter = 1.0
gores = 6
vent = 0
area_density = 0.2
cloth = "custom"
tension = 100
deflection = 0.002
edge_length = 0.05
porosity = { law = "none" }
[run]
end_time = 0.2
dt = 0.001
[output]
history_every = 1
[verify]
[[verify.history]]
column = "canopy_0_payload_z"
statistic = "frequency"
value = 17.1
tolerance = 1
"""

# As above, for DRUM.
BAD_DRUM_LINES = [
    (10, 'kind = "dram"', 10, ["canopy[0].kind", 'did you mean "drum"?']),
    (16, "", 9, ['missing key "canopy[0].tension"', "drum"]),
    (16, "tension = 0", 16, ["canopy[0].tension", "> 0"]),
    (10, 'kind = "sheet"', 16, ["canopy[0].tension", 'with kind = "drum"']),
    (17, 'deflection = "small"', 17, ["canopy[0].deflection", "number"]),
    (17, 'shape = "partly-closed"', 17, ["canopy[0].shape", "drum"]),
    (17, "lines = { length = 1 }", 17, ["canopy[0].lines", "drum"]),
    (17, "payload = { mass = 1 }", 17, ["canopy[0].payload", "drum"]),
    (27, 'column = "canopy_1_payload_z"', 27, ["verify.history[0].column", 'did you mean "canopy_0_payload_z"?']),
]
