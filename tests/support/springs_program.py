"""Runs drogue-springs for tests of its interface."""

import gas_program

PROGRAM = gas_program.BIN / "drogue-springs"
SCENES = sorted(path.stem for path in (gas_program.SOURCE / "miniapps/springs/scenes").glob("*.toml"))

# A short run of an oscillating drum with few vertices.
DRUM = """\
app = "springs"
[mesh]
disk = { radius = 0.4, vertices = 61 }
[initial]
prestretch = 0.05
displacement = { z = "0.01*(1-(x^2+y^2)/0.16)" }
[[pin]]
where = "sqrt(x^2+y^2) > 0.4-1e-9"
[[load]]
gravity = [0, 0, -9.81]
[time]
end_time = 0.3
[output]
fields = ["position", "velocity"]
times = [0.1, 0.3]
probes = [{ at = [0, 0, 0] }]
history_every = 7
"""


# A sheet that falls on a sphere and folds around it.
FALLING = """\
app = "springs"
[mesh]
rectangle = { width = 0.2, height = 0.2, vertices = 121 }
[material]
membrane_modulus = 200.0
area_density = 0.2
[[load]]
gravity = [0, 0, -9.81]
[contact]
self = true
thickness = 0.003
friction = 0.2
objects = [{ kind = "sphere", centre = [0.1, 0.11, -0.06], radius = 0.05, friction = 0.2 }]
[time]
integrator = "verlet"
end_time = 0.15
[output]
fields = ["position", "velocity"]
times = [0.05, 0.15]
history_every = 7
restart_every = 20
[verify]
intersections = 0
"""


class SpringsTest(gas_program.GasTest):
    """Test case whose programs run in an empty temporary folder."""

    program = PROGRAM
