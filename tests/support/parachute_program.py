"""Runs drogue-parachute for tests of its interface."""

import gas_program

PROGRAM = gas_program.BIN / "drogue-parachute"
SCENES = sorted(path.stem for path in (gas_program.SOURCE / "miniapps/parachute/scenes").glob("*.toml"))
SMALL_SCENES = [name for name in SCENES if not name.endswith("-full")]
# Small scenes with canopies.
CANOPIES = [name for name in SMALL_SCENES
            if "[[canopy]]" in (gas_program.SOURCE / f"miniapps/parachute/scenes/{name}.toml").read_text(encoding="utf-8")]
# Bodies with turbulent wakes, each half a minute on one core.
WAKES = {"cup", "cup-reversed", "disk-normal"}

# A gust through a short channel with a moving wall: every type of side but periodic ones, in three dimensions.
GUST = """\
app = "parachute"
[fluid]
density = 1.2
viscosity = 0.01
velocity = ["1 + 0.3*sin(5*t) + 0.2*y*(1-y)", 0, "0.1*y"]
[grid]
cells = [12, 10, 8]
domain = [[0, 2], [0, 1], [0, 1]]
boundary = { x = ["inflow", "outflow"], y = ["wall", "slip"], z = "wall" }
wall_velocity = { y_low = ["0.5*cos(t)", 0, 0] }
[initial]
velocity = ["1 + 0.1*sin(3*y)*z", "0.1*sin(pi*y)", 0]
[run]
end_time = 0.5
[output]
fields = ["velocity", "pressure", "vorticity", "q_criterion"]
times = [0.2, 0.5]
history_every = 3
"""

# A few vortices on a periodic grid.
VORTICES = """\
app = "parachute"
[fluid]
density = 1
viscosity = 0.01
[grid]
cells = [16, 16, 1]
domain = [[0, 6.283185307179586], [0, 6.283185307179586], [0, 1]]
boundary = { x = "periodic", y = "periodic" }
[initial]
velocity = ["sin(x)*cos(y)", "-cos(x)*sin(y)", 0]
[run]
end_time = 0.5
dt = 0.05
[verify]
exact = { x = "sin(x)*cos(y)*exp(-0.02*t)", y = "-cos(x)*sin(y)*exp(-0.02*t)", z = 0, pressure = "0.25*(cos(2*x)+cos(2*y))*exp(-0.04*t)" }
l2_velocity = 0.01
"""


# A canopy without a fluid, which falls with its payload.
CLOTH = """\
app = "parachute"
[[canopy]]
kind = "flat-circular"
diameter = 2
gores = 8
vent = 0.3
edge_length = 0.3
lines = { length = 1.8, stiffness = 500 }
payload = { mass = 0.1 }
[coupling]
gravity = [0, 0, -9.81]
[run]
end_time = 0.4
[output]
history_every = 50
"""


# A porous plate in a channel.
PLATE = """\
app = "parachute"
[fluid]
density = 1.2
viscosity = 0.01
velocity = [2, 0, 0]
[grid]
cells = [16, 8, 6]
domain = [[0, 1.6], [0, 0.8], [0, 0.6]]
boundary = { x = ["inflow", "outflow"], y = "slip", z = "periodic" }
[[body]]
kind = "plate"
normal = "x"
centre = [0.6, 0.37, 0.3]
lengths = [0.4, 0.6]
edge_length = 0.05
porosity = { law = "forchheimer", alpha = 3, beta = 1 }
[[body]]
kind = "plate"
normal = "y"
centre = [1.1, 0.4, 0.3]
lengths = [0.3, 0.6]
edge_length = 0.05
[run]
end_time = 0.3
max_dt = 0.01
[output]
fields = ["velocity", "pressure"]
times = [0.12, 0.3]
history_every = 5
"""

# A small canopy that opens behind a held payload.
CANOPY = """\
app = "parachute"
[fluid]
density = 1.225
viscosity = 1.8e-5
velocity = [0, 0, 8]
[grid]
cells = [20, 20, 30]
domain = [[-2, 2], [-2, 2], [-2.6, 3.4]]
boundary = { x = "slip", y = "slip", z = ["inflow", "outflow"] }
[flow]
time = "ab2"
[[canopy]]
kind = "flat-circular"
diameter = 2
gores = 8
vent = 0.3
edge_length = 0.14
lines = { length = 1.8, stiffness = 2000 }
payload = { mass = 2, fixed = true }
reinforcement = { skirt = 500 }
[run]
end_time = 0.2
max_dt = 0.01
cfl = 0.25
[output]
fields = ["velocity", "position", "von_mises"]
times = [0.1, 0.2]
history_every = 2
[verify]
force_balance = 1e-14
"""

# The gust on a stretched grid that is given by its faces.
GROWING = GUST.replace("cells = [12, 10, 8]\ndomain = [[0, 2], [0, 1], [0, 1]]\n",
                       "faces = [[0, 0.1, 0.2, 0.32, 0.46, 0.62, 0.8, 1, 1.2, 1.4, 1.6, 1.8, 2], "
                       "[0, 0.06, 0.14, 0.24, 0.36, 0.5, 0.64, 0.76, 0.86, 0.94, 1], [0, 0.2, 0.35, 0.5, 0.65, 0.8, 1]]\n")

# The canopy in the same cells, as the core of a grid of six times the section.
CORE = CANOPY.replace("cells = [20, 20, 30]\ndomain = [[-2, 2], [-2, 2], [-2.6, 3.4]]\n",
                      "core = [[-2, 2], [-2, 2], [-2.6, 3.4]]\nspacing = 0.2\ngrowth = 1.1\ndomain = [[-5, 5], [-5, 5], [-5, 8]]\n")

# A sheet that the air carries through a periodic side to the image of a disk.
DRIFT = """\
app = "parachute"
[fluid]
density = 1.2
viscosity = 0.01
velocity = [0, 0, 2]
[grid]
cells = [16, 16, 16]
domain = [[0, 1.6], [0, 1.6], [0, 1.6]]
boundary = { x = "slip", y = "slip", z = "periodic" }
[[body]]
kind = "disk"
normal = "z"
centre = [0.8, 0.8, 0.2]
radius = 0.25
edge_length = 0.07
[[canopy]]
kind = "sheet"
diameter = 0.8
gores = 6
vent = 0
edge_length = 0.07
centre = [0.8, 0.8, 1.2]
[run]
end_time = 0.6
max_dt = 0.01
[output]
history_every = 10
"""


def statistic(column, name, value, tolerance, **more):
    """Element of `verify.history` for `--set`; `from_` is its `from`."""
    keys = {"column": f"'{column}'", "statistic": f"'{name}'", "value": value, "tolerance": tolerance, **more}
    return "{" + ",".join(f"{key.rstrip('_')}={text}" for key, text in keys.items()) + "}"


class FlowTest(gas_program.GasTest):
    """Test case whose programs run in an empty temporary folder."""

    program = PROGRAM

    def assert_continues(self, rows, scene, first, sets, columns=(), out="half"):
        """Asserts that a run of the scene with sets `first`, continued with `sets`, ends like a run with the history `rows`."""
        words = ("--quiet", "--backend", "serial", "--out", out)
        self.expect(0, scene, *words, sets=first)
        self.expect(0, scene, *words, "--restart", f"{out}/restart.h5", sets=sets)
        again = self.history(out)
        for name in columns or rows:
            self.assertEqual(rows[name][-1], again[name][-1], name)

    def measured(self, name):
        """Quantity of a check in the run directory `out`."""
        return next(check["measured"] for check in self.result("out")["checks"] if check["name"] == name)
