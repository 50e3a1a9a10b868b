# ctest-label: no-sanitizer
"""drogue-parachute: steps that nothing in the scene names, of every kind of drive, against exact solutions."""

import math
import os
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import parachute_program
from parachute_program import CANOPY

QUIET = ("--quiet", "--backend", "serial", "--out", "out", "--overwrite")

CHANNEL = """app = "parachute"
[fluid]
density = 1.0
viscosity = 0.1
[grid]
cells = [4, 32, 1]
domain = [[0, 1], [0, 1], [0, 1]]
boundary = { x = "periodic", y = "wall" }
[run]
end_time = 0.7
[output]
history_every = 1
"""

SCHEMES = ("diffusion='crank-nicolson'", "time='ab2'", "time='rk3'")


def flow(*entries):
    return "flow={" + ",".join(entries) + "}"


# A plate that moves all fluid of a channel.
PISTON = """app = "parachute"
[fluid]
density = 1.2
viscosity = 0
[grid]
cells = [16, 4, 4]
domain = [[0, 1.6], [0, 0.4], [0, 0.4]]
boundary = { x = "periodic", y = "periodic", z = "periodic" }
[[body]]
kind = "plate"
normal = "x"
centre = [0.83, 0.2, 0.2]
lengths = [0.4, 0.4]
edge_length = 0.05
motion = { x = "0.002*(1-cos(20*pi*t))" }
[run]
end_time = 0.4
[output]
history_every = 1
"""


