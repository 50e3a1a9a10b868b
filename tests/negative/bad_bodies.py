"""A valid scene of drogue-parachute with a body, and invalid variants of it."""

GOOD = """\
app = "parachute"
[fluid]
velocity = [1, 0, 0]
[grid]
cells = [16, 8, 8]
domain = [[0, 1.6], [0, 0.8], [0, 0.8]]
boundary = { x = ["inflow", "outflow"], y = "slip", z = "periodic" }
[[body]]
kind = "plate"
normal = "x"
centre = [0.8, 0.4, 0.4]
lengths = [0.4, 0.8]
edge_length = 0.05
porosity = { law = "forchheimer", alpha = 10, beta = 1 }
[coupling]
filter = 0.5
[run]
end_time = 0.1
max_dt = 0.01
[verify]
history = [{ column = "body_0_force_x", statistic = "last", value = 1, tolerance = 1 }]
"""

# Replaced line, its new text, the line in the error, and words of the message.
BAD_LINES = [
    # unknown keys and names
    (8, "[[boby]]", 8, ['"boby"', 'did you mean "body"?']),
    (9, 'kind = "plat"', 9, ["body[0].kind", 'did you mean "plate"?']),
    (9, 'kynd = "plate"', 9, ['"body[0].kynd"', "kind"]),
    # names of other tables, which would not help here
    (9, 'shape = "plate"', 9, ['unknown key "body[0].shape"; valid names are kind, normal,']),
    (13, "diameter = 0.05", 13, ['unknown key "body[0].diameter"; valid names are kind, normal,']),
    (13, "edge_lenght = 0.05", 13, ['unknown key "body[0].edge_lenght"; did you mean "edge_length"?']),
    (10, 'normal = "w"', 10, ["body[0].normal", '"x"']),
    (13, "edge = 0.05", 13, ['"body[0].edge"', "edge_length"]),
    (14, 'porosity = { law = "forcheimer" }', 14, ["body[0].porosity.law", 'did you mean "forchheimer"?']),
    (14, "porosity = { lov = 1 }", 14, ['"body[0].porosity.lov"', "law"]),
    (15, "[copling]", 15, ['"copling"', 'did you mean "coupling"?']),
    # missing keys
    (9, "", 8, ['missing key "body[0].kind"']),
    (10, "", 8, ['missing key "body[0].normal"']),
    (11, "", 8, ['missing key "body[0].centre"']),
    (12, "", 8, ['missing key "body[0].lengths"']),
    (13, "", 8, ['missing key "body[0].edge_length"']),
    # types and ranges
    (8, "[body]", 8, ["body", "array"]),
    (11, "centre = [0.8, 0.4]", 11, ["body[0].centre", "array of 3"]),
    (12, "lengths = [0.4, 0.8, 1]", 12, ["body[0].lengths", "array of 2"]),
    (12, "lengths = [0.4, 0]", 12, ["body[0].lengths[1]", "> 0"]),
    (12, "lengths = [0.4, 0.8]\nhole = 0.1", 13, ["body[0].hole", "must be a square"]),
    (12, "lengths = [0.4, 0.4]\nhole = 0.2", 13, ["body[0].hole = 0.2 m leaves no plate"]),
    (12, "lengths = [0.4, 0.4]\nhole = -0.1", 13, ["body[0].hole", ">= 0"]),
    (13, "edge_length = -1", 13, ["body[0].edge_length", "> 0"]),
    (14, 'porosity = { law = "forchheimer", alpha = -1 }', 14, ["body[0].porosity.alpha", ">= 0"]),
    (14, 'porosity = { law = "forchheimer", beta = "2" }', 14, ["body[0].porosity.beta", "number"]),
    (14, 'porosity = { law = "forchheimer", alpha = 0, beta = 0 }', 14, ["body[0].porosity: alpha and beta are 0", "no obstacle"]),
    (16, 'method = "spred"', 16, ["coupling.method", 'did you mean "spread"?']),
    (16, "filter = 1.5", 16, ["coupling.filter", "0 .. 1"]),
    (16, "leak_filter = 1.5", 16, ["coupling.leak_filter", "0 .. 1"]),
    (16, "defect_filter = 0.1", 16, ['"coupling.defect_filter" is now "coupling.leak_filter", by default 0.5']),
    (16, 'corrections = "none"', 16, ["coupling.corrections", '"default"', '"plain"']),
    # contradictions
    (14, 'porosity = { law = "none", alpha = 10 }', 14, ["body[0].porosity.alpha", "forchheimer"]),
    (14, "retraction = 0.3", 14, ["body[0].retraction", '"sphere" or "cylinder" or "cup"']),
    (11, "centre = [1.55, 0.4, 0.4]", 11, ["body[0]", "1.55", "along x", "1.5"]),
    (12, "lengths = [0.7, 0.8]", 12, ["body[0]", "along y", "between 0.1 and 0.7"]),
    (12, "lengths = [0.4, 0.9]", 12, ["body[0]", "along z", "cross its image", "at most 0.8 m"]),
    (13, "edge_length = 0.1", 13, ["body[0].edge_length", "0.1", "0.0714"]),
    (13, "edge_length = 1e-4", 13, ["body[0].edge_length", "vertices", "2^20"]),
    (21, 'history = [{ column = "body_1_force_x", statistic = "last", value = 1, tolerance = 1 }]', 21,
     ['verify.history[0].column = "body_1_force_x" is no column', 'did you mean "body_0_force_x"?']),
]

