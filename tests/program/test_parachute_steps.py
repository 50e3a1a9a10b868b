# ctest-label: no-sanitizer
"""drogue-parachute: steps that nothing in the scene names, of every kind of drive, against exact solutions."""

import math

import parachute_program
from parachute_program import CANOPY, statistic

QUIET = ("--quiet", "--backend", "serial", "--out", "out", "--overwrite")


def box(fluid, cells, domain, boundary, end, *tables):
    """A box of fluid whose history has every step."""
    return "\n".join(['app = "parachute"', f"fluid = {{ {fluid} }}", f"run.end_time = {end}", "output.history_every = 1",
                      f"grid = {{ cells = {cells}, domain = {domain}, boundary = {{ {boundary} }} }}", *tables]) + "\n"


def sheet(kind, *entries):
    return "\n".join(["[[body]]", f'kind = "{kind}"', *entries])


def flow(*entries):
    return "flow={" + ",".join(entries) + "}"


SCHEMES = ("diffusion='crank-nicolson'", "time='ab2'", "time='rk3'")
PERIODIC = 'x = "periodic", y = "periodic", z = "periodic"'

CHANNEL = box("density = 1.0, viscosity = 0.1", [4, 32, 1], [[0, 1], [0, 1], [0, 1]], 'x = "periodic", y = "wall"', 0.7)
CYLINDER = sheet("cylinder", 'axis = "z"', "centre = [0.5, 0.3, 0.5]", "radius = 0.1", "length = 1", "edge_length = 0.02")

# A plate that moves all fluid of a channel.
PISTON = box("density = 1.2, viscosity = 0", [16, 8, 8], [[0, 1.6], [0, 0.8], [0, 0.8]], PERIODIC, 0.4,
             sheet("plate", 'normal = "x"', "centre = [0.83, 0.4, 0.4]", "lengths = [0.8, 0.8]", "edge_length = 0.05",
                   'motion = { x = "0.002*(1-cos(20*pi*t))" }'))

# A porous plate that closes a channel with a pressure drop.
CLOSED = box("density = 1, viscosity = 0.01", [24, 4, 4], [[0, 2], [0, 1], [0, 1]], PERIODIC, 2, "flow.pressure_drop = [200, 0, 0]",
             sheet("plate", 'normal = "x"', "centre = [1, 0.5, 0.5]", "lengths = [1, 1]", "edge_length = 0.05",
                   'porosity = { law = "forchheimer" }'))

# A plate in fluid so viscous that its motion changes far more slowly than the fluid.
VISCOUS = box("density = 1, viscosity = 100", [32, 32, 1], [[-3, 3], [-3, 3], [0, 0.1875]], 'x = "periodic", y = "periodic"', 0.07,
              sheet("plate", 'normal = "x"', "centre = [0, 0, 0.09375]", "lengths = [1, 0.1875]", "edge_length = 0.1",
                    'motion = { x = "0.05*sin(10*t)" }'))

