# ctest-label: no-sanitizer
"""drogue-parachute: command line, run directory, failures, verification and studies."""

import array
import itertools
import math
import os
import re
import shutil
import signal
import sys
import xml.etree.ElementTree

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/negative")

import bad_bodies
import bad_canopies
import bad_flags
import gas_program
import parachute_program
from parachute_program import CANOPY, CLOTH, GUST, PLATE, VORTICES, statistic

QUIET = ("--quiet", "--backend", "serial", "--out", "out")


def mean_from(begin, times, values):
    """Mean from a time to the last row by the trapezoidal rule, with the value at that time between two rows."""
    first = next(k for k, time in enumerate(times) if time >= begin)
    share = (begin - times[first - 1]) / (times[first] - times[first - 1])
    points = [(begin, values[first - 1] + share * (values[first] - values[first - 1])), *zip(times[first:], values[first:], strict=True)]
    areas = sum((after[0] - before[0]) * (before[1] + after[1]) / 2 for before, after in itertools.pairwise(points))
    return areas / (times[-1] - begin)


class CommandLine(parachute_program.FlowTest):
    def test_information_needs_no_scene(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"^drogue-parachute \d+\.\d+\.\d+\n")
        self.assertIn("--study", self.expect(0, "--help").stdout)
        self.assert_lists(parachute_program.SCENES)
        for line in self.expect(0, "--list-scenes").stdout.splitlines():
            self.assertEqual(line.split()[0].endswith("-full"), line.endswith("[gpu]"), line)

    def test_printed_scenes_resolve_to_themselves(self):
        for text in (GUST, VORTICES, *parachute_program.SMALL_SCENES):
            with self.subTest(text.splitlines()[0]):
                self.resolved(self.write(text) if "\n" in text else text)

    def test_reports_usage_errors(self):
        for words in (["cavitty"], ["cavity", "extra"], ["cavity", "--study", "meshes=1:2"],
                      ["jet", "--study", "meshes=16:32"]):
            with self.subTest(words):
                self.expect(2, *words)
        self.assertEqual([], list(self.folder.iterdir()))
        self.assertRegex(self.expect(2, "cavity", "--seed-mod").stderr, r"^drogue-parachute: (?!drogue-).*--seed-mod")

    def test_seed_mode_replaces_the_scheme_and_the_cloth(self):
        for scene, lines in (("cavity", ['time = "rk3"', 'weno = "js"']), ("oscillating-plate-implicit", ['diffusion = "explicit"']),
                             ("c9-drop-full", ['method = "explicit"', 'cloth = "custom"', "area_density = 5.0", 'time = "rk3"']),
                             (self.write(CANOPY.replace("lines =", 'cloth = "custom"\narea_density = 2\nlines =')), ["area_density = 2.0"])):
            printed = self.resolved(scene, "--seed-mode")
            for line in lines:
                self.assertIn("\n" + line + "\n", printed)
        self.assertIn("--seed-mode", self.expect(0, "--help").stdout)


class RunDirectory(parachute_program.FlowTest):
    def test_files_hold_the_documented_layout(self):
        scene = self.write(GUST)
        self.expect(0, scene, *QUIET)
        reported = self.result("out")
        self.assertEqual(("drogue.result/1", "drogue-parachute", "ok", 0, 0.5),
                         tuple(reported[key] for key in ("schema", "program", "status", "exit_code", "time")))
        self.assertIn(reported["pressure"]["solver"], ("fft", "diagonalization"))
        self.assertLess(reported["pressure"]["divergence_rms"], 1e-12)
        self.assertGreater(reported["dt_min"], 0.0)
        file = self.fields("out")
        for path, count in (("/mesh/x", 13), ("/mesh/y", 11), ("/mesh/z", 9), ("/steps/000000/velocity", 3 * 960),
                            ("/steps/000001/vorticity", 3 * 960), ("/steps/000001/pressure", 960),
                            ("/steps/000001/q_criterion", 960)):
            self.assertEqual(8 * count, len(file.datasets[path]), path)
            self.assertEqual({"units", "centering", "description"}, set(file.attributes[path]))
        self.assertEqual([0.0, 2.0], [list(file.values("/mesh/x"))[k] for k in (0, -1)])
        self.assertEqual([0.2, 0.5], [file.attributes[f"/steps/{k}"]["time"] for k in file.children("/steps")])
        xdmf = (self.folder / "out/fields.xdmf").read_text(encoding="utf-8")
        for word in ("/steps/000001/velocity", 'AttributeType="Vector"', 'Dimensions="12 10 8 3"', 'Value="0.5"'):
            self.assertIn(word, xdmf)
        printed = self.expect(0, scene, "--print-scene").stdout
        self.assertEqual(printed, (self.folder / "out/scene.toml").read_text(encoding="utf-8"))

    def test_history_lists_energies_and_flow_rates(self):
        self.expect(0, self.write(GUST), *QUIET)
        header = (self.folder / "out/history.csv").read_text(encoding="utf-8").splitlines()[0].split(",")
        for name in ("time [s]", "kinetic_energy [J]", "dissipation [W]", "momentum_z [kg m/s]", "divergence_max [1/s]",
                     "outflow_x_low [m^3/s]", "outflow_z_high [m^3/s]"):
            self.assertIn(name, header)
        rows = self.history("out")
        self.assertEqual((0.0, 0.5), (rows["time"][0], rows["time"][-1]))
        self.assertTrue(all(step % 3 == 0 for step in rows["step"][:-1]))
        for now, entering, leaving in zip(rows["time"], rows["outflow_x_low"], rows["outflow_x_high"], strict=True):
            # Midpoint sum of the inflow expression over ten cells.
            means = [0.2 * y * (1 - y) for y in ((j + 0.5) / 10 for j in range(10))]
            self.assertAlmostEqual(-(1 + 0.3 * math.sin(5 * now) + sum(means) / 10), entering, delta=1e-12)
            self.assertAlmostEqual(-entering, leaving, delta=1e-12)
        self.assertEqual(0, self.result("out")["ledger"]["device_allocations_after_warmup"])

    def test_periodic_sides_have_no_flow_rates(self):
        self.expect(0, self.write(VORTICES), *QUIET)
        self.assertNotIn("outflow", (self.folder / "out/history.csv").read_text(encoding="utf-8"))

    def test_fields_hold_the_solution_at_cell_centres(self):
        self.expect(0, self.write(VORTICES), *QUIET, sets=[
            'output.fields=["velocity","vorticity","pressure"]', "output.times=[0]", "grid.cells=[64, 64, 1]"])
        file = self.fields("out")
        velocity, vorticity = (list(file.values(f"/steps/000000/{name}")) for name in ("velocity", "vorticity"))
        h = 2 * math.pi / 64
        for i in range(0, 64, 5):
            for j in range(0, 64, 7):
                x, y, cell = (i + 0.5) * h, (j + 0.5) * h, 3 * (64 * i + j)
                self.assertAlmostEqual(math.sin(x) * math.cos(y), velocity[cell], delta=3e-3)
                self.assertAlmostEqual(-math.cos(x) * math.sin(y), velocity[cell + 1], delta=3e-3)
                self.assertAlmostEqual(2 * math.sin(x) * math.sin(y), vorticity[cell + 2], delta=1e-2)

    def test_writes_only_requested_files(self):
        self.expect(0, self.write(VORTICES), *QUIET, sets=["output={history_every=0}"])
        self.assertEqual({"restart.h5", "scene.toml", "result.json"}, {file.name for file in (self.folder / "out").iterdir()})

    def launches(self, *sets):
        self.expect(0, self.write(VORTICES), *QUIET, "--overwrite", sets=["verify={}", "output={history_every=0}", *sets])
        return self.result("out")["ledger"]["kernel_launches"]

    def test_parts_that_are_not_requested_do_not_run(self):
        base = self.launches("flow.time=ab2")
        for requested in ("output.history_every=1", "output={history_every=0,fields=['vorticity'],times=[0.5]}",
                          "flow.time=rk3"):
            self.assertGreater(self.launches("flow.time=ab2", requested), base, requested)
        steps = 10
        for scheme in ("flow.time=ab2", "flow.time=rk3"):
            base, shorter, longer = (self.launches(scheme, *sets) for sets in ([], ["run.end_time=0.45"], ["run.end_time=1"]))
            self.assertEqual(base + steps * (base - shorter), longer, scheme)

    def test_rejects_an_existing_run(self):
        scene = self.write(VORTICES)
        self.expect(0, scene, *QUIET)
        self.assertIn("--overwrite", self.expect(2, scene, *QUIET).stderr)
        self.expect(3, scene, *QUIET, "--overwrite", sets=["run.end_time=-1"])
        self.assertEqual("ok", self.result("out")["status"])