ROUND = """\
app = "parachute"
[fluid]
velocity = [1, 0, 0]
[grid]
cells = [16, 16, 16]
domain = [[0, 1.6], [0, 1.6], [0, 1.6]]
boundary = { x = ["inflow", "outflow"], y = "slip", z = "periodic" }
[[body]]
kind = "sphere"
centre = [0.5, 0.4, 0.4]
radius = 0.2
edge_length = 0.05
motion = { x = "0.1*sin(t)", y = 0.01 }
slip = true
porosity = { law = "ergun", void_fraction = 0.4, thickness = 1e-4, grain = 1e-5 }
[[body]]
kind = "cylinder"
axis = "z"
centre = [1.2, 0.5, 0.8]
radius = 0.2
length = 1.6
ends = "open"
edge_length = 0.05
porosity = { law = "kim-peskin", pores = 1e6, conductance = 1e-9 }
[[body]]
kind = "cup"
axis = "x"
opening = "low"
centre = [0.6, 1.1, 1.1]
radius = 0.25
edge_length = 0.05
[run]
end_time = 2
max_dt = 0.01
[output]
history_every = 1
[verify]
history = [
  { column = "body_0_force_x", statistic = "mean", from = 1, reference = 0.1, value = 1, tolerance = 1 },
  { column = "body_1_force_y", statistic = "frequency", from = 1, value = 1, tolerance = 1 },
]
"""

