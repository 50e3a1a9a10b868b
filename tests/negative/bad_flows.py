"""A valid scene of drogue-parachute and invalid variants of it."""

GOOD = """\
app = "parachute"
description = "A stream past a moving wall."
[fluid]
density = 1.0
viscosity = 0.01
velocity = ["1+t", 0, 0]
[grid]
cells = [8, 6, 4]
domain = [[0, 2], [0, 1], [0, 1]]
boundary = { x = ["inflow", "outflow"], y = ["wall", "slip"], z = "periodic" }
wall_velocity = { y_low = [1, 0, 0] }
[initial]
velocity = ["x", 0, 0]
[flow]
advection = "weno5"
weno = "z"
diffusion = "explicit"
time = "ab2"
pressure = "auto"
turbulence = "none"
body_force = [0, 0, 0]
pressure_drop = [0, 0, 0]
[run]
end_time = 1.0
dt = "auto"
cfl = 0.5
max_steps = 1000
[output]
fields = ["velocity"]
times = [0.5, 1]
history_every = 10
[verify]
exact = { x = 1, y = 0, z = 0 }
l2_velocity = 10
[tuning.step]
driver = "plain"
"""

PERIODIC = 'boundary = { x = "periodic", y = "periodic", z = "periodic" }\n'

# Replaced line, its new text, the line in the error, and words of the message.
BAD_LINES = [
    # unknown keys, and the nearest valid name
    (3, "[fluids]", 3, ['"fluids"', 'did you mean "fluid"?']),
    (4, "densty = 1.0", 4, ['"fluid.densty"', "density"]),
    (8, "cell = [8, 6, 4]", 8, ['"grid.cell"', "cells"]),
    (10, 'boundary = { x = ["inflow", "outflow"], w = "slip", y = "slip", z = "periodic" }', 10, ['"grid.boundary.w"']),
    (11, "wall_velocity = { y_lo = [1, 0, 0] }", 11, ['"grid.wall_velocity.y_lo"', "y_low"]),
    (16, 'wenno = "z"', 16, ['"flow.wenno"', "weno"]),
    (25, "cfl_number = 0.1", 25, ['"run.cfl_number"', "cfl, max_dt"]),
    (34, "l2_velocty = 10", 34, ['"verify.l2_velocty"', "l2_velocity"]),
    (14, '[[chute]]\nkind = "disk"\n[flow]', 14, ['"chute"']),
    # name of the app
    (1, 'app = "springs"', 1, ["app", '"parachute"', "springs"]),
    (1, "", 1, ['missing key "app"']),
    # types
    (5, 'viscosity = "0.01"', 5, ["fluid.viscosity", "number"]),
    (6, "velocity = 1.0", 6, ["fluid.velocity", "array of 3"]),
    (6, "velocity = [1, 0]", 6, ["fluid.velocity", "array of 3", "2"]),
    (6, "velocity = [true, 0, 0]", 6, ["fluid.velocity[0]", "number"]),
    (8, "cells = [8, 6.5, 4]", 8, ["grid.cells[1]", "integer"]),
    (9, "domain = [[0, 2], [0, 1], 1]", 9, ["grid.domain[2]", "array of 2 numbers"]),
    (10, "boundary = 3", 10, ["grid.boundary", "table"]),
    (25, 'dt = "fast"', 25, ["run.dt", '"auto"', '"fast"']),
    # ranges
    (4, "density = 0", 4, ["fluid.density = 0", "> 0"]),
    (4, "density = 1e200", 4, ["fluid.density = 1e+200", "<= 1e+100"]),
    (5, "viscosity = -1", 5, ["fluid.viscosity", ">= 0"]),
    (8, "cells = [0, 6, 4]", 8, ["grid.cells[0]", "1 .. "]),
    (8, "cells = [8, 3, 4]", 8, ["grid.cells[1] = 3", "at least 4"]),
    (8, "cells = [16384, 16384, 16384]", 8, ["grid.cells: 4398046511104 cells", "2^31"]),
    (9, "domain = [[0, 2], [1, 1], [0, 1]]", 9, ["grid.domain[1]", "smaller"]),
    (9, "domain = [[0, 2], [1e18, 1000000000000000128], [0, 1]]", 9, ["grid.domain", "along y", "FP64"]),
    (15, 'advection = "weno7"', 15, ["flow.advection", '"weno5"']),
    (20, 'turbulence = "smagorinski"', 20, ["flow.turbulence", 'did you mean "smagorinsky"?']),
    (25, "dt = 0", 25, ["run.dt", "> 0"]),
    (26, "cfl = 1e-300", 26, ["run.cfl = 1e-300", "1e-06 .. 1.4"]),
    (27, "max_dt = 1e-300", 27, ["run.max_dt = 1e-300 s", "1e+300 steps to run.end_time, more than run.max_steps"]),
    (26, "cfl = 1.5", 26, ["run.cfl = 1.5", "1e-06 .. 1.4"]),
    (26, "cfl = 0.8", 26, ["run.cfl = 0.8", "at most 0.7", '"ab2"']),
    (29, 'fields = ["vorticty"]', 29, ["output.fields[0]", 'did you mean "vorticity"?']),
    (30, "times = [1, 0.5]", 30, ["output.times[1]", "not greater"]),
    (30, "times = [0.5, 2]", 30, ["output.times", "2.0", "run.end_time"]),
    # missing keys
    (24, "", 23, ['missing key "run.end_time"']),
    (8, "", 7, ["[grid] needs exactly one of cells, core, faces"]),
    (10, 'boundary = { x = ["inflow", "outflow"], z = "periodic" }', 10, ['missing key "grid.boundary.y"']),
    (33, "exact = { x = 1, y = 0 }", 33, ['missing key "verify.exact.z"']),
    # sides
    (10, 'boundary = { x = ["inflow", "outflow"], y = ["periodic", "slip"], z = "wall" }', 10,
     ["grid.boundary.y[0]", '"slip", "wall"']),
    (10, 'boundary = { x = ["inflow", "outflow", "slip"], y = "wall", z = "wall" }', 10, ["grid.boundary.x", "array of 2"]),
    (10, 'boundary = { x = "inflow", y = "slip", z = "outflw" }', 10, ["grid.boundary.z", 'did you mean "outflow"?']),
    (11, "wall_velocity = { y_high = [1, 0, 0] }", 11, ["grid.wall_velocity.y_high", "no wall"]),
    (11, "wall_velocity = { y_low = [1, 0.1, 0] }", 11, ["grid.wall_velocity.y_low[1]", "normal to the wall"]),
    (11, 'wall_velocity = { y_low = [0, "sin(t)", 0] }', 11, ["grid.wall_velocity.y_low[1]", "normal to the wall"]),
    (10, 'boundary = { x = ["inflow", "wall"], y = ["wall", "slip"], z = "periodic" }', 6,
     ["fluid.velocity", "without an outflow"]),
    # values that are not finite
    (11, 'wall_velocity = { y_low = ["t*besselj(1500, z)", 0, 0] }', 11,
     ["grid.wall_velocity.y_low[0]", "at character 11", "besselj has integer orders from -1000 to 1000"]),
    (6, 'velocity = ["1/(t*y)", 0, 0]', 6, ["fluid.velocity[0]", "not finite", "x_low", "t = 0"]),
    (6, 'velocity = [1, "sqrt(y-0.3)", 0]', 6, ["fluid.velocity[1]", "not finite", "x_low"]),
    (11, 'wall_velocity = { y_low = ["log(x-1)", 0, 0] }', 11, ["grid.wall_velocity.y_low[0]", "not finite", "y_low"]),
    (11, 'wall_velocity = { y_low = ["sqrt(0.05-t)", 0, 0] }', 11,
     ["grid.wall_velocity.y_low[0]", "not finite", "on the side y_low at t = 0.05"]),
    (11, 'wall_velocity = { y_low = ["1/(t-0.3)", 0, 0] }', 11,
     ["grid.wall_velocity.y_low[0]", "not finite", "on the side y_low at t = 0.3 s"]),
    (13, 'velocity = ["1/x", 0, 0]', 13, ["initial.velocity[0]", "not finite", "(0, "]),
    (13, 'velocity = ["t", 0, 0]', 13, ["initial.velocity[0]", '"t"']),
    (33, 'exact = { x = 1, y = "0/0", z = 0 }', 33, ["verify.exact.y", "not finite", "run.end_time"]),
    (33, 'exact = { x = 1, y = 0, z = 0, pressure = "log(-t)" }', 33, ["verify.exact.pressure", "not finite"]),
    (6, 'velocity = ["1+q", 0, 0]', 6, ["fluid.velocity[0]", '"q"']),
    (6, 'velocity = ["1+", 0, 0]', 6, ["fluid.velocity[0]", "at character"]),
    # contradictions
    (15, 'advection = "central"', 16, ["flow.weno", 'advection = "weno5"']),
    (17, 'diffusion = "explicit"\nturbulence_constant = 0.1', 18, ["flow.turbulence_constant", "turbulence model"]),
    (19, 'pressure = "fft"\npressure_tolerance = 1e-8', 20, ["flow.pressure_tolerance", "hypre-pfmg"]),
    (22, "pressure_drop = [1, 0, 0]", 22, ["flow.pressure_drop", "x has no periodic sides"]),
    (25, "dt = 0.01", 26, ["run.cfl", 'dt = "auto"']),
    (29, "fields = []", 30, ["output.times", "fields"]),
    (33, "", 34, ["verify.l2_velocity", "with exact"]),
    (34, "l2_pressure = 1", 34, ["verify.l2_pressure", "exact.pressure"]),
    (34, "momentum = 1e-9", 34, ["verify.momentum", "x_low is not periodic"]),
    # former keys
    (34, "kinetic_energy = { value = 1, tolerance = 1 }", 34,
     ['"verify.kinetic_energy" is now [[verify.history]] with column = "kinetic_energy", statistic = "last"']),
    (34, 'flow_rate = [{ side = "x_low", value = 1, tolerance = 1 }]', 34, ['is now [[verify.history]] with column = "outflow_x_low", of the former side, statistic = "last"']),
    (34, "force = []", 34, ['is now [[verify.history]] with column = "body_0_force_x", of the former body and axis, statistic = "last"']),
    (34, "mean_force = []", 34, ['is now [[verify.history]] with column = "body_0_force_x", of the former body and axis, statistic = "mean"']),
    (34, "frequency = []", 34, ['column = "body_0_force_x", of the former body and axis, statistic = "frequency" and the inverse of the former reference']),
    (34, "oscillation = []", 34, ['column = its column, statistic = "frequency" or "amplitude"; from, to, value and tolerance stay']),
    (34, "drag = []", 34, ['column = "canopy_0_drag_coefficient", of the former canopy, statistic = "mean"']),
    (34, "terminal_speed = []", 34, ['column = "canopy_0_airspeed", of the former canopy, statistic = "mean"']),
    (34, "projected_area = []", 34, ['column = "canopy_0_projected_area", of the former canopy, statistic = "mean"']),
    (34, 'history = [{ column = "outflow_z_low", statistic = "last", value = 1, tolerance = 1 }]', 34, ["verify.history[0].column"]),
    (34, 'profile = [{ component = "x", along = "y", through = [3, 0, 0], minimum = { value = 0, tolerance = 1 } }]', 34,
     ["verify.profile[0].through[0] = 3.0", "outside"]),
    (34, 'profile = [{ component = "x", along = "y", through = [1, 0, 0] }]', 34, ["verify.profile[0]", "needs points"]),
    (34, 'profile = [{ component = "x", along = "y", through = [1, 0, 0], points = [[2, 0]], tolerance = 1 }]', 34,
     ["verify.profile[0].points", "2.0", "outside"]),
    (34, 'profile = [{ component = "x", along = "y", through = [1, 0, 0], points = [[0.2, 0]] }]', 34,
     ['missing key "verify.profile[0].tolerance"']),
    (34, 'profile = [{ component = "x", along = "y", through = [1, 0, 0], maximum = { value = 0, tolerance = 1, at = 1 } }]', 34,
     ['missing key "verify.profile[0].maximum.at_tolerance"']),
    (34, "dissipation_peak = { value = 1, tolerance = 1, time_tolerance = 1 }", 34,
     ["verify.dissipation_peak.time_tolerance", "with time"]),
    (34, "kinetic_energy_curve = [{ tolerance = 1 }]", 34, ['missing key "verify.kinetic_energy_curve[0].points"']),
    (34, "dissipation_curve = [{ points = [[0.1, 1], [0.1, 2]], tolerance = 1 }]", 34,
     ["verify.dissipation_curve[0].points", "not greater than the one before it"]),
    (34, "dissipation_curve = [{ points = [[0, 1], [1e3, 2]], tolerance = 1 }]", 34,
     ["verify.dissipation_curve[0].points", "the time 1000.0 s is not between 0 and run.end_time"]),
    (34, "kinetic_energy_curve = [{ points = [[0, 0]], tolerance = 1 }]", 34,
     ["verify.kinetic_energy_curve[0].points", "relative"]),
    # syntax
    (6, "velocity = ", 6, []),
    (7, "[grid", 7, []),
]