class Failures(parachute_program.FlowTest):
    def test_unstable_step_ends_with_the_last_good_state(self):
        message = self.expect(4, self.write(GUST), *QUIET, sets=["run.dt=0.09", "run.end_time=400", "fluid.velocity=['1+t', 0, 0]", "output={restart_every=0}"]).stderr
        self.assertRegex(message, r"run.dt = 0.09 s exceeds the largest stable time step, 0.08\d+ s, at step \d+, t = \S+ s\n$")
        self.assertGreater(self.result("out")["steps"], 2)
        reported = self.result("out")
        self.assertEqual(("numerical-failure", 4), (reported["status"], reported["exit_code"]))
        self.assertTrue((self.folder / "out/restart.h5").exists())
        self.assertTrue(all(math.isfinite(value) for value in self.history("out")["kinetic_energy"]))

    def test_fixed_steps_far_beyond_the_stability_limit_are_failures(self):
        for scene, dt in (("shear-layer", 10), ("jet", 5)):
            for time_scheme in ("ab2", "rk3"):
                with self.subTest(scene, time_scheme=time_scheme):
                    sets = [f"run.dt={dt}", f"flow.time={time_scheme}", "verify={}", "output={}"]
                    message = self.expect(4, scene, *QUIET, "--overwrite", sets=sets).stderr
                    limit = float(re.search(rf"run.dt = {dt} s exceeds the largest stable time step, (\S+) s, at step 1,", message)[1])
                    self.expect(0, scene, *QUIET, "--overwrite", sets=[f"run.dt={0.5 * limit}", *sets[1:], f"run.end_time={3 * limit}"])

    def test_initial_projection_that_fails_names_the_tolerance(self):
        if "hypre" not in self.expect(0, "--version").stdout:
            self.skipTest("this build lacks hypre")
        for step in ("auto", "0.01"):
            message = self.expect(4, "cavity", *QUIET, "--overwrite", sets=[
                "flow.pressure='hypre-pfmg'", "flow.pressure_tolerance=1e-300", f"run.dt={step}",
                "initial.velocity=['sin(3*x)*cos(2*y)', 'cos(x)*y', 0]"]).stderr
            self.assertRegex(message, r"did not converge at the initial projection, t = 0 s; its relative residual is [0-9.]+e-1[0-9]: .*flow.pressure_tolerance above 1e-300\n$")
            self.assertNotIn("nan", message)

    def test_pressure_that_does_not_converge_is_no_output(self):
        if "hypre" not in self.expect(0, "--version").stdout:
            self.skipTest("this build lacks hypre")
        for diffusion in ("explicit", "crank-nicolson"):
            said = self.expect(4, "cavity", *QUIET, "--overwrite", sets=[
                "flow.pressure='hypre-pfmg'", "flow.pressure_tolerance=1e-300", f"flow.diffusion='{diffusion}'",
                "flow.body_force=[0,-1,0]", "output={fields=['pressure'],times=[0]}", "verify={}"]).stderr
            self.assertRegex(said, r"did not converge (for the pressure at step 0|at the initial projection), t = 0 s; its relative residual is \S+: ")

    def test_velocity_at_the_start_that_is_no_number_fails_in_large_grids_too(self):
        """Every second of these points is checked as the scene is read; the solver finds the others."""
        for face, code, sentence in ((1000, 3, "initial.velocity[0] = "), (1001, 4, "the velocity is not finite in cell (")):
            sets = ["grid.cells=[2101,2000,1]", "grid.domain=[[0,2101],[0,2000],[0,1]]", "verify={}", "output={}",
                    f"initial.velocity=['sqrt((x-{face})^2+(y-1000.5)^2-0.01)',0,0]"]
            self.assertIn(sentence, self.expect(code, "taylor-green-2d", *QUIET, "--overwrite", sets=sets).stderr)

    def test_net_inflow_between_the_checked_times_is_a_failure(self):
        sets = ['fluid.velocity=["abs(t-0.0325)<0.0025 ? 1 : 0", 0, 0]', 'grid.boundary.x=["inflow", "wall"]',
                "run.end_time=0.1", "run.max_dt=0.001", "output={}"]
        message = self.expect(4, self.write(GUST), *QUIET, sets=sets).stderr
        self.assertRegex(message, r"net inflow, but no side is an outflow at step \d+, t = 0\.0\d+ s, .*: \S+ m\^3/s; .*\"outflow\" side\n$")
        self.assertLess(self.result("out")["time"], 0.031)

    def test_viscosity_that_needs_too_many_steps_is_noticed(self):
        sets = ["fluid.viscosity=1e12", "run.max_steps=3", "output={}"]
        process = self.start(self.write(GUST), *QUIET[1:], sets=sets)
        self.assertEqual(4, process.returncode)
        self.assertRegex(process.stderr, r"viscosity limits a step to \S+ s, .*crank-nicolson")
        for quiet in ([*sets, "flow.time='ab2'", "flow.diffusion='crank-nicolson'"], sets):
            words = QUIET if quiet is sets else QUIET[1:]
            self.assertNotIn("viscosity", self.expect(4, self.write(GUST), *words, "--overwrite", sets=quiet).stderr)

    def test_inflow_that_becomes_undefined_is_a_failure(self):
        """At an output, which is none of the times of the check."""
        message = self.expect(4, self.write(GUST), *QUIET, sets=['fluid.velocity=["1+1e-9/(10*t-2)", 0, 0]']).stderr
        self.assertRegex(message, r"the prescribed velocity is not finite on the side x_low at step \d+, t = ")
        self.assertLessEqual(self.result("out")["time"], 0.2)

    def test_wall_velocity_that_becomes_undefined_is_a_failure(self):
        for velocity in ('["1e-9/(10*t-1)", 0, 0]', '[0, 0, "1e-9/(10*t-1)"]'):
            message = self.expect(4, self.write(VORTICES), *QUIET, "--overwrite", sets=[
                "run.end_time=0.15", "run.dt=0.05", "output.times=[0.15]", "grid.boundary.y='wall'",
                f"grid.wall_velocity={{y_low={velocity}}}"]).stderr
            self.assertRegex(message, r"the prescribed velocity is not finite on the side y_low at step 2, t = 0.05 s")

    def test_velocity_through_slip_sides_of_one_cell_is_rejected(self):
        message = self.expect(3, self.write(VORTICES), *QUIET, sets=[
            "grid.boundary.z='slip'", "initial.velocity=[0, 0, 1]"]).stderr
        self.assertIn("initial.velocity[2] = 1.0 is normal to the slip sides of an axis with one cell", message)

    def test_step_limit_is_a_failure(self):
        message = self.expect(4, self.write(VORTICES), *QUIET, sets=["run.max_steps=4"]).stderr
        self.assertIn("run.max_steps = 4 reached at t = 0.2 s", message)
        self.assertEqual(4, self.result("out")["steps"])


class Verification(parachute_program.FlowTest):
    def check(self, code, check, scene=VORTICES, sets=()):
        self.expect(code, self.write(scene), *QUIET, "--overwrite", sets=[f"verify={check}", *sets])
        return {each["name"]: each["value"] for each in self.result("out")["checks"]}

    EXACT = ("exact={{x='sin(x)*cos(y)*exp({0}*t)',y='-cos(x)*sin(y)*exp({0}*t)',z=0,"
             "pressure='0.25*(cos(2*x)+cos(2*y))*exp(2*{0}*t)'}}")

    def test_errors_are_measured_against_the_exact_solution(self):
        right = "{" + self.EXACT.format(-0.02) + ",l2_velocity=3e-3,linf_velocity=1e-2,l2_pressure=0.02}"
        values = self.check(0, right)
        self.assertEqual({"l2_velocity", "linf_velocity", "l2_pressure"}, set(values))
        self.assertEqual({f"{norm}_{field}" for norm in ("l1", "l2", "linf") for field in ("velocity", "pressure")},
                         set(self.result("out")["errors"]))
        # Without decay the difference is 1 - exp(-0.01) times the initial root mean square of sqrt(1/2).
        wrong = self.check(5, "{" + self.EXACT.format(0) + ",l2_velocity=3e-3}")
        self.assertAlmostEqual((1 - math.exp(-0.01)) * math.sqrt(0.5), wrong["l2_velocity"], delta=2e-3)

    def test_kinetic_energy_of_vortices(self):
        """Half of the density times the volume times the mean square of 1/2, with its decay."""
        energy = 0.25 * (2 * math.pi)**2 * math.exp(-0.02)
        for code, expected in ((0, energy), (5, 2 * energy)):
            self.check(code, "{history=[" + statistic("kinetic_energy", "last", expected, 1e-3) + "]}")

    def test_dissipation_peak_of_decaying_vortices(self):
        """The energy falls fastest at the start: 4 nu E."""
        rate = 0.04 * 0.25 * (2 * math.pi)**2
        sets = ["output.history_every=1"]
        self.check(0, f"{{dissipation_peak={{value={rate},tolerance=0.02,time=0.025,time_tolerance=1e-9}}}}", sets=sets)
        self.check(5, f"{{dissipation_peak={{value={rate},tolerance=0.02,time=0.2,time_tolerance=0.1}}}}", sets=sets)

    def test_curves_of_decaying_vortices(self):
        """The energy falls as exp(-4 nu t), also where no row of the history is."""
        def curve(name, decay, times, tolerance):
            points = [[t, (1 if "energy" in name else 0.04) * 0.25 * (2 * math.pi)**2 * math.exp(-decay * t)] for t in times]
            return f"{name}=[{{points={points},tolerance={tolerance}}}]"

        sets = ["output.history_every=2"]
        values = self.check(0, "{" + curve("kinetic_energy_curve", 0.04, (0, 0.03, 0.33, 0.5), 1e-3) + "," +
                            curve("dissipation_curve", 0.04, (0, 0.03, 0.33, 0.5), 0.02) + "}", sets=sets)
        self.assertEqual({"kinetic_energy_curve_0", "dissipation_curve_0"}, set(values))
        late = self.check(5, "{" + curve("dissipation_curve", 0.14, (0.03, 0.45), 0.02) + "}", sets=sets)
        self.assertAlmostEqual(math.exp(-0.04 * 0.45) - math.exp(-0.14 * 0.45), late["dissipation_curve_0"], delta=0.02)
        self.check(5, "{" + curve("kinetic_energy_curve", 0.14, (0.03, 0.45), 0.02) + "}", sets=sets)

    def test_momentum_is_conserved_and_forces_change_it(self):
        self.assertLess(self.check(0, "{momentum=1e-13,energy_growth=0,speed_growth=0}")["momentum"], 1e-13)
        growth = self.check(5, "{energy_growth=0}", sets=["flow.body_force=[0, 0, 1]"])
        self.assertGreater(growth["energy_growth"], 0.01)

    def test_flow_rates_through_sides(self):
        rate = 1 + 0.3 * math.sin(2.5) + 0.2 * (1 / 6 + 1 / 1200)  # midpoint sum over ten cells
        for code, low in ((0, -rate), (5, rate)):
            self.check(code, "{history=[" + statistic("outflow_x_low", "last", low, 1e-12) + "," +
                       statistic("outflow_x_high", "last", rate, 1e-12) + "]}", GUST)

    def test_profiles_along_lines(self):
        line = "profile=[{{component='x',along='x',through=[0,0.3,0],points=[[1.57,{0}]],tolerance=0.01,maximum={{value={0},tolerance=0.01,at=1.5708,at_tolerance=0.02}}}}]"
        top = math.cos(0.3) * math.exp(-0.01)
        sets = ["grid.cells=[64, 64, 1]", "run.dt='auto'"]
        self.assertEqual({"profile_0", "profile_0_maximum", "profile_0_maximum_at"},
                         set(self.check(0, "{" + line.format(top) + "}", sets=sets)))
        self.check(5, "{" + line.format(top + 0.02) + "}", sets=sets)

    def test_summary_aligns_long_names_of_checks(self):
        profile = "profile=[{component='x',along='x',through=[0,0.3,0],maximum={value=1,tolerance=1,at=1.5708,at_tolerance=1}}]"
        text = self.expect(0, self.write(VORTICES), "--backend", "serial",
                           sets=["output.fields=[]", "verify={divergence=1," + profile + "}"]).stdout
        columns = {re.match(r"  \S+ +(?=\S)", line).end() for line in text.splitlines() if "(tolerance" in line}
        self.assertEqual({len("  profile_0_maximum_at ")}, columns, text)

    def test_uniform_stream_stays_bit_for_bit(self):
        for backend in {"serial", gas_program.threaded()}:
            self.expect(0, "uniform", "--quiet", "--backend", backend, "--out", backend)
            self.assertEqual([0.0, 0.0], [check["value"] for check in self.result(backend)["checks"]])

    def test_gust_moves_a_plug_of_fluid_at_once(self):
        """A uniform inflow between slip sides fills the channel: exact to round-off at any time."""
        plug = GUST.replace('["1 + 0.3*sin(5*t) + 0.2*y*(1-y)", 0, "0.1*y"]', '["1 + 0.3*sin(5*t)", 0, 0]').replace(
            'y = ["wall", "slip"], z = "wall"', 'y = "slip", z = "slip"').replace(
            "wall_velocity = { y_low = [\"0.5*cos(t)\", 0, 0] }\n", "").replace(
            'velocity = ["1 + 0.1*sin(3*y)*z", "0.1*sin(pi*y)", 0]', "velocity = [1, 0, 0]")
        self.check(0, "{exact={x='1+0.3*sin(5*t)',y=0,z=0},linf_velocity=1e-12}", plug)

    def test_fluid_at_rest_changes_neither_momentum_nor_energy(self):
        checks = self.check(0, "{momentum=0,energy_growth=0,speed_growth=0}", sets=["initial.velocity=[0, 0, 0]", "fluid.velocity=[0, 0, 0]"])
        self.assertEqual({"momentum": 0.0, "energy_growth": 0.0, "speed_growth": 0.0}, checks)


