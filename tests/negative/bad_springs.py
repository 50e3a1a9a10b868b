"""A valid springs scene, its mesh, and invalid variants of both."""

MESH = """\
# a square and a string that hangs from it
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
f 1 2 3
f 1 3 4
v 0 1 -1
v 0 1 -2
l 4 5 6
"""

GOOD = """\
app = "springs"
description = "A square sheet."
[mesh]
file = "m.obj"
[material]
model = "biquadratic"
membrane_modulus = 1000.0
poisson = 0.3
area_density = 0.2
mass = "area"
line_density = 0.001
axial_stiffness = 50.0
[initial]
displacement = { z = "0.01*x*y" }
velocity = { x = "0" }
prestretch = 0.01
[[pin]]
where = "x < 0.5"
axes = "xy"
motion = { x = "0.01*t" }
[[load]]
gravity = [0, 0, -9.81]
[[mass]]
where = "z < -1.5"
add = 0.005
[damping]
absolute = 0.0
relative = 0.0
[time]
integrator = "rk4"
dt = "auto"
safety = 0.8
end_time = 0.01
[output]
fields = ["position", "velocity"]
times = [0.005, 0.01]
probes = [{ at = [1, 1, 0] }]
history_every = 10
restart_every = 0
[verify]
equilibrium = 1e9
[tuning.step]
driver = "graph"
"""

