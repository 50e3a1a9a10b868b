# ctest-label: no-sanitizer
"""Extreme settings: a run succeeds or reports a failure; its state is finite and conserved quantities are conserved."""

import itertools
import math
import random

import gas_program

LENIENT = {scene: ["verify.l1_density=1e9"] for scene in gas_program.SCENES}
LENIENT["sedov"] = ["verify.max_density.tolerance=1e9"]
for with_reference in ("blast", "shu-osher"):
    LENIENT[with_reference] = ["verify.l1_density=1e9", "verify.reference.cells=1204"]


def riemann(left, right):
    states = [f"{{ rho = {rho!r}, u = {u!r}, p = {p!r} }}" for rho, u, p in (left, right)]
    return f"initial.riemann={{ x0 = 0.0, left = {states[0]}, right = {states[1]} }}"


class Hostile(gas_program.GasTest):
    def try_run(self, codes, scene, *sets, backend="serial"):
        """Runs without fields; returns the exit code and the content of result.json."""
        # Exact solutions are of the scene's own boundaries.
        other_ends = any(text.startswith("boundary") for text in sets)
        checks = ["verify={conservation=1e9}"] if other_ends else LENIENT[scene]
        run = self.start(scene, "--quiet", "--overwrite", "--out", "run", "--backend", backend,
                         sets=[gas_program.NO_FIELDS, *checks, *sets])
        self.assertIn(run.returncode, codes, f"{run.args}\n{run.stderr}")
        self.assertEqual(0 if run.returncode == 0 else 1, len(run.stderr.splitlines()))
        reported = self.result("run")
        if run.returncode == 0:
            for value in [*reported["errors"].values(), *(check["value"] for check in reported["checks"])]:
                self.assertTrue(value is not None and math.isfinite(value), f"{run.args}\n{reported}")
            conservation = next(check for check in reported["checks"] if check["name"] == "conservation")
            self.assertLess(conservation["value"], 1e-11)
        return run.returncode, reported

    def test_runs_on_the_smallest_meshes(self):
        for scene in gas_program.SCENES:
            for cells in (8, 9):
                with self.subTest(scene=scene, cells=cells):
                    self.try_run({0}, scene, f"mesh.cells={cells}")

    def test_random_settings_end_well_or_report_failure(self):
        choose = random.Random(4).choice
        for number in range(60):
            scene = choose([name for name in gas_program.SCENES if name != "sedov"])
            limiter = choose(("off", "on", "auto"))
            sets = [f"mesh.cells={choose((8, 11, 31, 32, 33, 64, 127, 128, 255, 256, 257, 300))}",
                    f'scheme.weno="{choose(("js", "z", "m", "teno5"))}"',
                    f'scheme.splitting="{choose(("lf-global", "lf-single", "lf-stencil"))}"',
                    f'scheme.time="{choose(("ssprk3", "ssprk43"))}"',
                    f'scheme.mean="{choose(("arithmetic", "conserved", "roe"))}"', f'scheme.positivity="{limiter}"',
                    f'scheme.precision="{choose(("double", "split"))}"', f"output.history_every={choose((0, 1, 7))}",
                    f"tuning.stage.block={choose((32, 64, 96, 512))}"]
            if scene != "entropy-wave":
                sets += [f"scheme.cfl={choose((0.1, 0.4, 0.6, 1.2, 2.0))}", f"scheme.ramp_steps={choose((0, 1, 20))}",
                         f'boundary.left="{choose(("outflow", "reflecting"))}"',
                         f'boundary.right="{choose(("outflow", "reflecting"))}"']
            with self.subTest(number=number, scene=scene, sets=sets):
                self.try_run({0, 4} if limiter == "off" else {0}, scene, *sets, backend=choose(("serial", gas_program.threaded())))

    def test_runs_with_extreme_gammas(self):
        for gamma in (1.000001, 1.0001, 1.01, 3, 100):
            with self.subTest(gamma):
                self.try_run({0}, "lax", f"gas.gamma={gamma}")

    def test_runs_in_extreme_units(self):
        """Air of low and high density, at low and high speed."""
        air, vacuum = (1.2, 0.0, 1013250.0), (1.2e-3, 0.0, 101.325)
        for left, right, end in ((air, (1.2, 0.0, 101325.0), 1e-3), (air, vacuum, 1e-4), (vacuum, air, 1e-4),
                                 ((1e-10, 0.0, 1e-10), (1e-11, 0.0, 1e-11), 0.4),
                                 ((1e10, 0.0, 1e15), (1e9, 0.0, 1e14), 1e-4),
                                 ((1.0, 1e6, 1.0), (1.0, 1e6, 1.0), 1e-7), ((1.0, -1e3, 1.0), (1.0, 1e3, 1.0), 1e-4),
                                 ((1.0, 1e3, 1.0), (1.0, -1e3, 1.0), 1e-4)):
            with self.subTest(left=left, right=right):
                self.try_run({0}, "sod", riemann(left, right), f"run.end_time={end!r}")

    def test_runs_on_extreme_domains(self):
        for length in (1e-8, 1e8):
            self.try_run({0}, "sod", f"mesh.domain=[{-length!r}, {length!r}]", f"run.end_time={0.4 * length!r}")

    def test_reports_overflow_in_the_first_step(self):
        """Expects a reported failure in the first step instead of a wrong result."""
        for left, right in (((1.0, 0.0, 1e300), (1.0, 0.0, 1e299)), ((1.0, 0.0, 1e200), (1.0, 0.0, 1e-200)),
                            ((1.0, 1e150, 1.0), (1.0, -1e150, 1.0))):
            with self.subTest(left=left, right=right):
                reported = self.try_run({4}, "sod", riemann(left, right))[1]
                self.assertIn("not finite in cell", reported["message"])
                self.assertEqual(0, reported["steps"])

    def test_runs_for_extreme_times(self):
        for end in ("5e-324", "1e-300", "1e-17"):
            self.assertEqual((1, float(end)), tuple(self.try_run({0}, "sod", f"run.end_time={end}")[1][key]
                                                    for key in ("steps", "time")))
        reported = self.try_run({4}, "sod", "run.end_time=1e300", "run.max_steps=50")[1]
        self.assertRegex(reported["message"], r"^run\.max_steps = 50 reached at t = \S+ s, before run\.end_time = \S+ s$")

    def test_max_steps_may_equal_the_steps_needed(self):
        steps = self.try_run({0}, "sod")[1]["steps"]
        self.try_run({0}, "sod", f"run.max_steps={steps}")
        self.try_run({4}, "sod", f"run.max_steps={steps - 1}")

    def test_reports_a_violated_time_step_limit(self):
        for step in ("0.01", "0.1", "1e10"):
            with self.subTest(step):
                reported = self.try_run({4}, "sod", f"scheme.fixed_dt={step}", 'scheme.positivity="off"')[1]
                self.assertRegex(reported["message"], r"(pressure|density) is not positive in cell \d+ \(x = .* m\) at step ")
        for step, positivity in itertools.product(("0.1", "1"), ("on", "auto")):
            with self.subTest(step=step, positivity=positivity):
                reported = self.try_run({4}, "sod", f"scheme.fixed_dt={step}", f'scheme.positivity="{positivity}"')[1]
                self.assertRegex(reported["message"], r" at step \d+, t = \S+ s; a shorter scheme\.fixed_dt may save the run$")
        for step in ("0.006", "0.01"):  # the first one that the limiter refuses, in a later step
            reported = self.try_run({4}, "sod", f"scheme.fixed_dt={step}", 'scheme.positivity="on"')[1]
            self.assertRegex(reported["message"], rf"^(scheme\.fixed_dt = {step} s moves waves by more than half a cell in a stage|density|pressure)")
        reported = self.try_run({0}, "sod", "scheme.fixed_dt=0.001", 'scheme.positivity="on"')[1]
        self.assertEqual(0, reported["limiter"]["redone_steps"])

    def test_long_runs_with_reflections_end_well(self):
        for left, right in (("reflecting", "outflow"), ("outflow", "reflecting"), ("reflecting", "reflecting"),
                            ("periodic", "periodic")):
            with self.subTest(left=left, right=right):
                self.try_run({0}, "toro-4", f'boundary.left="{left}"', f'boundary.right="{right}"', "run.end_time=0.3",
                             "mesh.cells=100")


class DenseOutput(gas_program.GasTest):
    def test_writes_all_outputs_at_every_step(self):
        times = [0.4 * i / 100 for i in range(101)]
        self.expect(0, "sod", "--backend", "serial", "--quiet", "--out", "run", sets=[
            "mesh.cells=20", "verify.l1_density=1.0", "output.history_every=1", "output.restart_every=1",
            f"output.times={times}"])
        file = gas_program.fields(self.folder / "run")
        groups = file.children("/steps")
        self.assertEqual(times, [file.attributes[f"/steps/{group}"]["time"] for group in groups])
        self.assertGreaterEqual(self.result("run")["steps"], 100)

    def test_keeps_output_times_that_differ_by_rounding(self):
        times = [0.0, 0.2, math.nextafter(0.2, 1.0), math.nextafter(0.4, 0.0), 0.4]
        self.expect(0, "sod", "--backend", "serial", "--quiet", "--out", "run", sets=[
            "mesh.cells=50", "verify.l1_density=1.0", f"output.times={times}"])
        file = gas_program.fields(self.folder / "run")
        self.assertEqual(times, [file.attributes[f"/steps/{group}"]["time"] for group in file.children("/steps")])