# Assignments, and words of the message, which names the one at fault.
BAD_SETS = [
    (["tuning.stage.block=100"], "tuning.stage.block", ["= 100 is not a multiple of 32"]),
    (["tuning.stage.block=1024"], "tuning.stage.block", ["32 .. 512"]),
    (["tuning.contact.block=64"], "tuning.contact", ["contact = true"]),
    (["flow.diffusion=implicit"], "flow.diffusion", ["explicit", "crank-nicolson"]),
    (["flow.diffusion=crank-nicolson", "flow.time=rk3"], "flow.diffusion", ["ab2"]),
    (["fluid.velocity=[1, 'sin(t)', 0]", "grid.boundary={x='inflow',y=['slip','inflow'],z='periodic'}", "grid.wall_velocity={}"],
     "fluid.velocity", ["at t = 0.0588", "without an outflow"]),
    (["output.history_every=0", "verify.dissipation_curve=[{points=[[0, 1]],tolerance=1}]"], "verify.dissipation_curve",
     ["output.history_every"]),
    (["grid.cells=[8, 6, 1]", "grid.boundary.z=\"wall\""], "grid.boundary.z", ["periodic or slip"]),
    (["grid.cells=[8, 6, 1]", "verify.profile=[{component='x',along='z',through=[1,0.5,0],minimum={value=0,tolerance=1}}]"],
     "verify.profile", ["fewer than 4 cells"]),
]