# Replaced line, its new text, the line in the error, and words of the message.
BAD_LINES = [
    # unknown keys, and the nearest valid name
    (3, "[mehs]", 3, ['"mehs"', 'did you mean "mesh"?']),
    (4, 'flie = "m.obj"', 4, ['"mesh.flie"', '"file"']),
    (7, "membrane_module = 1000.0", 7, ['"material.membrane_module"', "membrane_modulus"]),
    (12, "shear_stiffness = 0.1", 12, ['"material.shear_stiffness"', "axial_stiffness"]),
    (18, 'were = "x < 0.5"', 18, ['"pin[0].were"', '"where"']),
    (37, 'prob = [{ at = [1, 1, 0] }]', 37, ['"output.prob"', '"probes"']),
    (39, "contact = 1", 39, ['"output.contact"']),
    (40, "[contact]\nobject = []\n[verify]", 41, ['"contact.object"', '"objects"']),
    (41, "yuong = 1e-5", 41, ['"verify.yuong"', '"young"']),
    # name of the app
    (1, 'app = "gas"', 1, ["app", '"springs"', "gas"]),
    (1, "", 1, ['missing key "app"']),
    # types
    (8, 'poisson = "0.3"', 8, ["material.poisson", "number"]),
    (14, 'displacement = "x"', 14, ["initial.displacement", "table"]),
    (22, "gravity = 9.81", 22, ["load[0].gravity", "array"]),
    (22, 'gravity = [0, "0", 1]', 22, ["load[0].gravity[1]", "number"]),
    (31, 'dt = "fast"', 31, ["time.dt", '"auto"', '"fast"']),
    (37, "probes = [[1, 1, 0]]", 37, ["output.probes", "array of tables"]),
    (41, "frequency = 3.0", 41, ["verify.frequency", "table"]),
    # ranges
    (4, "disk = { radius = -1 }", 4, ["mesh.disk.radius", "> 0"]),
    (4, "disk = { vertices = 3 }", 4, ["mesh.disk.vertices = 3", "7 .. "]),
    (6, 'model = "quadratik"', 6, ["material.model", 'did you mean "quadratic"?']),
    (7, "membrane_modulus = 0", 7, ["material.membrane_modulus = 0", "> 0"]),
    (8, "poisson = 0.6", 8, ["material.poisson = 0.6", "-0.99 .. 0.5"]),
    (9, "area_density = nan", 9, ["material.area_density", "finite"]),
    (10, 'mass = "lumped"', 10, ["material.mass", '"area", "equal"']),
    (19, 'axes = "xw"', 19, ["pin[0].axes", '"xw"']),
    (22, "gravity = [0, 0]", 22, ["load[0].gravity", "3 numbers"]),
    (25, "add = -0.005", 25, ["mass[0].add", "> 0"]),
    (27, "absolute = -1", 27, ["damping.absolute", ">= 0"]),
    (30, 'integrator = "euler"', 30, ["time.integrator", '"rk4", "verlet"']),
    (32, "safety = 1e-300", 32, ["time.safety = 1e-300", "1e-06 .. 1"]),
    (32, "safety = 1.5", 32, ["time.safety = 1.5", "1e-06 .. 1"]),
    (33, "end_time = -1", 33, ["time.end_time", ">= 0"]),
    (35, 'fields = ["position", "strain"]', 35, ["output.fields[1]", '"strain"']),
    (35, 'fields = ["position", "vertex_von_mise"]', 35, ["output.fields[1]", 'did you mean "vertex_von_mises"?']),
    (36, "times = [0.01, 0.005]", 36, ["output.times[1]", "not greater"]),
    (36, "times = [0.005, 0.02]", 36, ["output.times", "0.02", "time.end_time"]),
    (12, "bending_stiffness = -0.1", 12, ["material.bending_stiffness", ">= 0"]),
    (43, 'driver = "grahp"', 43, ["tuning.step.driver", '"plain", "graph"']),
    # missing keys
    (33, "", 29, ['missing key "time.end_time"']),
    (4, "", 3, ["mesh", "exactly one of rectangle, disk, strip, triangle, string, file"]),
    (18, "", 17, ['missing key "pin[0].where"']),
    (25, "", 23, ['missing key "mass[0].add"']),
    # contradictions
    (4, 'file = "m.obj"\ndisk = {}', 4, ["contradicts"]),
    (4, 'file = "no.obj"', 4, ["mesh.file", "no.obj"]),
    (4, "string = {}", 7, ["material.membrane_modulus", "with triangles"]),
    (4, "disk = {}", 11, ["material.line_density", "with lines"]),
    (6, 'model = "edge"', 7, ["material.membrane_modulus", "quadratic or biquadratic"]),
    (12, "axial_stiffness = 50\nstiffness = 10", 12, ["material.axial_stiffness", "without stiffness"]),
    (22, 'gravity = [0, 0, 1]\npressure = 3', 23, ["load[0].pressure contradicts load[0].gravity"]),
    (22, "", 21, ["load[0]", "exactly one of gravity, pressure, follower_pressure, force"]),
    (31, "dt = 1e-4", 32, ["time.safety", 'dt = "auto"']),
    (35, "fields = []", 36, ["output.times", "fields"]),
    # conditions that hold nowhere, values that are not finite
    (18, 'where = "x > 5"', 18, ["pin[0].where", "no vertex"]),
    (24, 'where = "z < -9"', 24, ["mass[0].where", "no vertex"]),
    (20, 'motion = { x = "1/(t-0.003)" }', 20, ["pin[0].motion.x gives inf at vertex 0", "at t = 0.003 s"]),
    (20, 'motion = { y = "sqrt(0.005-t)" }', 20, ["pin[0].motion.y gives", "at t = 0.005", "finite"]),
    (22, 'force = { x = "log(0.006-t)" }', 22, ["load[0].force.x gives", "at t = 0.006", "finite"]),
    (22, 'follower_pressure = "1/(t-0.003)"', 22, ["load[0].follower_pressure gives", "at t = 0.003 s"]),
    (20, 'motion = { x = "sin(1e15*t)" }', 20, ["pin[0].motion.x: steps that resolve it", "to time.end_time; time.dt takes longer ones"]),
    (20, 'motion = { z = "t" }', 20, ["pin[0].motion.z", "leaves free"]),
    (20, 'motion = { x = "1/t" }', 20, ["pin[0].motion.x", "finite"]),
    (14, 'displacement = { z = "1/x" }', 14, ["initial.displacement.z", "vertex 0", "finite"]),
    (14, 'displacement = { z = "0.01*q" }', 14, ["initial.displacement.z", '"q"']),
    (14, 'displacement = { z = "t" }', 14, ["initial.displacement.z", '"t"']),
    (18, 'where = "x <"', 18, ["pin[0].where", "at character"]),
    (41, "young = 1e-5", 41, ["verify.young", "mesh.strip"]),
    (41, "energy_drift = 1e-5", 41, ["verify.energy_drift", "pins that stay"]),
    (41, "catenary = 1e-5", 41, ["verify.catenary", "mesh.string"]),
    # reinforcement
    (12, '[[reinforcement]]\nwhere = "x == 1"', 12, ['missing key "reinforcement[0].axial_stiffness"']),
    (12, '[[reinforcement]]\nwhere = "x == 1"\naxial_stiffnes = 3', 14,
     ['"reinforcement[0].axial_stiffnes"', "axial_stiffness"]),
    (12, '[[reinforcement]]\nwhere = "x == 7"\naxial_stiffness = 3', 13, ["reinforcement[0].where", "no vertex"]),
    (12, '[[reinforcement]]\nwhere = "x+y == 1 && z > -0.5"\naxial_stiffness = 3', 13, ["both ends of no edge"]),
    (12, '[[reinforcement]]\nwhere = "z < -0.5"\naxial_stiffness = 3', 12, ["no mass", "vertex 5"]),
    (12, '[[reinforcements]]', 12, ['did you mean "reinforcement"?']),
    # contact
    (40, "[contact]\nself = 1\n[verify]", 41, ["contact.self", "true or false"]),
    (40, "[contact]\nthickness = 0.1\n[verify]", 41, ["contact.thickness", "with objects or self"]),
    (40, "[contact]\nself = true\nthickness = 0\n[verify]", 42, ["contact.thickness = 0", "> 0"]),
    (40, "[contact]\nself = true\nthickness = 0.8\n[verify]", 42, ["contact.thickness = 0.8", "least height"]),
    (40, "[contact]\nfriction = 0.1\n[verify]", 41, ["contact.friction", "with self"]),
    (40, '[contact]\nobjects = [{ kind = "cube" }]\n[verify]', 41, ["contact.objects[0].kind", '"sphere"']),
    (40, '[contact]\nobjects = [{ kind = "disk" }]\n[verify]', 41, ['missing key "contact.objects[0].radius"']),
    (40, '[contact]\nobjects = [{ kind = "plane", radius = 1 }]\n[verify]', 41,
     ["contact.objects[0].radius", "with kind disk or sphere"]),
    (40, '[contact]\nobjects = [{ kind = "plane", normal = [0, 0, 0] }]\n[verify]', 41,
     ["contact.objects[0].normal", "nowhere"]),
    (40, '[contact]\nobjects = [{ kind = "sphere", radius = 0.5 }]\n[verify]', 40,
     ["meets contact.objects[0]", "where the run starts"]),
    (40, '[contact]\nobjects = [{ kind = "level-set", expression = "x+q" }]\n[verify]', 41,
     ["contact.objects[0].expression", '"q"']),
    (40, '[contact]\nobjects = [{ kind = "level-set", expression = "sqrt(x-0.5)" }]\n[verify]', 40,
     ["contact.objects[0].expression", "not a number at vertex 0", "where the run starts"]),
    (40, '[contact]\nobjects = [{ kind = "level-set", expression = "x+9" }]\n[verify]\nintersections = 0', 43,
     ["verify.intersections", "without a level-set"]),
    (40, '[contact]\nobjects = [{ kind = "sphere", centre = [0, 1, -1.5], radius = 0.1 }]\n[verify]', 40,
     ["line 1 meets contact.objects[0]", "where the run starts"]),
    (41, "intersections = 0", 41, ["verify.intersections", "contact.self"]),
    (41, "energy_balance = 1", 41, ["verify.energy_balance", "pins that stay"]),
    (41, "penetration = 1", 41, ["verify.penetration", "contact.objects"]),
    # syntax
    (4, "file = ", 4, []),
    (17, "[[pin]", 17, []),
]