class Drives(parachute_program.FlowTest):
    def check(self, text, *sets, code=0):
        self.expect(code, self.write(text), *QUIET, sets=list(sets))
        return self.history("out")

    def test_wall_that_moves_from_the_start(self):
        series = "+".join(f"({2 * (-1) ** n / n}/pi*exp({-0.1 * n * n}*pi^2*t)*sin({n}*pi*y))" for n in range(1, 6))
        for scheme in SCHEMES:
            with self.subTest(scheme):
                self.check(CHANNEL, "grid.wall_velocity={y_high=[1,0,0]}", flow(scheme),
                           f"verify={{exact={{x='y+{series}',y=0,z=0}},linf_velocity=2e-3}}")

    def test_force_and_pressure_drop(self):
        series = "+".join(f"({-32 / n ** 3}/pi^3*exp({-0.1 * n * n}*pi^2*t)*sin({n}*pi*y))" for n in range(1, 8, 2))
        for drive in ("body_force", "pressure_drop"):
            for scheme in SCHEMES:
                with self.subTest(scheme=scheme, drive=drive):
                    self.check(CHANNEL, flow(scheme, f"{drive}=[0.8,0,0]"), f"verify={{exact={{x='4*y*(1-y)+{series}',y=0,z=0}},linf_velocity=2e-3}}")

    def test_shear_wave(self):
        rows = self.check(CHANNEL, flow(SCHEMES[0]), "grid.boundary={x='periodic',y='periodic'}", "run.end_time=10",
                          "initial.velocity=['0.01*sin(2*pi*y)',0,0]", "verify={exact={x='0.01*exp(-0.4*pi^2*t)*sin(2*pi*y)',"
                          "y=0,z=0},linf_velocity=1e-18}")
        self.assertLess(rows["step"][-1], 1000)

    def test_walls_in_rapid_motion(self):
        # Both walls take the fluid along, but for thin layers: a step may not be blind to 50 periods.
        for scheme in SCHEMES:
            with self.subTest(scheme):
                rows = self.check(CHANNEL, flow(scheme), "grid.wall_velocity={y_high=['sin(100*pi*t)',0,0]}", "run.end_time=1", "verify={}")
                self.assertGreater(rows["step"][-1], 50 * 16)

    def test_lid_over_thin_fluid(self):
        for scheme in SCHEMES:
            with self.subTest(scheme):
                scene = (flow(scheme), "fluid.viscosity=2e-5", "grid.cells=[48,48,1]", "grid.boundary={x='wall',y='wall'}",
                         "grid.wall_velocity={y_high=[1,0,0]}", "run.end_time=2")
                rows = self.check(CHANNEL, *scene)
                fine = self.check(CHANNEL, *scene, "run.max_dt=0.005")
                self.assertAlmostEqual(fine["max_speed"][-1], rows["max_speed"][-1], delta=2e-3)
                self.assertLess(max(rows["max_speed"]), 1)

    def test_inflow_that_begins_late(self):
        for scheme in SCHEMES:
            with self.subTest(scheme):
                rows = self.check(CHANNEL, flow(scheme), "fluid={viscosity=1e-3,density=1,velocity=['(t<1) ? 0 : 1/cosh(5*y)^2+0.1',0,0]}",
                                  "grid={cells=[48,32,1],domain=[[0,6],[-2,2],[0,1]],boundary={x=['inflow','outflow'],y='slip'}}",
                                  "run.end_time=4")
                self.assertLess(max(rows["max_speed"]), 1.3)
                self.assertIn(1.0, [round(t, 12) for t in rows["time"]])

    def test_plate_that_moves_all_fluid(self):
        rows = self.check(PISTON)
        mass = 1.2 * 1.6 * 0.16
        exact = mass * 0.002 * (20 * math.pi) ** 2
        # After the start, whose acceleration jumps.
        late = [abs(f) for f, t in zip(rows["body_0_force_x"], rows["time"], strict=True) if t > 0.1]
        self.assertAlmostEqual(exact, max(late), delta=0.08 * exact)

    def test_acceleration_of_a_small_fast_part_of_a_motion(self):
        """It is a five-hundredth of the displacement, and most of the acceleration."""
        motion = "0.05*(1-cos(2*pi*t))+1e-4*sin(100*pi*t)"
        rows = self.check(PISTON, f"body[0].motion.x='{motion}'", "run.end_time=0.1")
        force = [f for f, t in zip(rows["body_0_force_x"], rows["time"], strict=True) if t > 0.05]
        exact = 1.2 * 1.6 * 0.16 * 1e-4 * (100 * math.pi) ** 2
        self.assertAlmostEqual(exact, (max(force) - min(force)) / 2, delta=0.08 * exact)

    def test_motion_counts_within_the_run_alone(self):
        """It need not be defined later than a step after it; its argument may be large; a value that is not finite ends the run."""
        mass = 1.2 * 1.6 * 0.16
        exact = mass * 0.002 * (20 * math.pi) ** 2
        for end in (0.9, 0.205):
            rows = self.check(PISTON, f"body[0].motion.x='0.002*(1-cos(20*pi*t))+0*sqrt({end}-t)'", "run.end_time=0.2")
            late = [abs(f) for f, t in zip(rows["body_0_force_x"], rows["time"], strict=True) if t > 0.1]
            self.assertAlmostEqual(exact, max(late), delta=0.08 * exact)
            self.assertAlmostEqual(exact, late[-1], delta=0.08 * exact)
        rows = self.check(PISTON, "body[0].motion.x='0.002*sin(20*pi*(t+160000))'", "run.end_time=0.2")
        late = [abs(f) for f, t in zip(rows["body_0_force_x"], rows["time"], strict=True) if t > 0.1]
        self.assertAlmostEqual(exact, max(late), delta=0.08 * exact)
        # The window lies between the times that the check samples.
        motion = "0.02*sin(20*t)+0*sqrt(abs(10*t-1.0078)-0.006)"
        message = self.expect(4, self.write(PISTON), *QUIET, sets=[f"body[0].motion.x='{motion}'", "run.max_dt=5e-4"]).stderr
        self.assertRegex(message, r"body\[0\]\.motion\.x = 0\.02\*sin.* is not finite at t = 0\.10\d* s")

    def test_closed_box_under_gravity_stays_at_rest(self):
        for viscosity in (1, 100):
            rows = self.check(CHANNEL, flow(SCHEMES[0], "body_force=[0,-9810,0]"), "fluid.density=1000",
                              f"fluid.viscosity={viscosity}", "grid.boundary={x='wall',y='wall'}", "grid.cells=[16,16,1]")
            self.assertLess(max(rows["max_speed"]), 1e-12)

    def test_step_that_outgrows_its_bound_ends_the_run(self):
        cylinder = """
[[body]]
kind = "cylinder"
axis = "z"
centre = [0.5, 0.5, 0.5]
radius = 0.2
length = 1
edge_length = 0.02
"""
        for text in (CHANNEL, CHANNEL + cylinder):
            said = self.expect(4, self.write(text), *QUIET, sets=["fluid.viscosity=2e-5", "grid.cells=[32,32,1]",
                                                                  "grid.boundary={x='wall',y='wall'}", "grid.wall_velocity={y_high=[1,0,0]}",
                                                                  "run.end_time=2", "run.dt=2"]).stderr
            self.assertIn("largest stable time step", said)

    def test_lid_over_a_body_at_rest(self):
        lid = ["fluid.viscosity=2e-5", "grid.cells=[32,32,1]", "grid.boundary={x='wall',y='wall'}", "grid.wall_velocity={y_high=[1,0,0]}",
               "body=[{kind='cylinder',axis='z',centre=[0.5,0.5,0.5],radius=0.2,length=1,edge_length=0.02}]", "run.end_time=2"]
        rows, fine = self.check(CHANNEL, *lid), self.check(CHANNEL, *lid, "run.max_dt=0.005")
        self.assertAlmostEqual(fine["max_speed"][-1], rows["max_speed"][-1], delta=5e-3)

    def test_runs_without_an_end_in_sight_are_refused(self):
        scene = self.write(CHANNEL)
        for sets in (["run.dt=1e-300"], ["fluid.density=1e-300"], ["fluid.viscosity=1e13"]):
            self.assertIn("run.max_steps", self.expect(3, scene, *QUIET, sets=sets).stderr)

    def test_sheets_that_nothing_moves_need_a_largest_step(self):
        still = CANOPY.replace("max_dt", "# max_dt")
        self.assertIn("run.max_dt", self.expect(3, self.write(still), *QUIET, sets=["fluid.velocity=[0,0,0]"]).stderr)

    def test_units_of_time_change_no_pressure(self):
        # The unit of time is 2^40 s; fluid at rest beside an inflow that accelerates.
        pressures = []
        for unit in (1.0, 2.0 ** 40):
            self.expect(0, self.write(CHANNEL), *QUIET, sets=[
                f"fluid={{density=1,viscosity={0.1 / unit!r},velocity=['t/{unit!r}^2',0,0]}}", "flow={}",
                "grid={cells=[8,4,1],domain=[[0,1],[0,1],[0,1]],boundary={x=['inflow','outflow'],y='slip'}}",
                f"run.end_time={unit!r}", "output.fields=['pressure']"])
            file = self.fields("out")
            pressures.append([list(file.values(f"/steps/{step}/pressure")) for step in file.children("/steps")])
        for one, other in zip(*pressures, strict=True):
            for a, b in zip(one, other, strict=True):
                self.assertAlmostEqual(a, b * 2.0 ** 80, delta=1e-9)


if __name__ == "__main__":
    unittest.main()