class Orders(parachute_program.FlowTest):
    def energy(self, scheme, dt):
        """Kinetic energy at the end, which depends on dt alone."""
        self.expect(0, self.write(VORTICES), *QUIET, "--overwrite", sets=[
            "verify={}", f"run.dt={dt}", "run.end_time=0.8", 'initial.velocity=["1+sin(x)*cos(y)+0.3*cos(2*y)", "0.5-cos(x)*sin(y)", 0]',
            *scheme])
        return self.history("out")["kinetic_energy"][-1]

    def test_time_schemes_have_their_orders(self):
        for scheme, least in ((["flow.time=ab2"], 1.9), (["flow.time=rk3"], 2.7)):
            with self.subTest(scheme):
                coarse, middle, fine = (self.energy([*scheme, "flow.advection=central"], dt) for dt in (0.04, 0.02, 0.01))
                self.assertGreater(math.log2((coarse - middle) / (middle - fine)), least)

    def test_study_lists_second_order_in_space(self):
        run = self.study("taylor-green-2d", "meshes=16:64,advections=central:weno-z,times=ab2,diffusions=explicit:crank-nicolson",
                         "--backend", "serial", "--quiet", sets=["run.end_time=0.5", "output={}"])
        self.assertEqual(0, run.returncode, run.stderr)
        rows = self.table("out/taylor-green-2d-study/study.csv")
        self.assertEqual([(advection, "ab2", diffusion, cells) for advection in ("central", "weno-z")
                          for diffusion in ("explicit", "crank-nicolson") for cells in ("16", "32", "64")],
                         [(row["advection"], row["time_scheme"], row["diffusion"], row["cells"]) for row in rows])
        for row in rows:
            self.assertEqual(("ok", row["cells"] == "16"), (row["status"], row["order_l2_velocity"] == ""))
            if row["cells"] == "64":
                self.assertGreater(float(row["order_l2_velocity"]), 1.9, row)
        document = self.document("out/taylor-green-2d-study/study.json")
        self.assertEqual(("drogue.study/1", "drogue-parachute", 12),
                         (document["schema"], document["program"], len(document["rows"])))


    def test_studies_run_on_coarse_meshes(self):
        scenes = [name for name in parachute_program.SMALL_SCENES if "exact" in self.expect(0, name, "--print-scene").stdout]
        self.assertGreaterEqual(len(scenes), 6)
        for scene in scenes:
            with self.subTest(scene):
                run = self.study(scene, "meshes=4:16", "--backend", "serial", "--quiet", sets=["run.end_time=0.02", "output={}"])
                self.assertEqual(0, run.returncode, run.stderr)
                self.assertEqual([("ok", n) for n in ("4", "8", "16")],
                                 [(row["status"], row["cells"]) for row in self.table(f"out/{scene}-study/study.csv")])

    def test_study_names_itself_where_a_point_is_invalid(self):
        message = self.expect(2, "channel", "--study", "times=rk3,diffusions=crank-nicolson").stderr
        self.assertRegex(message, r"--study times=rk3,diffusions=crank-nicolson .*needs flow.time = \"ab2\"")
        self.assertNotIn("--set", message)