# A plate on a spring that moves 24.5 times its own mass.
MOUNT = box("density = 1.225, viscosity = 0", [40, 4, 4], [[0, 2], [0, 0.5], [0, 0.5]], PERIODIC, 4,
            sheet("plate", 'normal = "x"', "centre = [1, 0.25, 0.25]", "lengths = [0.5, 0.5]", "edge_length = 0.05",
                  "mount = { mass = 0.1, stiffness = 40, offset = 0.03 }"))


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

    def test_outputs_and_ends_at_a_jump(self):
        inflow = ("fluid={viscosity=1e-3,density=1,velocity=['(t<0.4) ? 0 : 1/cosh(5*y)^2+0.1',0,0]}",
                  "grid={cells=[32,24,1],domain=[[0,4],[-1.5,1.5],[0,1]],boundary={x=['inflow','outflow'],y='slip'}}")
        wall = ("grid.wall_velocity={y_high=['(t<0.4) ? 0 : 1',0,0]}",)
        for scheme in SCHEMES:
            for drive in (inflow, wall):
                for text in (CHANNEL, CHANNEL + CYLINDER) if drive is wall else (CHANNEL,):
                    with self.subTest(scheme, drive=drive[0], bodies=text.count("body")):
                        scene = (flow(scheme), *drive, "run.end_time=0.6")
                        through = self.check(text, *scene)
                        stopped = self.check(text, *scene, "output.times=[0.4,0.6]")
                        self.assertIn(0.4, stopped["time"])
                        self.assertEqual(0, stopped["max_speed"][stopped["time"].index(0.4)])
                        self.assertAlmostEqual(1, stopped["momentum_x"][-1] / through["momentum_x"][-1], delta=1e-6)
                        # The state at the end of a run is that of an output, also after a restart.
                        self.check(text, *scene, "output.times=[0.4]", "run.end_time=0.4")
                        self.expect(0, self.write(text), "--quiet", "--backend", "serial", "--out", "out", "--restart", "auto",
                                    sets=[*scene, "output.times=[0.4,0.6]"])
                        self.assertEqual(stopped, self.history("out"))

    def test_pulses_shorter_than_a_step(self):
        for scheme in SCHEMES:
            with self.subTest(scheme):
                scene = (flow(scheme), "grid.cells=[1,32,1]", "grid.wall_velocity={y_high=['(t>0.5)&&(t<0.52) ? 1 : 0',0,0]}")
                rows, fine = self.check(CHANNEL, *scene), self.check(CHANNEL, *scene, "run.max_dt=1e-4")
                self.assertAlmostEqual(1, rows["momentum_x"][-1] / fine["momentum_x"][-1], delta=0.1)

    def test_plate_that_moves_all_fluid(self):
        rows = self.check(PISTON)
        mass = 1.2 * 1.6 * 0.64
        exact = mass * 0.002 * (20 * math.pi) ** 2
        self.assertAlmostEqual(9.70, exact, delta=0.005)
        # After the start, whose acceleration jumps.
        late = [abs(f) for f, t in zip(rows["body_0_force_x"], rows["time"], strict=True) if t > 0.1]
        self.assertAlmostEqual(exact, max(late), delta=0.08 * exact)

    def test_plate_that_moves_at_once(self):
        # All fluid has the velocity of the plate in the end, whenever that starts to move.
        for motion, end in (("0.2*t", 1), ("t<0.1037 ? 0 : 0.2*(t-0.1037)", 1.1037)):
            with self.subTest(motion):
                rows = self.check(PISTON, f"body[0].motion={{x='{motion}'}}", f"run.end_time={end}")
                self.assertAlmostEqual(1, rows["momentum_x"][-1] / (0.2 * 1.2 * 1.6 * 0.64), delta=0.02)

    def test_bodies_in_implicit_diffusion_have_the_force_of_explicit_diffusion(self):
        """Without a bound of its own, a step would spread the force of the body over several cells."""
        impulse = {}
        for scheme in (SCHEMES[0], SCHEMES[2]):
            rows = self.check(VISCOUS, flow(scheme))
            steps = [after - before for before, after in zip(rows["time"], rows["time"][1:])]
            impulse[scheme] = sum(dt * force for dt, force in zip(steps, rows["body_0_force_x"][1:]))
        self.assertAlmostEqual(1, impulse[SCHEMES[0]] / impulse[SCHEMES[2]], delta=0.02)
        noted = self.start(self.write(VISCOUS), "--check", sets=[flow(SCHEMES[0]), "run.dt=0.004"])
        self.assertEqual(0, noted.returncode)
        self.assertIn("run.dt = 0.004 s: viscosity spreads", noted.stderr)

    def test_implicit_diffusion_begins_anew_with_late_motion(self):
        # Nothing moves before t = 0.3 s, when a wall, or a cylinder, does at once.
        wall, body = "grid.wall_velocity={y_high=['t<0.3 ? 0 : 1',0,0]}", "body[0].motion={x='t<0.3 ? 0 : 0.2*(t-0.3)'}"
        for text, late in ((CHANNEL, wall), (CHANNEL + CYLINDER, wall), (CHANNEL + CYLINDER, body)):
            with self.subTest(late, bodies=text.count("body")):
                scene = (flow(SCHEMES[0]), "grid.cells=[8,32,1]", late)
                rows, fine = self.check(text, *scene), self.check(text, *scene, "run.max_dt=0.002")
                self.assertIn(0.3, [round(t, 9) for t in rows["time"]])
                self.assertLess(len(rows["time"]), 0.7 * len(fine["time"]))
                for column in ("momentum_x", *(["body_0_force_x"] if "body" in text else [])):
                    delta = 0.015 if column == "momentum_x" else 0.1
                    self.assertAlmostEqual(1, rows[column][-1] / fine[column][-1], delta=delta, msg=column)

    def test_steps_beside_bodies_grow_by_degrees(self):
        rows = self.check(CHANNEL + CYLINDER, flow(SCHEMES[0], "body_force=[0.8,0,0]"), "grid.cells=[8,32,1]")
        steps = [b - a for a, b in zip(rows["time"], rows["time"][1:])]
        self.assertGreater(max(steps), 8 * steps[0])
        for one, next in zip(steps, steps[1:]):
            self.assertLess(next, (2 + 1e-6) * one)

    def test_sheets_that_close_a_channel(self):
        """Cloth of MIL-C-7020, an impermeable plate and a bed of grains across a channel, with every default."""
        alpha, beta, drop = 254.4, 37.6, 200
        steady = (-alpha + math.sqrt(alpha**2 + 4 * beta * drop)) / (2 * beta)
        open_sides = ("grid.boundary.x='outflow'", "flow={body_force=[100,0,0]}")
        for sets, velocity, tolerance in (
                ((), steady, 1e-9), (("coupling={method='sharp'}",), steady, 1e-6), (("coupling={filter=0}",), steady, 1e-9),
                (("grid={cells=[96,4,4],domain=[[0,8],[0,1],[0,1]],boundary={x='periodic',y='periodic',z='periodic'}}",), steady, 1e-3),
                (open_sides, 0.7106, 2e-3), (("body[0].porosity={law='none'}",), 0, 1e-9),
                (("grid.boundary={x='periodic',y='slip',z='slip'}", "grid.cells=[24,12,12]", "coupling={method='sharp'}"), steady, 1e-6)):
            with self.subTest(sets):
                rows = self.check(CLOSED, *sets)
                length = 8 if "domain" in str(sets) else 2
                speeds = [m / length for m in rows["momentum_x"]]
                for before, after in zip(speeds, speeds[1:], strict=False):
                    self.assertGreater(after, before - 1e-3)
                self.assertLess(max(speeds), velocity + 1e-3)
                self.assertAlmostEqual(velocity, speeds[-1], delta=tolerance)
                self.assertAlmostEqual(drop, rows["body_0_force_x"][-1], delta=0.3)

    def test_sheets_through_which_a_stream_is_prescribed(self):
        stream = CLOSED.replace("flow.pressure_drop = [200, 0, 0]\n", "").replace("density = 1", "velocity = [1, 0, 0], density = 1").replace(
            'x = "periodic"', 'x = ["inflow", "outflow"]')
        walls = ("grid.boundary.y='wall'", "grid.boundary.z='wall'", "grid.cells=[24,12,12]", "coupling={method='sharp'}")
        ergun = "body[0].porosity={law='ergun',void_fraction=0.4,thickness=0.01,grain=1e-5}"
        bed = 150 * 0.01 * 0.36 * 0.01 / (0.064 * 1e-10) + 1.75 * 0.6 * 0.01 / (0.064 * 1e-5)
        for sets, force in (((), 292), (("coupling={filter=0}",), 292), (("coupling={method='sharp'}",), 292),
                            ((ergun, "fluid.viscosity=1e-5"), 1e-3 * (bed - 1.75 * 0.6 * 0.01 / (0.064 * 1e-5)) + 1.75 * 0.6 * 0.01 / (0.064 * 1e-5))):
            with self.subTest(sets):
                rows = self.check(stream, "run.end_time=0.5", *sets)
                for found in rows["body_0_force_x"][1:]:
                    self.assertAlmostEqual(force, found, delta=1e-6 * force)
        rows = self.check(stream, "run.end_time=0.3", *walls)
        self.assertAlmostEqual(292, rows["body_0_force_x"][-1], delta=3)
        rows = self.check(stream, "run.end_time=3", "fluid.velocity=['0.5+0.3*sin(2*t)',0,0]")
        for time, found in list(zip(rows["time"], rows["body_0_force_x"], strict=True))[2:]:
            u = 0.5 + 0.3 * math.sin(2 * time)
            self.assertAlmostEqual(254.4 * u + 37.6 * u * u, found, delta=12)

    def test_plate_that_moves_the_fluid_of_a_long_channel(self):
        rows = self.check(PISTON, "grid={cells=[80,4,4],domain=[[0,4],[0,0.4],[0,0.4]],boundary={x='periodic',y='periodic',z='periodic'}}",
                          "body[0].centre=[2.03,0.2,0.2]", "body[0].lengths=[0.4,0.4]")
        exact = 1.2 * 4 * 0.16 * 0.002 * (20 * math.pi) ** 2
        late = [abs(f) for f, t in zip(rows["body_0_force_x"], rows["time"], strict=True) if t > 0.1]
        self.assertAlmostEqual(exact, max(late), delta=0.05 * exact)

    def test_plates_on_springs_bound_their_steps(self):
        for offset in (0.0003, 0.03):
            rows = self.check(MOUNT, f"body[0].mount.offset={offset}", (
                "verify={history=[" + statistic("body_0_displacement", "frequency", 1.1925, 0.01) + "," +
                statistic("body_0_displacement", "amplitude", offset, 0.01) + "]}"))
            self.assertGreater(len(rows["time"]), 1000)
        for sets, words in (("run.dt=0.02", "run.dt = 0.02 s does not resolve body[0].mount"),
                            ("run.max_dt=0.05", "run.max_dt = 0.05 s does not resolve body[0].mount")):
            process = self.start(self.write(MOUNT), "--check", sets=[sets])
            self.assertEqual(0, process.returncode)
            self.assertIn(words, process.stderr)
        self.expect(0, self.write(MOUNT), "--check", sets=["run.max_dt=0.005"])

    def test_acceleration_of_a_small_fast_part_of_a_motion(self):
        """It is a five-hundredth of the displacement, and most of the acceleration."""
        motion = "0.05*(1-cos(2*pi*t))+1e-4*sin(100*pi*t)"
        rows = self.check(PISTON, f"body[0].motion.x='{motion}'", "run.end_time=0.1")
        force = [f for f, t in zip(rows["body_0_force_x"], rows["time"], strict=True) if t > 0.05]
        exact = 1.2 * 1.6 * 0.64 * 1e-4 * (100 * math.pi) ** 2
        self.assertAlmostEqual(exact, (max(force) - min(force)) / 2, delta=0.08 * exact)

    def test_motion_counts_within_the_run_alone(self):
        """It need not be defined later than a step after it; its argument may be large; a value that is not finite ends the run."""
        mass = 1.2 * 1.6 * 0.64
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
        for text in (CHANNEL, CHANNEL + CYLINDER.replace("0.3", "0.5").replace("0.1", "0.2")):
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