# Replaced line of the mesh, its new text, the line in the error, and words of the message.
BAD_MESHES = [
    (2, "v 0 0", 2, ["vertex 1 of the file has 2 numbers"]),
    (2, "v 0 0 O", 2, ["vertex 1", '"O"', "finite number"]),
    (3, "v 0 0 0", 3, ["vertex 2 of the file lies where vertex 1 does"]),
    (3, "v inf 0 0", 3, ["vertex 2", "finite number"]),
    (6, "f 1 2 9", 6, ["face 1 of the file names vertex 9", "the file has 6"]),
    (6, "f 0 1 2", 6, ["vertex 0", "count from 1"]),
    (6, "f 1 2 2", 6, ["face 1 of the file names vertex 2 twice"]),
    (6, "f 1 2 3 4", 7, ["face 2 of the file repeats face 1"]),
    (6, "f 1 3 2 4", 6, ["face 1 of the file has no area or crosses itself", "triangles"]),
    (6, "f 1 \\\n2 3 9", 6, ["face 1 of the file names vertex 9"]),
    (6, "", 3, ["vertex 2 of the file belongs to no face"]),
    (7, "f 1 3 4\nf 3 1 5", 8, ["face 3 of the file is the third at the edge of vertices 1 and 3"]),
    (7, "f 2 3 1", 7, ["face 2 of the file repeats face 1"]),
    (8, "v 0.5 0 0\nf 1 2 5", 9, ["face 3 of the file (vertices 1, 2, 5) has no area"]),
    (10, "l 4", 10, ["two vertices"]),
    (10, "l 4 5 6\nl 6 5", 11, ["given twice"]),
    (10, "l 4 5 six", 10, ['"six"']),
    (10, "curv 1 2", 10, ['unknown statement "curv"']),
]
