"""A valid gas scene and the ways in which it is spoiled: one line replaced, or an assignment added."""

GOOD = """\
app = "gas"
description = "A shock tube."
[gas]
gamma = 1.4
[mesh]
cells = 100
domain = [-1.0, 1.0]
[initial]
riemann = { x0 = 0.0, left = { rho = 1.0, u = 0.0, p = 1.0 }, right = { rho = 0.125, u = 0.0, p = 0.1 } }
[boundary]
left = "outflow"
right = "outflow"
[scheme]
weno = "z"
weno_power = 1
splitting = "lf-stencil"
time = "ssprk3"
mean = "arithmetic"
cfl = 0.6
ramp_steps = 20
positivity = "auto"
precision = "double"
[run]
end_time = 0.1
max_steps = 10000
[output]
fields = ["rho", "u", "p"]
times = [0.05, 0.1]
history_every = 10
restart_every = 0
[verify]
exact = "riemann"
l1_density = 0.1
conservation = 1e-12
[tuning]
stage = { block = 128 }
"""

# Replaced line, its new text, the line the error names, words the error holds.
BAD_LINES = [
    # unknown keys, and the nearest valid name
    (4, "gama = 1.4", 4, ['"gas.gama"', 'did you mean "gamma"?']),
    (6, "cell = 100", 6, ['"mesh.cell"', '"cells"']),
    (13, "[schema]", 13, ['"schema"', 'did you mean "scheme"?']),
    (19, "clf = 0.6", 19, ['"scheme.clf"', '"cfl"']),
    (24, "end_time = 0.1\ncfl = 0.5", 25, ['"run.cfl"', 'did you mean "scheme.cfl"?']),
    (9, "riemann = { x_0 = 0.0, left = { rho = 1.0, p = 1.0 }, right = { rho = 1.0, p = 0.1 } }", 9, ["x_0", '"x0"']),
    (9, "riemann = { left = { rho = 1.0, v = 0.0, p = 1.0 }, right = { rho = 1.0, p = 0.1 } }", 9, ["riemann.left.v"]),
    (33, "l1_densty = 0.1", 33, ['"verify.l1_densty"', '"l1_density"']),
    (33, "l3_density = 0.1", 33, ['"verify.l3_density"', "l1_density"]),
    (36, "stge = { block = 128 }", 36, ['"tuning.stge"', "stage"]),
    # which app
    (1, 'app = "springs"', 1, ["app", '"gas"', "springs"]),
    (1, "app = 3", 1, ["app", '"gas"', "3"]),
    (1, "", 1, ['missing key "app"']),
    # types
    (4, 'gamma = "1.4"', 4, ["gas.gamma", "number", '"1.4"']),
    (4, "gamma = true", 4, ["gas.gamma", "number", "true"]),
    (4, "gamma = 1979-05-27", 4, ["gas.gamma", "date"]),
    (6, "cells = 100.0", 6, ["mesh.cells", "integer", "100.0"]),
    (6, "cells = [100]", 6, ["mesh.cells", "integer", "array"]),
    (7, "domain = 1.0", 7, ["mesh.domain", "array", "1.0"]),
    (7, "domain = [0.0]", 7, ["mesh.domain", "two numbers"]),
    (7, "domain = [0.0, \"1\"]", 7, ["mesh.domain[1]", "number"]),
    (9, "riemann = 3", 9, ["initial.riemann", "table", "3"]),
    (9, "regions = []", 9, ["initial.regions", "empty array"]),
    (9, "regions = [1, 2]", 9, ["initial.regions", "array of tables"]),
    (14, "weno = 5", 14, ["scheme.weno", '"js"', '"teno5"']),
    (27, 'fields = "rho"', 27, ["output.fields", "array"]),
    (2, "tunning = 3", 2, ["tunning", "tuning"]),
    # ranges
    (4, "gamma = 1.0", 4, ["gas.gamma = 1.0", "> 1"]),
    (4, "gamma = nan", 4, ["gas.gamma", "finite"]),
    (4, "gamma = inf", 4, ["gas.gamma", "finite"]),
    (6, "cells = 7", 6, ["mesh.cells = 7", "8 .. 268435456"]),
    (6, "cells = 268435457", 6, ["268435457", "8 .. 268435456"]),
    (6, "cells = -100", 6, ["-100", "8 .. 268435456"]),
    (7, "domain = [1.0, -1.0]", 7, ["mesh.domain[1]", "not greater"]),
    (7, "domain = [1.0, 1.0]", 7, ["mesh.domain[1]", "not greater"]),
    (7, "domain = [-1e308, 1e308]", 7, ["mesh.domain"]),
    (9, "riemann = { left = { rho = 0.0, p = 1.0 }, right = { rho = 1.0, p = 0.1 } }", 9, ["left.rho = 0.0", "> 0"]),
    (9, "riemann = { left = { rho = 1.0, p = 1.0 }, right = { rho = 1.0, p = -0.1 } }", 9, ["right.p = -0.1", "> 0"]),
    (14, 'weno = "teno"', 14, ["scheme.weno", '"teno"', 'did you mean "teno5"?']),
    (15, "weno_power = 3", 15, ["scheme.weno_power = 3", "1 .. 2"]),
    (16, 'splitting = "lf"', 16, ["scheme.splitting", '"lf-global"']),
    (17, 'time = "rk4"', 17, ["scheme.time", '"ssprk3"']),
    (18, 'mean = "row"', 18, ["scheme.mean", 'did you mean "roe"?']),
    (19, "cfl = 0", 19, ["scheme.cfl = 0", "> 0 and <= 2"]),
    (19, "cfl = 2.5", 19, ["scheme.cfl = 2.5", "> 0 and <= 2"]),
    (20, "ramp_steps = -1", 20, ["scheme.ramp_steps", "0 .. 1000000"]),
    (21, 'positivity = "always"', 21, ["scheme.positivity", '"off", "on", "auto"']),
    (22, 'precision = "single"', 22, ["scheme.precision", '"split"']),
    (24, "end_time = -0.1", 24, ["run.end_time", "> 0"]),
    (25, "max_steps = 0", 25, ["run.max_steps", "1 .. "]),
    (27, 'fields = ["rho", "v"]', 27, ["output.fields[1]", '"v"']),
    (27, 'fields = ["rho", "rho"]', 27, ["output.fields[1]", "twice"]),
    (28, "times = [0.1, 0.05]", 28, ["output.times[1]", "not greater"]),
    (28, "times = [0.05, 0.2]", 28, ["output.times", "0.2", "run.end_time = 0.1"]),
    (28, "times = [-0.1]", 28, ["output.times[0]", ">= 0"]),
    (33, "l1_density = -1", 33, ["verify.l1_density", ">= 0"]),
    (36, "stage = { block = 7 }", 36, ["tuning.stage.block", "32 .. 512"]),
    # missing keys and tables
    (24, "", 23, ['missing key "run.end_time"']),
    (9, "", 8, ["initial", "exactly one of riemann, regions, expression"]),
    (9, "riemann = { x0 = 0.0, left = { rho = 1.0, p = 1.0 } }", 9, ['missing table "initial.riemann.right"']),
    (9, "riemann = { left = { p = 1.0 }, right = { rho = 1.0, p = 1.0 } }", 9, ['missing key "initial.riemann.left.rho"']),
    (9, 'expression = { rho = "1" }', 9, ['missing key "initial.expression.p"']),
    (32, 'exact = "reference"', 31, ['missing table "verify.reference"']),
    # contradictions
    (14, 'weno = "js"', 15, ["scheme.weno_power", 'weno = "z"']),
    (18, "fixed_dt = 1e-4", 19, ["scheme.cfl", "without fixed_dt"]),
    (11, 'left = "periodic"', 11, ['boundary.right = "periodic"']),
    (12, 'right = "periodic"', 12, ['boundary.left = "periodic"']),
    (9, "riemann = { x0 = 1.5, left = { rho = 1.0, p = 1.0 }, right = { rho = 1.0, p = 0.1 } }", 9, ["x0 = 1.5", "inside"]),
    (9, "regions = [{ until = 0.5, rho = 1, p = 1 }, { until = 0.1, rho = 1, p = 1 }, { rho = 1, p = 1 }]", 9,
     ["regions[1].until = 0.1", "not greater"]),
    (9, "regions = [{ rho = 1, p = 1 }, { rho = 1, p = 1 }]", 9, ["regions[0]", "until"]),
    (9, "regions = [{ until = 3.0, rho = 1, p = 1 }, { rho = 1, p = 1 }]", 9, ["regions[0].until = 3.0", "inside"]),
    (32, 'exact = "advection"', 32, ["verify.exact", "initial.expression", "periodic"]),
    (9, 'expression = { rho = "1", p = "1" }', 32, ["verify.exact", "initial.riemann"]),
    (32, "", 33, ["verify.l1_density", "exact"]),
    (27, "fields = []", 28, ["output.times", "fields"]),
    (9, "expression = { rho = \"1\", p = \"1\" }\nregions = [{ rho = 1, p = 1 }]", 9, ["initial.expression contradicts"]),
    # expressions
    (9, 'expression = { rho = "1 +", p = "1" }', 9, ["initial.expression.rho", "at character 4"]),
    (9, 'expression = { rho = "1 + y", p = "1" }', 9, ["initial.expression.rho", '"y"', "x"]),
    (9, 'expression = { rho = "sinn(x)", p = "1" }', 9, ["initial.expression.rho", '"sinn"']),
    (9, 'expression = { rho = "1", p = "1 = 2" }', 9, ["initial.expression.p", "=="]),
    # syntax
    (4, "gamma = ", 4, []),
    (4, "gamma 1.4", 4, []),
    (4, "gamma = 1.4.1", 4, []),
    (5, "[mesh", 5, []),
    (7, "domain = [-1.0, 1.0", 8, []),
    (4, "gamma = 1.4\ngamma = 1.5", 5, ["gamma"]),
    (5, "[gas]", 5, ["gas"]),
    (5, "[mesh]\n[run]", 24, ["run"]),
    (10, "[initial.riemann.more]", 10, ["initial.riemann"]),
    (10, "[gas.gamma.more]\n[boundary]", 10, ["gas.gamma"]),
    (2, 'description = "open', 2, []),
    (2, 'description = "\\q"', 2, []),
]

# Assignments, words the error holds besides the assignment itself.
BAD_SETS = [
    (["gas.gamma=0.5"], ["gas.gamma = 0.5", "> 1"]),
    (["gas.gama=1.5"], ['did you mean "gamma"?']),
    (["scheme.weno=zz"], ['"js"', '"zz"']),
    (["scheme.weno=js", "scheme.weno_power=2"], ['weno = "z"']),
    (["scheme.fixed_dt=1e-4", "scheme.cfl=0.5"], ["without fixed_dt"]),
    (["mesh.cells=1e3"], ["integer"]),
    (["mesh.cells=[1"], ["TOML"]),
    (["mesh.cells="], ["missing"]),
    (["mesh.cells.x=1"], ["mesh.cells is 100, not a table"]),
    (["output.times=[0.1,0.05]"], ["not greater"]),
    (["nothing=1"], ['"nothing"']),
    (["initial.riemann.left.rho=-1"], ["> 0"]),
    (["initial.expression={rho=\"x\",p=\"1\"}", "verify={}"], ["rho = -0.99", "cell 0"]),
    (["tuning.kernel.block=128"], ["tuning.kernel"]),
    (["tuning.stage.block=100"], ["tuning.stage.block = 100", "multiple of 32"]),
]