# As above, for ROUND.
BAD_ROUND_LINES = [
    # keys of other kinds
    (9, 'kind = "disk"', 8, ['missing key "body[0].normal"']),
    (9, 'kind = "spere"', 9, ["body[0].kind", 'did you mean "sphere"?']),
    (11, "radius = 0.2\nlengths = [0.2, 0.2]", 12, ["body[0].lengths", "plate"]),
    (11, "", 8, ['missing key "body[0].radius"']),
    (9, 'kind = "file"', 8, ['missing key "body[0].file"']),
    (11, 'radius = 0.2\nfile = "a.obj"', 12, ["body[0].file", '"file"']),
    (18, "", 16, ['missing key "body[1].axis"']),
    (18, 'axis = "z"\nnormal = "z"', 19, ["body[1].normal", '"plate" or "disk"']),
    (21, "", 16, ['missing key "body[1].length"']),
    (28, "", 25, ['missing key "body[2].opening"']),
    (28, 'opening = "low"\nends = "open"', 29, ["body[2].ends", '"cylinder"']),
    # types and ranges
    (11, "radius = 0", 11, ["body[0].radius", "> 0"]),
    (13, 'motion = { x = "0.1*sin(x)" }', 13, ["body[0].motion.x", "x"]),
    (13, 'motion = { w = "t" }', 13, ["body[0].motion.w", "x"]),
    (9, 'kind = "disk"\nnormal = "x"\nretraction = 0.3', 11, ["body[0].retraction", '"sphere" or "cylinder" or "cup"']),
    (14, 'slip = "no"', 14, ["body[0].slip", "true or false"]),
    (12, "edge_length = 0.05\nretraction = 1.5", 13, ["body[0].retraction", "0 .. 1"]),
    (12, "edge_length = 0.05\nretraction = -0.3", 13, ["body[0].retraction", "0 .. 1"]),
    (11, "radius = 0.1\nretraction = 0.6", 12, ["body[0].retraction: 0.06", "along x", "more than half of the 0.1 m"]),
    (22, 'ends = "shut"', 22, ["body[1].ends", '"closed"']),
    (28, 'opening = "left"', 28, ["body[2].opening", '"low"']),
    # porosity
    (15, 'porosity = { law = "ergun", void_fraction = 0.4, thickness = 1e-4 }', 15, ['missing key "body[0].porosity.grain"']),
    (15, 'porosity = { law = "ergun", void_fraction = 1.4, thickness = 1e-4, grain = 1e-5 }', 15, ["body[0].porosity.void_fraction", "> 0 and < 1"]),
    (15, 'porosity = { law = "ergun", void_fraction = 0.4, thickness = 1e-4, grain = 1e-5, alpha = 1 }', 15, ["body[0].porosity.alpha", "forchheimer"]),
    (24, 'porosity = { law = "kim-peskin", pores = 0, conductance = 1e-9 }', 24, ["body[1].porosity.pores", "> 0"]),
    (24, 'porosity = { law = "kim-peskin", pores = 1e6 }', 24, ['missing key "body[1].porosity.conductance"']),
    (24, 'porosity = { law = "kim-peskin", pores = 1e-300, conductance = 1e-300 }', 24, ["body[1].porosity: alpha = ", "at most 1e+100"]),
    (24, 'porosity = { law = "kim-pesking", pores = 1e6 }', 24, ["body[1].porosity.law", 'did you mean "kim-peskin"?']),
    # places
    (10, "centre = [0.25, 0.4, 0.4]", 13, ["body[0]", "to 0.45 m along x at t = 0", "between 0.1"]),
    (10, "centre = [0.5, 0.25, 0.4]", 13, ["body[0]", "along y", "0.06", "0.1", 'coupling.method = "sharp"']),
    (13, 'motion = { x = "log(t-1)" }', 13, ["body[0].motion.x", "not finite", "at t = 0"]),
    (13, 'motion = { x = "1e-9/(t-0.0123)" }', 13, ["body[0].motion.x", "not finite", "at t = 0.0123 s"]),
    (13, 'motion = { x = "0*sqrt(0.05-t)" }', 13, ["body[0].motion.x", "not finite", "at t = 0.05"]),
    (13, 'motion = { x = "2*t" }', 13, ["body[0]", "along x", "1.5"]),
    (21, "length = 1.7", 19, ["body[1]", "along z", "at most 1.6 m"]),
    (29, "centre = [1.3, 1.1, 1.1]", 29, ["body[2]", "along x", "1.55"]),
    (31, "edge_length = 0.08", 31, ["body[2].edge_length", "0.0714"]),
    (31, "edge_length = 1e-6", 31, ["body[2].edge_length", "2^20"]),
    # two dimensions
    (5, "cells = [16, 16, 1]", 9, ["body[0].kind", "one cell along z"]),
    # checks
    (36, "history_every = 0", 38, ["verify.history[0]", "output.history_every"]),
    (39, '{ column = "body_3_force_x", statistic = "mean", value = 1, tolerance = 1 },', 39,
     ['verify.history[0].column = "body_3_force_x" is no column', 'did you mean "body_0_force_x"?']),
    (39, '{ column = "body_0_force_x", statistic = "mean", from = 2, value = 1, tolerance = 1 },', 39, ["verify.history[0].from", "run.end_time"]),
    (39, '{ column = "body_0_force_x", statistic = "mean", reference = 0, value = 1, tolerance = 1 },', 39, ["verify.history[0].reference", "> 0"]),
    (40, '{ column = "body_1_force_y", statistic = "frequency", value = 0, tolerance = 1 },', 40, ["verify.history[1].value", "positive"]),
    (40, '{ column = "body_1_force_y", statistic = "frequency", from = -1, value = 1, tolerance = 1 },', 40, ["verify.history[1].from", ">= 0"]),
]