class Bodies(parachute_program.FlowTest):
    def test_check_refuses_what_a_run_would_refuse_beside_a_side(self):
        """Forces act up to a cell beyond a plate: exactly a cell from a side, round-off would decide."""
        scene = self.write(bad_bodies.GOOD)
        for side, inwards in ((0.1, 1), (1.5, -1)):
            sets = ["verify={}", "body[0].centre=[{},0.4,0.4]"]
            self.assertIn("strictly between 0.1 and 1.5 m", self.expect(3, scene, "--check", sets=[sets[0], sets[1].format(side)]).stderr)
            self.expect(0, scene, *QUIET, "--overwrite", sets=[sets[0], sets[1].format(side + inwards * 1e-8)])

    def test_force_on_a_porous_plate_follows_its_law(self):
        """A plate across the whole channel, so that the velocity through it is that of the inflow."""
        whole = PLATE.replace("lengths = [0.4, 0.6]", "lengths = [0.8, 0.6]").replace("0.37", "0.4").replace(
            'y = "slip"', 'y = "periodic"')
        whole = whole[:whole.index('[[body]]\nkind = "plate"\nnormal = "y"')] + whole[whole.index("[run]"):]
        force = (3 * 2 + 1 * 2**2) * 0.8 * 0.6
        check = "verify={history=[" + statistic("body_0_force_x", "last", "FORCE", 1e-10) + "]}"
        self.expect(0, self.write(whole), *QUIET, sets=[check.replace("FORCE", str(force)), "run.end_time=1", "output.times=[1]"])
        self.assertEqual({"vertices": 17 * 13}, self.result("out")["bodies"])
        pressure = self.fields("out").values("/steps/000000/pressure")
        plane = 8 * 6
        self.assertAlmostEqual(3 * 2 + 1 * 2**2, pressure[0] - pressure[15 * plane], delta=1e-6)
        self.expect(5, self.write(whole), *QUIET, "--overwrite", sets=[check.replace("FORCE", str(1.001 * force)), "run.end_time=1"])

    def test_triangles_of_a_file_are_a_body(self):
        """A plate from a file, in units of 5 cm, has the force of the same plate by measures."""
        quiet = QUIET[:QUIET.index("--out")]
        rows = [(0, 2 * y - 8, 2 * z - 12) for y in range(9) for z in range(13)]
        faces = [face for y in range(8) for z in range(12) for a in [13 * y + z + 1]
                 for face in ((a, a + 13, a + 14), (a, a + 14, a + 1))]
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in rows) + "".join(f"f {a} {b} {c}\n" for a, b, c in faces)
        (self.folder / "plate.obj").write_text(text.replace("v 0", "v 0.0"), encoding="utf-8")
        head, tail = PLATE.split('kind = "plate"\nnormal = "x"\n')
        tail = tail.replace("lengths = [0.4, 0.6]\nedge_length = 0.05\n", 'file = "plate.obj"\nscale = 0.025\nslip = true\n', 1)
        by_file = self.write(head + 'kind = "file"\n' + tail, "file.toml")
        self.expect(0, by_file, *quiet, "--out", "file", sets=["output.restart_every=8"])
        self.expect(0, self.write(PLATE), *quiet, "--out", "plate")
        forces = [self.history(out)["body_0_force_x"][-1] for out in ("file", "plate")]
        self.assertGreater(forces[1], 0.1)
        self.assertAlmostEqual(forces[0], forces[1], delta=1e-3 * forces[1])
        self.assertEqual(["body_0_force_x", "body_1_force_x"], [name for name in self.history("file") if "force_x" in name])
        # Faces that are turned against the others are turned back.
        turned = "".join(f"f {a} {c} {b}\n" if k % 2 else f"f {a} {b} {c}\n" for k, (a, b, c) in enumerate(faces))
        (self.folder / "turned.obj").write_text("".join(f"v {x:.1f} {y} {z}\n" for x, y, z in rows) + turned, encoding="utf-8")
        file = self.write(by_file.read_text(encoding="utf-8").replace("plate.obj", "turned.obj"), "turned.toml")
        run = self.start(file, "--backend", "serial", "--out", "turned")
        self.assertEqual(0, run.returncode)
        self.assertIn("body[0].file: 96 of 192 triangles of ", run.stderr)
        self.assertAlmostEqual(forces[0], self.history("turned")["body_0_force_x"][-1], delta=1e-9 * forces[0])
        # Quadrilaterals are divided.
        quads = "".join(f"f {a} {a + 13} {a + 14} {a + 1}\n" for y in range(8) for z in range(12) for a in [13 * y + z + 1])
        (self.folder / "turned.obj").write_text("".join(f"v {x:.1f} {y} {z}\n" for x, y, z in rows) + quads, encoding="utf-8")
        self.expect(0, file, *quiet, "--out", "turned", "--overwrite")
        self.assertEqual(forces[0], self.history("turned")["body_0_force_x"][-1])
        # Another place of the file is the same scene, another content is not.
        text_of_scene = by_file.read_text(encoding="utf-8")
        (self.folder / "moved.obj").write_bytes((self.folder / "plate.obj").read_bytes())
        by_file.write_text(text_of_scene.replace("plate.obj", "moved.obj"), encoding="utf-8")
        self.expect(0, by_file, *quiet, "--out", "file", "--restart", "auto")
        (self.folder / "moved.obj").write_text(text.replace("v 0 -8 -12", "v 0.1 -8 -12"), encoding="utf-8")
        self.assertIn("another scene", self.expect(6, by_file, *quiet, "--out", "file", "--restart", "auto").stderr)

    def grids(self):
        """Names of the grids of fields.xdmf, whose datasets all exist, and the datasets that it shows."""
        document = xml.etree.ElementTree.parse(self.folder / "out/fields.xdmf")
        shown = [item.text.removeprefix("fields.h5:") for item in document.iter("DataItem")]
        self.assertEqual(set(), set(shown) - set(self.fields("out").datasets))
        return [grid.get("Name") for grid in document.iter("Grid") if grid.get("GridType") == "Collection"], shown

    def test_fields_hold_bodies_at_rest_once(self):
        self.expect(0, self.write(PLATE), *QUIET)
        fields = self.fields("out")
        triangles = array.array("q", fields.datasets["/mesh/body/triangles"])
        # Plates of 8 by 12 and of 6 by 12 edges.
        self.assertEqual((3 * (9 * 13 + 7 * 13), 6 * (8 * 12 + 6 * 12)),
                         (len(fields.values("/mesh/body/vertices")), len(triangles)))
        self.assertEqual(set(range(9 * 13 + 7 * 13)), set(triangles))
        edges = array.array("q", fields.datasets["/mesh/body/edges"])
        pairs = set(zip(edges[::2], edges[1::2]))
        sides = {tuple(sorted((triangles[3 * k + i], triangles[3 * k + (i + 1) % 3]))) for k in range(len(triangles) // 3)
                 for i in range(3)}
        self.assertEqual(sides, {tuple(sorted(pair)) for pair in pairs})
        self.assertEqual({0.6}, set(fields.values("/mesh/body/vertices")[:3 * 9 * 13:3]))
        self.assertEqual({0.4}, set(fields.values("/mesh/body/vertices")[3 * 9 * 13 + 1::3]))
        self.assertEqual([], [name for name in fields.datasets if name.startswith("/steps/") and "/body" in name])
        grids, shown = self.grids()
        self.assertEqual(["scene", "scene body"], grids)
        self.assertEqual(2, shown.count("/mesh/body/vertices"))

    def test_fields_hold_moving_bodies_at_every_output(self):
        moving = PLATE.replace('normal = "y"\n', 'normal = "y"\nmotion = { y = "0.05*sin(5*t)" }\n')
        self.expect(0, self.write(moving), *QUIET)
        fields = self.fields("out")
        for step, time in (("000000", 0.12), ("000001", 0.3)):
            places = fields.values(f"/steps/{step}/body/position")
            self.assertEqual({0.6}, set(places[:3 * 9 * 13:3]))
            for place in set(places[3 * 9 * 13 + 1::3]):
                self.assertAlmostEqual(0.4 + 0.05 * math.sin(5 * time), place, delta=1e-12)
        self.assertEqual(1, self.grids()[1].count("/steps/000001/body/position"))
        self.expect(0, self.write(moving), *QUIET, "--overwrite", sets=["output.fields=[]"])
        self.assertFalse((self.folder / "out/fields.h5").exists())

    def test_history_holds_the_forces_of_all_bodies(self):
        self.expect(0, self.write(PLATE), *QUIET)
        rows = self.history("out")
        self.assertGreater(rows["body_0_force_x"][-1], 0.1)
        self.assertEqual(0.0, max(abs(value) for value in rows["body_1_force_x"]))  # normal to y
        self.assertGreater(abs(rows["body_1_force_y"][-1]), 1e-6)

    def test_moving_body_carries_the_fluid_with_it(self):
        """A plate that oscillates across a periodic channel, and the mean and frequency of its force."""
        moving = PLATE.replace('x = ["inflow", "outflow"]', 'x = "periodic"').replace("[2, 0, 0]", "[0, 0, 0]").replace(
            "lengths = [0.4, 0.6]", "lengths = [0.8, 0.6]").replace("0.37", "0.4").replace('y = "slip"', 'y = "periodic"')
        moving = moving[:moving.index("porosity")] + 'motion = { x = "0.05*sin(10*t)" }\n' + moving[moving.index("[run]"):]
        # The force accelerates all of the fluid: mass times 0.05 10^2 sin(10 t), whose mean over the half periods
        # from 0.8 pi to 0.9 pi is 2 / pi of the amplitude.
        mean = 1.2 * 1.6 * 0.8 * 0.6 * 0.05 * 100 * 2 / math.pi
        sets = ["run.end_time=2.8274333882308138", "run.max_dt=0.002", "output={history_every=1}", "verify={"
                "history=[" + statistic("body_0_force_x", "mean", f"{mean:.9g}", 5e-3, from_=2.5132741228718345) + "," +
                statistic("body_0_force_x", "frequency", 0.15915494309189535, 5e-3, from_=0.2, reference=10) + "]}"]
        self.expect(0, self.write(moving), *QUIET, sets=sets)
        self.assertAlmostEqual(mean, self.measured("body_0_force_x_mean"), delta=5e-3 * mean)
        sets[1:] = "run.max_dt=0.004", sets[2], sets[-1].replace("0.005", "1e-9")
        self.expect(5, self.write(moving), *QUIET, "--overwrite", sets=sets)

    def test_bodies_cross_periodic_sides(self):
        """A sphere in the middle and one that is cut by two sides have the same drag."""
        head = PLATE[:PLATE.index("[[body]]")].replace('y = "slip"', 'y = "periodic"').replace("cells = [16, 8, 6]", "cells = [16, 8, 8]").replace(
            "[0, 0.6]]", "[0, 0.8]]")
        ball = '[[body]]\nkind = "sphere"\ncentre = [0.6, 0.4, 0.4]\nradius = 0.2\nedge_length = 0.05\n'
        scene = self.write(head + ball + PLATE[PLATE.index("[run]"):])
        for method in ("spread", "sharp"):
            forces = []
            for centre in ("[0.6,0.4,0.4]", "[0.6,0.8,0]"):
                self.expect(0, scene, *QUIET, "--overwrite", sets=[f"body[0].centre={centre}", f"coupling={{method='{method}'}}"])
                forces.append(self.history("out")["body_0_force_x"][-1])
            self.assertGreater(forces[0], 0.05)
            self.assertAlmostEqual(forces[0], forces[1], delta=1e-6 * forces[0])

    def test_sharp_plate_closes_a_duct_between_walls(self):
        """The whole pressure drop of the porous law, which a gap of a cell beside the walls would let pass."""
        whole = PLATE.replace("lengths = [0.4, 0.6]", "lengths = [0.8, 0.6]").replace("0.37", "0.4")
        whole = whole[:whole.index('[[body]]\nkind = "plate"\nnormal = "y"')] + whole[whole.index("[run]"):]
        message = self.expect(3, self.write(whole), *QUIET).stderr
        self.assertIn('with coupling.method = "sharp" it may touch all sides', message)
        force = (3 * 2 + 1 * 2**2) * 0.8 * 0.6
        self.expect(0, self.write(whole), *QUIET, sets=[
            "coupling={method='sharp'}", "run.end_time=1", "output.times=[1]",
            "verify={history=[" + statistic("body_0_force_x", "last", force, 1e-9) + "]}"])

    def test_force_outside_of_a_body_lacks_the_inertia_inside(self):
        """A sphere that accelerates in fluid at rest: the added mass is half of that which it displaces, and a bit more between sides."""
        head = PLATE[:PLATE.index("[[body]]")].replace("cells = [16, 8, 6]", "cells = [24, 24, 24]").replace(
            "[[0, 1.6], [0, 0.8], [0, 0.6]]", "[[0, 2.4], [0, 2.4], [0, 2.4]]").replace("velocity = [2, 0, 0]", "velocity = [0, 0, 0]").replace(
            "viscosity = 0.01", "viscosity = 1e-4").replace('["inflow", "outflow"]', '"outflow"').replace('"periodic"', '"slip"')
        ball = ('[[body]]\nkind = "sphere"\ncentre = [1.2, 1.2, 1.2]\nradius = 0.4\nretraction = 0.3\nedge_length = 0.05\nslip = true\n'
                'motion = { x = "0.5*t^2" }\n')
        scene = self.write(head + ball + PLATE[PLATE.index("[run]"):])
        self.expect(0, scene, *QUIET, sets=["run.end_time=0.1", "run.max_dt=0.005", "output={history_every=1}"])
        rows = self.history("out")
        displaced = 1.2 * 4 / 3 * math.pi * 0.4**3
        whole, outside = (-rows[name][-1] / displaced for name in ("body_0_force_x", "body_0_outside_force_x"))
        self.assertAlmostEqual(1.0, whole - outside, delta=0.01)
        self.assertAlmostEqual(0.5, outside, delta=0.05)
        self.assertNotIn("body_0_outside_force_x", self.history_of_plate())

    def history_of_plate(self):
        self.expect(0, self.write(PLATE), *QUIET, "--overwrite", sets=["run.end_time=0.02", "output={}"])
        return self.history("out")

    def test_plate_on_a_spring_moves_all_of_the_fluid(self):
        """Frequency of the mass of plate and fluid, of second order in dt, and a run that continues bit for bit."""
        exact = math.sqrt(40 / (0.1 + 1.225 * 1.6 * 0.8 * 0.8)) / (2 * math.pi)
        scene, errors = self.write(bad_bodies.PISTON), []
        for dt in (0.02, 0.01):
            sets = [f"run={{end_time=4,dt={dt}}}", "fluid.viscosity=0", "output.times=[2]", "verify.history[0].from=0", "verify.history[1].from=0"]
            self.expect(0, scene, *QUIET, "--overwrite", sets=sets)
            errors.append(exact - self.measured("body_0_displacement_frequency"))
        self.assertLess(errors[1], 0.02 * exact)
        self.assertGreater(errors[0] / errors[1], 3.0)
        self.expect(5, scene, *QUIET, "--overwrite", sets=[*sets, "verify.history[1].value=0.04"])
        self.assertEqual([True, False], [check["passed"] for check in self.result("out")["checks"]])
        first = ["run={end_time=2,dt=0.01}", "verify={}", "output.restart_every=50", *sets[1:3]]
        self.assert_continues(self.history("out"), scene, first, sets, ("body_0_displacement", "body_0_force_x", "kinetic_energy"))

    def test_all_kinds_of_bodies_run_and_continue(self):
        round_bodies = bad_bodies.ROUND[:bad_bodies.ROUND.index("[verify]")]
        sets = ["run.end_time=0.4", "output={history_every=1,restart_every=8,fields=['pressure'],times=[0.2,0.4]}"]
        self.expect(0, self.write(round_bodies), *QUIET, sets=sets)
        printed = self.expect(0, self.write(round_bodies), "--print-scene").stdout
        self.assertIn("slip = true", printed)
        self.assertIn("slip = false", printed)
        rows = self.history("out")
        for body in range(3):
            self.assertGreater(rows[f"body_{body}_force_x"][-1], 0.0)
        self.assert_continues(rows, self.write(round_bodies), [*sets, "run.end_time=0.2", "output.times=[0.2]"], sets,
                              ("body_0_force_x", "body_1_force_y", "body_2_force_x", "kinetic_energy"))

    def test_sharp_bodies_run_and_continue(self):
        scene = self.write(PLATE.replace("porosity = {", 'motion = { x = "0.05*sin(20*t)" }\nporosity = {'))
        sets = ['coupling.method="sharp"', "output={history_every=1,restart_every=8,fields=['pressure'],times=[0.15,0.3]}"]
        self.expect(0, scene, *QUIET, sets=sets)
        rows = self.history("out")
        self.assertGreater(max(rows["body_0_force_x"]), 1.0)
        self.assert_continues(rows, scene, [*sets, "run.end_time=0.15", "output.times=[0.15]"], sets,
                              ("body_0_force_x", "body_1_force_y", "kinetic_energy"))

    def test_body_that_leaves_the_domain_ends_the_run(self):
        """An oscillation of the period of the times at which the scene is checked."""
        away = PLATE.replace("porosity = {", 'motion = { x = "0.7*sin(53.6165146212658*t)" }\nporosity = {')
        run = self.expect(4, self.write(away), *QUIET, sets=["run.end_time=30", "output={}", "run.max_dt=0.0005"])
        self.assertIn("body[0] leaves the domain: a vertex at (", run.stderr)

    def test_backends_agree(self):
        for backend in ("serial", gas_program.threaded()):
            self.expect(0, self.write(PLATE), "--quiet", "--backend", backend, "--out", backend, "--overwrite")
            last = self.history(backend)["body_0_force_x"][-1]
            self.assertAlmostEqual(1.0, last / self.history("serial")["body_0_force_x"][-1], delta=1e-9)


class ClothDrops(parachute_program.FlowTest):
    WORDS = ("--quiet", "--backend", "serial", "--overwrite", "--out")

    def drop(self, out, *sets, code=0, scene=CLOTH, restart=None):
        words = [word for word in self.WORDS if restart is None or word != "--overwrite"]
        resume = [] if restart is None else ["--restart", restart]
        return self.expect(code, self.write(scene), *words, out, *resume, sets=sets)

    def test_slack_cloth_falls_freely(self):
        self.drop("out")
        rows, steps = self.history("out"), range(len(self.history("out")["time"]))
        for k in steps:
            time = rows["time"][k]
            height = rows["canopy_0_payload_z"][0] - 0.5 * 9.81 * time**2
            self.assertAlmostEqual(height, rows["canopy_0_payload_z"][k], delta=1e-9)
            self.assertAlmostEqual(-9.81 * time, rows["canopy_0_payload_velocity_z"][k], delta=1e-9)
            self.assertLess(abs(rows["canopy_0_line_force_z"][k]), 1e-6)
            self.assertAlmostEqual(rows["energy"][0], rows["energy"][k], delta=1e-9)
        self.assertNotIn("canopy_0_force_z", rows)
        self.assertNotIn("divergence_rms", rows)

    def test_only_the_cloth_is_solved(self):
        def launches(end_time):
            self.drop("out", "output.history_every=0", "run.dt=1e-4", f"run.end_time={end_time}")
            result = self.result("out")
            self.assertEqual(0, result["ledger"]["device_allocations_after_warmup"])
            self.assertNotIn("pressure", result)
            return result["steps"], result["ledger"]["kernel_launches"]

        (steps, some), (more_steps, more) = launches(0.256), launches(0.512)
        # One kernel a step, and the stability limit of a block.
        self.assertLess(more - some, 1.1 * (more_steps - steps))

    def test_largest_forces_need_a_first_part_that_kept_them(self):
        self.drop("out", "run.end_time=0.1")
        said = self.drop("out", "verify={peak_force=[{force=[0,1e9]}]}", "run.end_time=0.2", code=6, restart="auto").stderr
        self.assertIn("verify.peak_force", said)

    def test_fixed_payload_catches_the_cloth(self):
        fixed = CLOTH.replace("mass = 0.1", "fixed = true").replace("end_time = 0.4", "end_time = 1.3")
        checks = ("verify={energy_drift=2e-2,peak_force=[{force=[0.1,1000]}],history=[" +
                  statistic("canopy_0_payload_z", "amplitude", 1, 1) + "]}")
        self.drop("out", checks, scene=fixed)
        rows = self.history("out")
        # The skirt falls from its height above the payload to as much below it.
        taut = math.sqrt(2 * 2 * math.sqrt(1.8**2 - 1) / 9.81)
        pulled = [time for time, force in zip(rows["time"], rows["canopy_0_line_force_z"]) if force < -0.01]
        self.assertGreater(min(pulled), taut)
        self.assertLess(min(pulled), taut + 0.1)
        self.drop("coarse", "verify.energy_drift=1e-9", code=5, scene=fixed)

    def test_energy_of_cloth_at_rest_does_not_drift(self):
        # Round-off of the first lengths is all the energy there is.
        self.drop("out", "coupling.gravity=[0,0,0]", "run.end_time=0.1", "verify.energy_drift=1e-9")
        self.assertLess(0.0, max(self.history("out")["cloth_kinetic_energy"]))
        self.assertLess(max(self.history("out")["cloth_kinetic_energy"]), 1e-20)

    def test_runs_continue_bit_for_bit(self):
        cut = CLOTH.replace('kind = "flat-circular"', 'kind = "flat-circular"\nshape = "partly-closed"\nclosure = 0.6').replace(
            "mass = 0.1 }", "mass = 0.1, release = 0.2 }\nreefing = { length = 3.8, stiffness = 500, cut = 0.1 }")
        for half in (0.1, 0.15, 0.2):
            with self.subTest(half):
                sets = [f"output={{history_every=7,restart_every=7,times=[{half},0.3],fields=['position','von_mises']}}", "run.end_time=0.3"]
                self.drop("whole", *sets, scene=cut)
                part = self.folder / "part"
                # Without the cuts that lie after its end.
                before = cut if half == 0.2 else cut.replace(", release = 0.2", "")
                self.drop(part, *sets, f"run.end_time={half}", f"output.times=[{half}]", scene=before)
                self.drop(part, *sets, scene=cut, restart=part / "restart.h5")
                whole, again = self.history("whole"), self.history("part")
                self.assertIn(0.3, whole["time"])
                self.assertEqual(whole, again)

    def test_released_payload_leaves_the_lines(self):
        self.drop("out", "canopy[0].payload.release=0.2", "coupling.gravity=[0,0,0]", "canopy[0].perturbation.amplitude=0.05")
        rows = self.history("out")
        speeds = {speed for time, speed in zip(rows["time"], rows["canopy_0_payload_velocity_z"]) if time > 0.2}
        self.assertEqual(1, len(speeds))
        self.assertNotEqual({0.0}, speeds)

    def test_contact_is_resolved(self):
        self.drop("out", "run.end_time=0.05", "coupling.contact=true", "coupling.thickness=0.005", "verify.intersections=0")
        self.assertEqual({0.0}, set(self.history("out")["intersections"]))

    def test_fields_hold_the_cloth_alone(self):
        self.drop("out", "output.times=[0.2,0.4]")
        names = set(self.fields("out").datasets)
        self.assertEqual({f"/mesh/canopy/{name}" for name in ("vertices", "triangles", "edges", "strings")}
                         | {f"/steps/{step}/canopy/{name}" for step in ("000000", "000001") for name in ("position", "von_mises")}, names)

    def test_failures_name_their_cause(self):
        reported = self.drop("out", "run.dt=1", code=4).stderr
        self.assertIn("run.dt = 1 s exceeds the largest stable time step", reported)
        self.assertIn("run.max_steps = 20 reached at t = ", self.drop("out", "run.max_steps=20", code=4).stderr)
        self.assertEqual(20, self.result("out")["steps"])
        self.assertIn("--seed-mode", self.expect(2, self.write(CLOTH), *QUIET, "--overwrite", "--seed-mode").stderr)
        self.assertIn("verify.exact", self.expect(2, self.write(CLOTH), "--study", "meshes=16:32").stderr)


class Canopies(parachute_program.FlowTest):
    def test_history_follows_the_inflation(self):
        self.expect(0, self.write(CANOPY), *QUIET)
        rows = self.history("out")
        self.assertAlmostEqual(math.pi * (1 - 0.15**2), rows["canopy_0_projected_area"][0], delta=0.05)
        self.assertLess(min(rows["canopy_0_projected_area"]), 2.5)
        self.assertGreater(rows["canopy_0_force_z"][-1], 50)
        self.assertGreater(rows["canopy_0_line_force_z"][-1], 50)
        for axis, place in zip("xyz", (0, 0, -math.sqrt(1.8**2 - 1))):
            self.assertEqual([0.0], sorted(set(rows[f"canopy_0_payload_velocity_{axis}"])))
            self.assertEqual(1, len(set(rows[f"canopy_0_payload_{axis}"])))
            self.assertAlmostEqual(place, rows[f"canopy_0_payload_{axis}"][0], delta=1e-12)
        self.assertGreater(max(rows["canopy_0_largest_strain"]), 1e-3)
        self.assertEqual(0.0, rows["cloth_kinetic_energy"][0])
        self.assertGreater(min(rows["cloth_elastic_energy"][1:]), 0.0)
        self.assertGreater(max(rows["force_balance"]), 0.0)
        self.assertLess(max(rows["force_balance"]), 1e-14)
        reported = self.result("out")
        self.assertGreater(reported["canopies"]["vertices"], 200)
        self.assertGreater(reported["canopies"]["substeps"], 1)

    def test_guided_payload_moves_along_z_alone(self):
        leaning = CANOPY.replace("edge_length", "angle = 30\nedge_length").replace("times = [0.1, 0.2]", "times = [0.2]")
        for payload, moves in (("{ mass = 2 }", True), ("{ mass = 2, guided = true }", False)):
            with self.subTest(payload):
                self.expect(0, self.write(leaning.replace("{ mass = 2, fixed = true }", payload)), *QUIET, "--overwrite")
                rows = self.history("out")
                self.assertGreater(max(map(abs, rows["canopy_0_line_force_x"])), 10)
                self.assertGreater(max(rows["canopy_0_payload_velocity_z"]), 0.1)
                self.assertEqual(moves, max(map(abs, rows["canopy_0_payload_velocity_x"])) > 0)
                self.assertEqual(moves, len(set(rows["canopy_0_payload_x"])) > 1)

    def test_vent_lines_hold_the_vent_together(self):
        """Without a band along the vent, its edge is stretched least with them."""
        strains, strings = [], []
        for lines in ("", "vent_lines = { stiffness = 2000 }\n"):
            self.expect(0, self.write(CANOPY.replace("reinforcement", lines + "reinforcement")), *QUIET, "--overwrite")
            strains.append(max(self.history("out")["canopy_0_largest_strain"]))
            fields = self.fields("out")
            strings.append(len(array.array("q", fields.datasets["/mesh/canopy/strings"])) // 2)
            self.assertEqual(3 * self.result("out")["canopies"]["vertices"], len(fields.values("/mesh/canopy/vertices")))
        self.assertLess(strains[1], 0.9 * strains[0])
        self.assertGreater(strings[1], strings[0])

    def test_files_hold_the_canopy_beside_the_flow(self):
        self.expect(0, self.write(CANOPY), *QUIET)
        fields, vertices = self.fields("out"), self.result("out")["canopies"]["vertices"]

        def integers(name):
            return array.array("q", fields.datasets["/mesh/canopy/" + name])

        triangles = integers("triangles")
        self.assertEqual(3 * vertices, len(fields.values("/mesh/canopy/vertices")))
        self.assertEqual(set(range(vertices - 1)), set(triangles))
        # An annulus: as many edges as vertices and triangles; and the lines.
        edges = integers("edges")
        self.assertEqual(vertices - 1 + len(triangles) // 3 + 8, len(edges) // 2)
        for step in ("000000", "000001"):
            position = fields.values(f"/steps/{step}/canopy/position")
            self.assertEqual(3 * vertices, len(position))
            stress = fields.values(f"/steps/{step}/canopy/von_mises")
            self.assertEqual(len(triangles) // 3, len(stress))
            self.assertGreater(max(stress), 1.0)
            self.assertGreaterEqual(min(stress), 0.0)
            self.assertEqual(20 * 20 * 30 * 3, len(fields.values(f"/steps/{step}/velocity")))
        payload = position[-3:]
        self.assertAlmostEqual(-math.sqrt(1.8**2 - 1), payload[2], delta=1e-12)
        document = xml.etree.ElementTree.parse(self.folder / "out/fields.xdmf")
        grids = [grid.get("Name") for grid in document.iter("Grid") if grid.get("GridType") == "Collection"]
        self.assertEqual(["scene", "scene canopy triangles", "scene canopy strings"], grids)
        for item in document.iter("DataItem"):
            self.assertIn(item.text.removeprefix("fields.h5:"), fields.datasets)

    def test_checks_compare_means_and_bounds(self):
        def checks(drag, speed, *peak):
            return ("verify={history=[" + statistic("canopy_0_drag_coefficient", "mean", drag, 0.05, from_=0.05, to=0.2) + "," +
                    statistic("canopy_0_airspeed", "mean", speed, 1e-12, from_=0.05, to=0.2) + "],"
                    "peak_force=[{{force=[{},{}],time=[{},{}]}}]}}".format(*peak))

        scene = self.write(CANOPY.replace("history_every = 2", "history_every = 1"))
        wanted = [1, 8, 0, 1e5, 0, 0.2]
        self.start(scene, *QUIET, sets=[checks(*wanted)])
        reported, rows = self.result("out")["canopies"], self.history("out")
        forces = [math.hypot(*(rows[f"canopy_0_line_force_{axis}"][k] for axis in "xyz")) for k in range(len(rows["time"]))]
        self.assertAlmostEqual(max(forces), reported["peak_force_0"], delta=1e-9 * max(forces))
        self.assertEqual(rows["time"][forces.index(max(forces))], reported["peak_force_0_time"])
        mean = mean_from(0.05, rows["time"], rows["canopy_0_force_z"])
        drag = self.measured("canopy_0_drag_coefficient_mean")
        self.assertAlmostEqual(2 * mean / (1.225 * 64 * math.pi), drag, delta=1e-6)
        good = [drag, 8, 0.9 * max(forces), 1.1 * max(forces), reported["peak_force_0_time"] - 0.01, 1]
        self.expect(0, scene, *QUIET, "--overwrite", sets=[checks(*good)])
        for which, value in ((0, 1.2 * good[0]), (1, 8.1), (3, 0.95 * max(forces)), (4, reported["peak_force_0_time"] + 0.01)):
            with self.subTest(which):
                bad = [*good[:which], value, *good[which + 1:]]
                self.expect(5, scene, *QUIET, "--overwrite", sets=[checks(*bad)])

    def peak(self, out, scene, *sets, restart=()):
        words = [] if restart else ["--overwrite"]
        self.expect(0, scene, "--quiet", "--backend", "serial", "--out", out, *words, *restart, sets=["verify={peak_force=[{force=[0,1e9]}]}", *sets])
        canopies = self.result(out)["canopies"]
        return canopies["peak_force_0"], canopies["peak_force_0_time"]

    def test_peak_forces_are_those_of_all_steps_whatever_the_rows(self):
        for scene in (CANOPY.replace("fields =", "restart_every = 4\nfields ="), CLOTH.replace("mass = 0.1", "fixed = true").replace(
                "-9.81", "-98.1").replace("end_time = 0.4", "end_time = 0.35")):
            file = self.write(scene)
            rest = ["run.end_time=0.2"] if "[fluid]" in scene else []
            wanted = self.peak("every", file, "output.history_every=1", *rest)
            rows = self.history("every")
            forces = [math.hypot(*(rows[f"canopy_0_line_force_{axis}"][k] for axis in "xyz")) for k in range(len(rows["time"]))]
            self.assertAlmostEqual(max(forces), wanted[0], delta=1e-12 * max(forces))
            self.assertAlmostEqual(rows["time"][forces.index(max(forces))], wanted[1], delta=1e-12)
            for rows_every in (0, 7, 50):
                self.assertEqual(wanted, self.peak("rare", file, f"output.history_every={rows_every}", *rest))
            # A run that was continued has the peaks of its first part.
            after = wanted[1] + (0.02 if rest else 0.05)
            half = 0.5 * (wanted[1] + after)
            outputs = f"output.times=[{half},{after}]"
            whole = self.peak("whole", file, "output.history_every=50", f"run.end_time={after}", outputs)
            part = self.folder / "part"
            self.peak(part, file, "output.history_every=50", f"output.restart_every={4 if rest else 100}", f"run.end_time={half}", f"output.times=[{half}]")
            again = self.peak(part, file, "output.history_every=50", f"run.end_time={after}", outputs, restart=("--restart", part / "restart.h5"))
            self.assertEqual(whole, again)

    def test_leak_is_that_of_the_porosity(self):
        """Through open, porous and impermeable cloth, averaged over the inflated canopy."""
        scene = self.write(CANOPY)
        # Displacements of a millimetre at the start (perturbation = { amplitude = 1e-3, seed = 1 }, 2 and 3) change these means:
        # they are 0.374 to 0.384, 0.096 to 0.109 and -0.010 to -0.013; in steps a quarter as long 0.364, 0.073 and less than 1e-4.
        for law, expected, tolerance in (('{law="forchheimer",alpha=30,beta=10}', 0.379, 0.02), ('{law="forchheimer"}', 0.102, 0.015),
                                         ('{law="none"}', -0.012, 0.005)):
            self.start(scene, *QUIET, "--overwrite", sets=[f"canopy[0].porosity={law}", "output.history_every=1",
                                                           "verify={leak=[{from=0.1,to=0.2,tolerance=1}]}"])
            reported, rows = self.result("out"), self.history("out")

            def mean(column, power=1):
                window = [k for k, time in enumerate(rows["time"]) if 0.1 <= time <= 0.2]
                areas = sum(0.5 * (rows["time"][k] - rows["time"][k - 1]) * (rows[column][k]**power + rows[column][k - 1]**power)
                            for k in window[1:])
                return areas / (rows["time"][window[-1]] - rows["time"][window[0]])

            stream = 8 * mean("canopy_0_projected_area")
            leak, rms = mean("canopy_0_leak") / stream, math.sqrt(mean("canopy_0_leak", 2)) / stream
            self.assertAlmostEqual(abs(leak), reported["canopies"]["leak_0"], delta=1e-9)
            self.assertAlmostEqual(rms, reported["canopies"]["leak_rms_0"], delta=1e-9)
            self.assertAlmostEqual(expected, leak, delta=tolerance)
            self.assertEqual(["leak_0", True], [reported["checks"][0][key] for key in ("name", "passed")])
        for tolerances in ("tolerance=1e-3", "tolerance=1,rms_tolerance=1e-3"):
            self.expect(5, scene, *QUIET, "--overwrite", sets=[f"verify={{leak=[{{from=0.1,to=0.2,{tolerances}}}]}}"])

    def test_explicit_coupling_diverges_with_real_cloth(self):
        scene, method = self.write(CANOPY), 'coupling.method="explicit"'
        refused = self.expect(3, scene, *QUIET, sets=[method]).stderr
        self.assertIn("waves as long as canopy[0], 2 m, move 0.78 kg/m^2 of fluid, 20.9 times the 0.0373 kg/m^2 of its cloth", refused)
        message = self.expect(4, scene, *QUIET, sets=[method, "coupling.allow_unstable=true"]).stderr
        self.assertIn('coupling.method = "explicit" is unstable for cloth that moves 20.9 times its own mass of fluid', message)
        reported = self.result("out")
        self.assertAlmostEqual(20.9, reported["canopies"]["added_mass_ratio"], delta=0.05)
        self.assertLess(reported["steps"], 20)
        self.assertTrue((self.folder / "out/restart.h5").exists())

    def test_explicit_coupling_of_heavy_cloth_agrees_with_spreading(self):
        """To first order in dt: the difference is 10, 5 and 2 per cent with steps of 0.004, 0.002 and 0.0005 s."""
        heavy = self.write(CANOPY.replace("lines =", 'cloth = "custom"\narea_density = 5\nlines =').replace(
            "max_dt = 0.01\ncfl = 0.25", "dt = 0.002"))
        sets = ["output={history_every=1,restart_every=15,fields=['position'],times=[0.1,0.2]}"]
        method = 'coupling.method="explicit"'
        forces = {}
        for run, more in (("spread", ['coupling.corrections="plain"']), ("explicit", [method])):
            self.expect(0, heavy, "--quiet", "--backend", "serial", "--out", run, sets=[*sets, *more])
            rows = self.history(run)
            window = [force for time, force in zip(rows["time"], rows["canopy_0_force_z"]) if time > 0.1]
            forces[run] = sum(window) / len(window)
        self.assertGreater(forces["spread"], 50)
        self.assertAlmostEqual(1, forces["explicit"] / forces["spread"], delta=0.07)
        # A run that is continued has the same bits.
        self.assert_continues(self.history("explicit"), heavy, [*sets, method, "run.end_time=0.1", "output.times=[0.1]"], [*sets, method])

    def test_what_makes_the_drag_of_a_body_unfit_is_printed_and_kept(self):
        scene = self.write("""\
app = "parachute"
[fluid]
density = 1.2
viscosity = 1.8e-5
velocity = [0, 0, 8]
[grid]
cells = [16, 16, 24]
domain = [[-1, 1], [-1, 1], [-1, 2]]
boundary = { x = "slip", y = "slip", z = ["inflow", "outflow"] }
[[body]]
kind = "cup"
axis = "z"
opening = "low"
centre = [0, 0, 0]
radius = 0.3
edge_length = 0.08
[run]
end_time = 0.3
""")
        warnings = ["grid.domain: the body covers 7.07 % of its section across z, so that its drag is that in a duct and not in free air; "
                    "a square section of 3.76 m has at most 2 %",
                    "run.end_time: 4 widths of body[0] pass with the stream, and its wake starts up in some 40, so that its drag is not yet "
                    "that of a steady stream; 3.6 s leave time for a mean"]
        process = self.start(scene, "--out", "out", sets=["run.max_steps=2"])
        self.assertEqual(warnings, self.result("out")["warnings"])
        self.assertEqual([f"drogue-parachute: {warning}" for warning in warnings], process.stderr.splitlines()[:2])
        wide = ["grid.domain=[[-1.88,1.88],[-1.88,1.88],[-1,2]]", "grid.cells=[32,32,24]", "run.end_time=3.6"]
        self.assertEqual("", self.expect(0, scene, "--check", sets=wide).stderr)

    def test_what_makes_the_numbers_of_a_canopy_unfit_is_printed_and_kept(self):
        scene = self.write(CANOPY.replace("[run]", "[coupling]\nedge_inset = 0\n[run]"))
        process = self.start(scene, "--out", "out", sets=["run.end_time=0.02", "output={}", "verify={}"])
        warnings = self.result("out")["warnings"]
        self.assertEqual(["grid.domain: the open canopy covers 8.81 % of its section", "grid: 6.7 cells across the 1.34 m of canopy[0] once",
                          "coupling.edge_inset = 0: skirt and vent act on the air", "canopy[0]: the largest line force is that of the end"],
                         [" ".join(warning.split()[:10]) for warning in warnings])
        self.assertEqual([f"drogue-parachute: {warning}" for warning in warnings], process.stderr.splitlines())
        # Those of the start stand in a quiet run, a failed one and a check too.
        warnings.pop()
        self.expect(4, scene, *QUIET, "--overwrite", sets=["run.max_steps=2", "output={}"])
        self.assertEqual(warnings, self.result("out")["warnings"])
        self.assertEqual([f"drogue-parachute: {warning}" for warning in warnings], self.start(scene, "--check").stderr.splitlines())
        free = ["grid.cells=[90,90,90]", "grid.domain=[[-5,5],[-5,5],[-5,5]]", "canopy[0].edge_length=0.07"]
        self.assertEqual("", self.expect(0, self.write(CANOPY), "--check", sets=free).stderr)

    def test_canopy_that_leaves_the_domain_ends_the_run(self):
        free = CANOPY.replace("fixed = true", "fixed = false").replace("end_time = 0.2", "end_time = 5").replace(
            "times = [0.1, 0.2]", "times = [5]")
        process = self.expect(4, self.write(free), *QUIET)
        self.assertRegex(process.stderr, r"canopy\[0\] leaves the domain: its (cloth|payload) at .* side z_high after step \d+, t = ")
        rows = self.history("out")
        self.assertGreater(rows["canopy_0_payload_velocity_z"][-1], 0.5)
        reported = self.result("out")
        self.assertEqual("numerical-failure", reported["status"])
        self.assertAlmostEqual(reported["time"], rows["time"][-1], delta=1e-12)
        again = self.expect(4, self.write(free), *QUIET, "--restart", "auto")
        self.assertEqual(process.stderr, again.stderr)

    def test_payload_that_leaves_before_the_grid_follows_ends_the_run(self):
        free = CANOPY.replace("fixed = true", "fixed = false").replace("cells", 'frame = "follow"\ncells').replace(
            "max_dt = 0.01\ncfl = 0.25\n", "")
        sets = ["fluid.velocity=[0,0,1]", "coupling.gravity=[0,0,-9.81]", "run.end_time=1.5", "output={}", "verify={}"]
        self.expect(0, self.write(free), *QUIET, sets=sets)
        still = [*sets, "fluid.velocity=[0,0,0]", "run.max_dt=0.15", "canopy[0].membrane_modulus=1000", "grid.domain=[[-2,2],[-2,2],[-1.75,4.25]]"]
        process = self.expect(4, self.write(free), *QUIET, "--overwrite", sets=still)
        self.assertRegex(process.stderr, r"its payload at .* side z_low after step \d, .*; a smaller run\.max_dt, with which the grid "
                                         r"follows sooner, a larger grid\.domain or a shorter run\.end_time may save the run")

    def test_grid_follows_a_free_payload(self):
        """The stream carries the parachute of the test above out of a fixed grid."""
        free = CANOPY.replace("fixed = true", "fixed = false").replace("times = [0.1, 0.2]", "times = [1]").replace(
            "cells", 'frame = "follow"\ncells')
        sets = ["coupling.gravity=[0, 0, -9.81]", "run.end_time=1", "output.restart_every=37", "verify={history=[" +
                statistic("canopy_0_airspeed", "mean", 4, 10, from_=0.4, to=1) + "]}"]
        process = self.expect(4, self.write(free), *QUIET, sets=[*sets, 'grid.frame="fixed"'])
        self.assertIn("canopy[0] leaves the domain", process.stderr)
        self.expect(0, self.write(free), *QUIET, "--overwrite", sets=sets)
        rows = self.history("out")
        start = -math.sqrt(1.8**2 - 1)
        places = rows["canopy_0_payload_z"]
        self.assertAlmostEqual(start, places[0], delta=1e-12)
        self.assertGreater(places[-1] - start, 3.0)
        self.assertGreater(rows["frame_velocity_z"][-1], 2.0)
        self.assertEqual(0.0, rows["frame_velocity_z"][0])
        self.assertEqual(0.0, rows["frame_position_z"][0])
        for place, moved in zip(places, rows["frame_position_z"]):
            self.assertLess(abs(place - moved - start), 0.8)
        self.assertAlmostEqual(places[-1] - rows["frame_position_z"][-1],
                               self.fields("out").values("/steps/000000/canopy/position")[-1], delta=1e-12)
        self.assertNotIn("frame_velocity_x", rows)
        # Velocities in the fixed frame are the rates of positions in it.
        for which, speed in (("canopy_0_payload_z", "canopy_0_payload_velocity_z"),
                             ("frame_position_z", "frame_velocity_z")):
            path = sum((rows["time"][k + 1] - rows["time"][k]) * (rows[speed][k + 1] + rows[speed][k]) / 2
                       for k in range(len(rows["time"]) - 1))
            self.assertAlmostEqual(rows[which][-1] - rows[which][0], path, delta=0.1)
        # The checks have the velocity of the fluid relative to the payload.
        speeds = [math.hypot(x, y, 8 - z) for x, y, z in zip(*(rows[f"canopy_0_payload_velocity_{axis}"] for axis in "xyz"), strict=True)]
        mean = mean_from(0.4, rows["time"], speeds)
        self.assertAlmostEqual(mean, self.measured("canopy_0_airspeed_mean"), delta=1e-9)
        self.assertGreater(mean, 2.0)
        # A run that is continued from the middle of a block has the same bits.
        sets = [*sets[:-1], "output.times=[0.5, 1]"]
        self.expect(0, self.write(free), *QUIET, "--overwrite", sets=sets)
        self.assert_continues(self.history("out"), self.write(free), [*sets, "run.end_time=0.5", "output.times=[0.5]"], sets)

    def test_steps_may_become_shorter_at_a_restart(self):
        """The default inset of edges, which follows from the Courant number, is that of the new steps."""
        scene, output = self.write(CANOPY), "output={restart_every=5,fields=[],history_every=2}"
        self.expect(0, scene, *QUIET, sets=[output, "run.end_time=0.05"])
        self.expect(0, scene, *QUIET, "--restart", "auto", sets=[output, "run.end_time=0.08", "run.cfl=0.1"])

    def test_gravity_pulls_a_free_payload(self):
        still = CANOPY.replace("velocity = [0, 0, 8]", "velocity = [0, 0, 0]").replace("fixed = true", "fixed = false")
        self.expect(0, self.write(still), *QUIET, sets=["coupling.gravity=[0, 0, -9.81]", "output.history_every=1"])
        rows = self.history("out")
        # At first the payload falls freely: the lines are taut without force.
        early = next(k for k, time in enumerate(rows["time"]) if time > 0.005)
        self.assertAlmostEqual(-9.81 * rows["time"][early], rows["canopy_0_payload_velocity_z"][early], delta=0.01)
        self.assertGreater(rows["canopy_0_force_z"][-1], 0.7)
        self.assertGreater(rows["canopy_0_payload_velocity_z"][-1], -9.81 * 0.2)

    REEFED = CANOPY.replace('kind = "flat-circular"', 'kind = "flat-circular"\nshape = "partly-closed"\nclosure = 0.6').replace(
        "reinforcement = { skirt = 500 }", "reefing = { length = 3.8, stiffness = 2000, cut = 0.2 }")

    def test_reefing_line_keeps_the_mouth_narrow_until_it_is_cut(self):
        words = ("--quiet", "--backend", "serial", "--overwrite")
        sets = ["output={history_every=1}", "run.end_time=0.32"]
        scene = self.write(self.REEFED)
        self.expect(0, scene, *words, "--out", "out", sets=sets)
        self.expect(0, scene, *words, "--out", "never", sets=[*sets, "canopy[0].reefing={length=3.8,stiffness=2000}"])
        rows, never = self.history("out"), self.history("never")
        self.assertIn(0.2, rows["time"])
        # A circle of the length of the line, and the cloth that bulges beside and between its lines.
        self.assertLess(max(never["canopy_0_projected_area"]), 1.7 * 3.8**2 / (4 * math.pi))
        self.assertGreater(max(rows["canopy_0_projected_area"]), 1.1 * max(never["canopy_0_projected_area"]))
        # A run continues bit for bit from before the cut and from it.
        for half in (0.15, 0.2):
            with self.subTest(half):
                part = self.folder / "part"
                times = ["run.end_time=0.25", f"output={{history_every=1,restart_every=1,times=[{half},0.25],fields=['position']}}"]
                self.expect(0, scene, *words, "--out", "out", sets=times)
                uncut = ["canopy[0].reefing={length=3.8,stiffness=2000}"] if half < 0.2 else []
                self.expect(0, scene, *words, "--out", part,
                            sets=[*times, f"run.end_time={half}", f"output.times=[{half}]", *uncut])
                self.expect(0, scene, *words[:-1], "--out", part, "--restart", part / "restart.h5", sets=times)
                whole, again = self.history("out"), self.history("part")
                for name in whole:
                    self.assertEqual(whole[name][-1], again[name][-1], name)

    def test_lines_and_payload_have_drag_if_asked(self):
        words = ("--quiet", "--backend", "serial", "--overwrite")
        output = "output={history_every=1,restart_every=1,times=[0.1,0.2],fields=['position']}"
        scene = self.write(CANOPY)
        self.expect(0, scene, *words, "--out", "none", sets=[output])
        self.assertFalse([name for name in self.history("none") if "_drag_" in name and "coefficient" not in name])
        drag = ["canopy[0].lines.drag={diameter=0.01}", "canopy[0].payload.drag={area=0.02,coefficient=0.5}"]
        self.expect(0, scene, *words, "--out", "out", sets=[output, *drag])
        rows = self.history("out")
        # The payload is held below the canopy, where the stream is slower by what the canopy displaces.
        pressure = 0.5 * 1.225 * 64
        for force in rows["canopy_0_payload_drag_z"][1:]:
            self.assertAlmostEqual(1, force / (pressure * 0.02 * 0.5), delta=0.06)
        # Lines move with the cloth at first. Less than that of the lines to the flat cloth, of 1 m radius, in a free stream.
        sine = 1 / 1.8
        most = 8 * pressure * 1.8 * 0.01 * (1.1 * sine**3 + 0.02 * (1 - sine**2) ** 1.5)
        self.assertTrue(0.05 * most < rows["canopy_0_line_drag_z"][-1] < most, rows["canopy_0_line_drag_z"][-1] / most)
        self.assertLess(max(rows["force_balance"]), 1e-14)
        # A run continues bit for bit.
        self.expect(0, scene, *words, "--out", "part", sets=[output, *drag, "run.end_time=0.1", "output.times=[0.1]"])
        self.expect(0, scene, *words[:-1], "--out", "part", "--restart", "auto", sets=[output, *drag])
        again = self.history("part")
        for name in rows:
            self.assertEqual(rows[name][-1], again[name][-1], name)

    def test_line_that_breaks_ends_the_run(self):
        self.expect(0, self.write(CANOPY), *QUIET, sets=["output.history_every=1"])
        rows = self.history("out")
        most = max(rows["canopy_0_line_force_z"])
        strength = 0.5 * most / 8
        process = self.expect(4, self.write(CANOPY), *QUIET, "--overwrite",
                              sets=["output.history_every=1", f"canopy[0].lines.strength={strength}"])
        self.assertRegex(process.stderr, r"line [0-7] of canopy\[0\] breaks at \(\S+, \S+, \S+\) m: it carries more than "
                         r"canopy\[0\].lines.strength = \S+ N in the step after step \d+, t = ")
        reported, broken = self.result("out"), self.history("out")
        self.assertEqual(("numerical-failure", 4), (reported["status"], reported["exit_code"]))
        # Eight lines at an angle to z, of which the first one breaks at its strength.
        self.assertLess(max(broken["canopy_0_line_force_z"]), 8 * strength)
        again = self.expect(4, self.write(CANOPY), *QUIET, "--restart", "auto",
                            sets=["output.history_every=1", f"canopy[0].lines.strength={strength}"])
        self.assertEqual(process.stderr, again.stderr)
        self.expect(0, self.write(CANOPY), *QUIET, "--overwrite", sets=[f"canopy[0].lines.strength={most}"])

    def test_payload_that_is_released_falls_freely(self):
        still = CANOPY.replace("velocity = [0, 0, 8]", "velocity = [0, 0, 4]").replace("fixed = true", "release = 0.1")
        self.expect(0, self.write(still), *QUIET, sets=["coupling.gravity=[0, 0, -9.81]", "output.history_every=1"])
        rows = self.history("out")
        self.assertIn(0.1, rows["time"])
        released, last = rows["time"].index(0.1) + 1, len(rows["time"]) - 1
        self.assertGreater(rows["canopy_0_line_force_z"][released - 1], 1.0)
        self.assertEqual({0.0}, set(rows["canopy_0_line_force_z"][released:]))
        fall = rows["canopy_0_payload_velocity_z"][last] - rows["canopy_0_payload_velocity_z"][released]
        self.assertAlmostEqual(-9.81 * (rows["time"][last] - rows["time"][released]), fall, delta=1e-9)

    def test_canopies_share_a_payload(self):
        """Two canopies on risers pull a payload with the sum of their forces."""
        canopy = CANOPY[CANOPY.index("[[canopy]]"):CANOPY.index("[run]")].replace(
            "diameter = 2", "diameter = 1").replace("length = 1.8", "length = 0.9").replace(
            "reinforcement", "riser = { length = 1, stiffness = 5000, mass = 0.05 }\nangle = 25\nreinforcement")
        first = canopy.replace("angle", "centre = [0.75, 0, 0.5]\nangle").replace("fixed = true", "fixed = false")
        other = canopy.replace("angle", "azimuth = 180\nangle").replace("mass = 2, fixed = true", "shared = 0")
        scene = self.write(CANOPY[:CANOPY.index("[[canopy]]")] + first + other + CANOPY[CANOPY.index("[run]"):])
        self.expect(0, scene, *QUIET, sets=["output.history_every=1", "coupling.contact=true", "coupling.thickness=0.005", "verify.intersections=0"])
        rows = self.history("out")
        self.assertEqual({0.0}, set(rows["intersections"]))
        for axis in "xyz":
            self.assertEqual(rows[f"canopy_0_payload_{axis}"], rows[f"canopy_1_payload_{axis}"])
        # The impulse of both risers moves the payload of 2 kg.
        steps = range(1, len(rows["time"]))
        impulse = sum((rows["time"][k] - rows["time"][k - 1]) * (rows[f"canopy_{i}_line_force_z"][k] + rows[f"canopy_{i}_line_force_z"][k - 1]) / 2
                      for k in steps for i in (0, 1))
        self.assertGreater(impulse, 0.1)
        self.assertAlmostEqual(2 * rows["canopy_0_payload_velocity_z"][-1], impulse, delta=0.05 * impulse)
        self.assertAlmostEqual(rows["canopy_0_line_force_x"][2], -rows["canopy_1_line_force_x"][2], delta=1e-2 * rows["canopy_0_line_force_z"][2])

    def test_sheet_falls_on_a_body_and_stays_outside(self):
        sheet = CANOPY[:CANOPY.index("[[canopy]]")].replace("velocity = [0, 0, 8]", "velocity = [0, 0, 0]") + (
            '[[canopy]]\nkind = "sheet"\ndiameter = 1.2\ngores = 8\nvent = 0\nedge_length = 0.14\ncentre = [0, 0, 0.3]\n'
            '[[body]]\nkind = "sphere"\ncentre = [0, 0, -0.3]\nradius = 0.3\nedge_length = 0.14\n'
            "[coupling]\ngravity = [0, 0, -9.81]\ncontact = true\nthickness = 0.02\n") + CANOPY[CANOPY.index("[run]"):]
        self.expect(0, self.write(sheet), *QUIET, sets=["run.end_time=1.2", "output={history_every=1}", "verify={intersections=0}"])
        rows = self.history("out")
        self.assertEqual({0.0}, set(rows["intersections"]))
        self.assertEqual({0.0}, set(rows["canopy_0_line_force_z"]))
        # The air slows the fall; the sphere, whose top is at 0 m, ends it.
        self.assertGreater(min(rows["canopy_0_payload_velocity_z"]), -3)
        self.assertLess(rows["canopy_0_payload_z"][-1], 0.2)
        self.assertGreater(rows["canopy_0_payload_z"][-1], -0.3)

    def test_drum_in_thin_air_has_the_frequency_of_its_tension(self):
        """The first zero of J0 times sqrt(T / mass per area) over the circumference, with air of little mass."""
        exact = 2.404826 / (2 * math.pi * 0.5) * math.sqrt(100 / 0.2)
        sets = ["fluid.density=1e-5", "verify.history[0].tolerance=0.01", f"verify.history[0].value={exact}"]
        self.expect(0, self.write(bad_canopies.DRUM), *QUIET, sets=sets)
        rows = self.history("out")
        self.assertLess(max(rows["force_balance"]), 1e-13)
        # The energy of this mode moves to and fro; the rim stays where it is.
        self.assertAlmostEqual(rows["canopy_0_payload_z"][0], max(rows["canopy_0_payload_z"]), delta=1e-5)
        self.assertAlmostEqual(-rows["canopy_0_payload_z"][0], min(rows["canopy_0_payload_z"]), delta=1e-5)
        sets[1] = "verify.history[0].tolerance=1e-6"
        self.expect(5, self.write(bad_canopies.DRUM), *QUIET, "--overwrite", sets=sets)

    def test_backends_agree_until_the_cloth_buckles(self):
        for backend in ("serial", gas_program.threaded()):
            self.expect(0, self.write(CANOPY), "--quiet", "--backend", backend, "--out", backend, "--overwrite",
                        sets=["run.end_time=0.025", "output.times=[0.025]"])
            last = self.history(backend)["canopy_0_line_force_z"][-1]
            self.assertAlmostEqual(1.0, last / self.history("serial")["canopy_0_line_force_z"][-1], delta=1e-6)


class Flags(parachute_program.FlowTest):
    def test_stiff_flag_in_thin_fluid_is_a_pendulum(self):
        """A flag that falls from the horizontal in fluid at rest of little mass is a pendulum: a hinged rod."""
        for scene in (bad_flags.GOOD, bad_flags.WIDE):
            with self.subTest(wide=scene == bad_flags.WIDE):
                self.assert_pendulum(scene)

    def assert_pendulum(self, scene):
        pendulum = scene.replace("density = 1\n", "density = 1e-6\n", 1).replace("viscosity = 0.005", "viscosity = 0").replace(
            "velocity = [1, 0, 0]", "velocity = [0, 0, 0]").replace("angle = 18", "angle = 6").replace("bending_stiffness = 0.0015", "bending_stiffness = 2")
        # A rod: sqrt(3 g / (2 l)) / (2 pi), and its amplitude of sin(6 degrees) lengths.
        exact = math.sqrt(3 * 0.5 / 2) / (2 * math.pi)
        sets = ["run={end_time=26,max_dt=0.04}", "verify={history=[" + statistic("flag_0_tip_y", "frequency", exact, 3e-3) + "," +
                statistic("flag_0_tip_y", "amplitude", math.sin(math.radians(6)), 3e-2) + "]}"]
        self.expect(0, self.write(pendulum), *QUIET, "--overwrite", sets=sets)

    def test_forces_on_a_flag_stretch_it_downstream_and_a_run_continues(self):
        # Vertices of the trailing edge, from the last one on, in whose middle the tip lies.
        inset = bad_flags.WIDE.replace("[coupling]\n", "[coupling]\nedge_inset = 0.55\n")
        for name, text, tip in (("strip", bad_flags.GOOD, (2, 1)), ("wide", inset, (5, 5))):
            with self.subTest(name):
                self.assert_runs_and_continues(name, text, tip)
        places = self.fields("wide").values("/steps/000000/flag/position")
        for k in range(1, 5):
            low, high = places[-3 * (10 - k):][:3], places[-3 * k:][:3]
            self.assertAlmostEqual(low[1], high[1], delta=1e-9, msg="the flag is symmetric")
            self.assertAlmostEqual(low[2], -high[2], delta=1e-9)
        self.assertGreater(places[-1] - places[-25], 0.45)

    def assert_runs_and_continues(self, name, text, tip):
        sets = ["run.end_time=1", "output={history_every=1,times=[0.5],fields=['velocity'],restart_every=10}", "verify={}"]
        scene = self.write(text)
        self.expect(0, scene, "--quiet", "--backend", "serial", "--out", name, sets=sets)
        rows = self.history(name)
        places = self.fields(name).values("/steps/000000/flag/position")
        (row,) = [k for k, time in enumerate(rows["time"]) if time == 0.5]
        self.assertEqual(rows["flag_0_tip_y"][row], 0.5 * (places[1 - 3 * tip[0]] + places[1 - 3 * tip[1]]))
        self.assertGreater(rows["flag_0_force_x"][-1], 0.0)
        self.assertLess(max(rows["flag_0_tip_x"]), 0.01 + 1.02)  # hardly longer than at rest
        self.assert_continues(rows, scene, [*sets, "run.end_time=0.5"], sets, ("flag_0_tip_y", "flag_0_force_y", "kinetic_energy"),
                              f"{name}-half")

    def test_flag_that_leaves_the_domain_ends_the_run(self):
        run = self.expect(4, self.write(bad_flags.GOOD), *QUIET, sets=[
            "fluid.velocity=[0, 0, 0]", "coupling.gravity=[0, 5, 0]", "flag[0].leading_edge=[0.01, 0.6]", "flag[0].angle=0", "verify={}"])
        self.assertIn("flag[0] leaves the domain: a vertex at (", run.stderr)


class Restart(parachute_program.FlowTest):
    SETS = ("run.end_time=1.5", "output.times=[0.3, 0.9, 1.5]", "output.restart_every=4", "grid.cells=[24, 20, 16]",
            "verify={energy_growth=1e9}")

    def compare(self, backend, scheme, stop, code, scene=GUST):
        file, sets = self.write(scene), [*self.SETS, *scheme]
        shutil.rmtree(self.folder / "part", ignore_errors=True)
        words = ["--backend", backend]
        self.expect(0, file, "--quiet", "--out", "whole", "--overwrite", *words, sets=sets)
        process = self.begin(file, *words, sets=sets)
        stop(process)
        self.assertEqual(code, process.wait(timeout=60), process.stderr.read())
        (self.folder / "part/.lock").unlink(missing_ok=True)
        self.expect(0, file, "--quiet", "--out", "part", "--restart", "auto", *words, sets=sets)
        self.assert_same_runs()

    def test_interrupted_run_equals_uninterrupted_run(self):
        for scheme in (["flow.time=ab2"], ["flow.time=rk3"]):
            with self.subTest(scheme):
                self.compare("serial", scheme, lambda process: process.send_signal(signal.SIGINT), 130)

    def test_interrupted_run_with_bodies_equals_uninterrupted_run(self):
        self.SETS = ("output.restart_every=4", "output.history_every=7", "run.end_time=1")
        self.compare("serial", [], lambda process: process.send_signal(signal.SIGINT), 130, PLATE)

    def test_interrupted_inflation_equals_uninterrupted_inflation(self):
        drag = statistic("canopy_0_drag_coefficient", "mean", 1, 10, from_=0.05, to=0.2)
        self.SETS = ("output.restart_every=5", "verify={force_balance=1e-14,history=[" + drag + "],leak=[{from=0.05,to=0.2,tolerance=1}]}")
        for coupling in (["contact=false"], ["contact=true"], ["corrections=\"plain\"", "edge_inset=0.55"]):
            with self.subTest(coupling):
                self.compare("serial", ["coupling." + text for text in coupling], lambda process: process.send_signal(signal.SIGINT), 130, CANOPY)

    def test_finished_run_continues_to_a_later_end_time(self):
        """It equals a run with an output at the former end bit for bit, which ends its steps there too."""
        growth, interval = "energy_growth=1e9,speed_growth=1e9,dissipation_peak={value=1,tolerance=1e9}", "from=0,to=0.2"

        def means(*columns):
            return "history=[" + ",".join(statistic("canopy_0_" + name, "mean", 1, 1e9, from_=0, to=0.2) for name in columns) + "]"

        for name, text, half, end, more, checks in (
                ("flow", GUST, 0.3, 0.7, (), growth),
                ("implicit", GUST, 0.3, 0.7, ("flow.diffusion=crank-nicolson", "flow.time=ab2"), growth),
                ("canopy", CANOPY, 0.1, 0.2, ("coupling.contact=true",), means("projected_area", "drag_coefficient", "airspeed") +
                 f",leak=[{{{interval},tolerance=9}}],force_balance=1e-14,{growth}"),
                ("cloth", CLOTH, 0.1, 0.2, (), means("projected_area") + ",energy_drift=1,peak_force=[{force=[0,1e9]}]")):
            with self.subTest(name):
                fields = "position" if name in ("canopy", "cloth") else "velocity"
                scene, sets = self.write(text), [*more, f"output={{history_every=7,fields=['{fields}'],times=[{half}]}}"]
                # The interval ends after the first end.
                first = checks.replace("to=0.2", f"to={half}")
                later = [*sets, f"output.times=[{half}, {end}]", f"run.end_time={end}", f"verify={{{checks}}}"]
                words = ["--quiet", "--backend", "serial", "--out"]
                self.expect(0, scene, *words, "part", "--overwrite", sets=[*sets, f"run.end_time={half}", f"verify={{{first}}}"])
                self.expect(0, scene, *words, "part", "--restart", "auto", sets=later)
                self.expect(0, scene, *words, "whole", "--overwrite", sets=later)
                self.assert_same_runs()

    def test_extremes_are_those_of_all_steps_whatever_the_rows(self):
        scene, found = self.write(GUST), {}
        checks = "verify={energy_growth=1e9,speed_growth=1e9,dissipation_peak={value=1,tolerance=1e9,time=1,time_tolerance=1e9}}"
        for every in (0, 1, 7):
            self.expect(0, scene, *QUIET, "--overwrite", sets=[f"output={{history_every={every}}}", checks])
            found[every] = {check["name"]: check["value"] for check in self.result("out")["checks"]}
        self.assertEqual([found[1]] * 2, [found[0], found[7]])
        self.expect(0, scene, *QUIET, "--overwrite", sets=["output={history_every=1}"])
        rows = self.history("out")
        self.assertAlmostEqual(max(rows["max_speed"]) / rows["max_speed"][0] - 1, found[0]["speed_growth"], delta=1e-12)
        rises = [late - early for k, late in enumerate(rows["kinetic_energy"]) for early in rows["kinetic_energy"][:k]]
        self.assertAlmostEqual(max(0, *rises) / rows["kinetic_energy"][0], found[0]["energy_growth"], delta=1e-12)
        # A run that kept none has none for a part of it.
        said = self.expect(6, scene, *QUIET, "--restart", "auto", sets=["run.end_time=0.9", checks]).stderr
        self.assertIn("kept no extremes of its steps", said)

    def test_killed_run_equals_uninterrupted_run(self):
        self.compare(gas_program.threaded(), [], lambda process: process.kill(), -signal.SIGKILL)

    def test_rejects_restarts_of_other_scenes(self):
        self.scene = self.write(GUST)
        sets = ["output.restart_every=5", "output.fields=[]"]
        self.expect(0, self.scene, *QUIET, sets=sets)
        for change, difference in {"fluid.viscosity=0.02": "fluid.viscosity was 0.01 and is 0.02",
                                   "grid.cells=[12, 10, 10]": "grid.cells was [12, 10, 8] and is [12, 10, 10]",
                                   "flow.time=ab2": 'flow.time was "rk3" and is "ab2"'}.items():
            with self.subTest(change):
                message = self.expect(6, self.scene, *QUIET, "--restart", "auto", sets=[*sets, change]).stderr
                self.assertTrue(message.endswith(f"it belongs to another scene: {difference}\n"), message)
        # Without the scene of the file, or with one that is not its own, the difference is not known.
        changed = [*sets, "fluid.viscosity=0.02"]
        scene = self.folder / "out/scene.toml"
        for text in (scene.read_text().replace("time = \"rk3\"", "time = \"ab2\""), "no scene", None):
            with self.subTest(text):
                scene.write_text(text) if text else scene.unlink()
                message = self.expect(6, self.scene, *QUIET, "--restart", "auto", sets=changed).stderr
                self.assertTrue(message.endswith("it belongs to another scene\n"), message)
        self.expect(0, self.scene, *QUIET, "--restart", "auto", sets=[*sets, "run.cfl=0.2", "run.end_time=0.6"])