PISTON = """\
app = "parachute"
[fluid]
[grid]
cells = [16, 8, 8]
domain = [[0, 1.6], [0, 0.8], [0, 0.8]]
boundary = { x = "periodic", y = "periodic", z = "periodic" }
[[body]]
kind = "plate"
normal = "x"
centre = [0.8, 0.4, 0.4]
lengths = [0.8, 0.8]
edge_length = 0.05
mount = { mass = 0.1, stiffness = 40, offset = 0.03 }
[coupling]
method = "spread"
[run]
end_time = 2
max_dt = 0.01
[output]
history_every = 1
[verify]
[[verify.history]]
column = "body_0_displacement"
statistic = "frequency"
from = 0.5
value = 0.87
tolerance = 0.1
[[verify.history]]
column = "body_0_displacement"
statistic = "amplitude"
from = 0.5
value = 0.03
tolerance = 0.1
"""

# As above, for PISTON.
BAD_PISTON_LINES = [
    (13, "mount = { mass = 0, stiffness = 40 }", 13, ["body[0].mount.mass", "> 0"]),
    (13, "mount = { mass = 1, stiffness = -4 }", 13, ["body[0].mount.stiffness", "> 0"]),
    (13, "mount = { mass = 1 }", 13, ['missing key "body[0].mount.stiffness"']),
    (13, "mount = { stiffness = 1 }", 13, ['missing key "body[0].mount.mass"']),
    (13, "mount = { mass = 1, stiffness = 40, ofset = 1 }", 13, ['"body[0].mount.ofset"', "offset"]),
    (13, 'motion = { x = "t" }\nmount = { mass = 1, stiffness = 40 }', 14, ["body[0].mount", "without motion"]),
    (6, 'boundary = { x = "slip", y = "periodic", z = "periodic" }', 13, ["body[0].mount", "periodic sides", "along x"]),
    (11, "lengths = [0.8, 0.7]", 11, ["body[0].lengths", "close the channel", "0.8 m wide along z"]),
    (15, 'method = "explicit"', 15, ["coupling.method", "body[0] moves all of the fluid, 1.25", "0.1"]),
    (20, "history_every = 0", 22, ["verify.history[0]", "output.history_every"]),
    (23, 'column = "body_0_displacment"', 23, ["verify.history[0].column", 'did you mean "body_0_displacement"?']),
    (23, 'column = "time"', 23, ["verify.history[0].column", "no column"]),
    (23, "", 22, ['missing key "verify.history[0].column"']),
    (24, 'statistic = "median"', 24, ["verify.history[0].statistic", '"mean"']),
    (24, "", 22, ['missing key "verify.history[0].statistic"']),
    (25, "from = 2", 25, ["verify.history[0].from", "run.end_time"]),
    (25, "from = 0.5\nto = 0.5", 26, ["verify.history[0].to", "from"]),
    (25, "from = 0.5\nto = 2.1", 26, ["verify.history[0].to", "run.end_time"]),
    (26, "value = 0", 26, ["verify.history[0].value", "positive"]),
    (27, "tolerance = -1", 27, ["verify.history[0].tolerance", ">= 0"]),
    (32, "value = -1", 32, ["verify.history[1].value", "negative"]),
    (32, "", 28, ['missing key "verify.history[1].value"']),
    (33, "", 28, ['missing key "verify.history[1].tolerance"']),
]
