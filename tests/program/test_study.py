# ctest-label: no-sanitizer
"""Option --study: tables of errors and times over meshes and schemes."""

import signal
import subprocess
import time

import gas_program
import parachute_program
import springs_program


class StudyTest(gas_program.GasTest):
    def study(self, code, scene, lists, *words, sets=()):
        run = super().study(scene, lists, "--backend", "serial", *words, sets=sets)
        self.assertEqual(code, run.returncode, run.stderr)
        return run

    def tables(self, directory):
        return self.table(f"{directory}/study.csv"), self.document(f"{directory}/study.json")

    def assert_interrupted(self, scene, lists, sets, begun):
        line = gas_program.arguments(scene, "--backend", "serial", "--study", lists, "--out", "study", sets=sets,
                                     program=self.program)
        process = subprocess.Popen(line, cwd=self.folder, env=gas_program.ENVIRONMENT, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        begun(process)
        process.send_signal(signal.SIGINT)
        text = process.communicate(timeout=60)
        self.assertEqual(130, process.returncode, text)
        self.assertRegex(text[1], r"interrupted by a signal; the tables hold the finished points, and --overwrite begins the study anew\n$")


class GasStudy(StudyTest):
    def test_writes_one_row_per_point(self):
        text = self.study(0, "sod", "meshes=50:100,schemes=js:z").stdout
        rows, document = self.tables("out/sod-study")
        self.assertEqual(4, len([line for line in text.splitlines() if "L1 density" in line]))
        self.assertEqual([("js", "50"), ("js", "100"), ("z", "50"), ("z", "100")],
                         [(row["weno"], row["cells"]) for row in rows])
        for row, entry in zip(rows, document["rows"], strict=True):
            self.assertEqual(("ok", "serial"), (row["status"], row["backend"]))
            self.assertGreater(float(row["compute_s"]), 0.0)
            self.assertLess(float(row["conservation"]), 1e-12)
            self.assertEqual(int(row["steps"]), entry["steps"])
            self.assertAlmostEqual(float(row["l1_density"]), entry["errors"]["l1_density"], places=8)
            self.assertTrue(entry["samples"])
        errors = {(row["weno"], row["cells"]): float(row["l1_density"]) for row in rows}
        self.assertLess(errors["z", "100"], errors["z", "50"])
        self.assertLess(errors["z", "100"], errors["js", "100"])
        self.assertEqual("drogue.study/1", document["schema"])

    def test_row_equals_the_single_run(self):
        self.study(0, "sod", "meshes=100,schemes=js,splittings=lf-global,times=ssprk43", "--quiet")
        row, = self.tables("out/sod-study")[0]
        self.expect(0, "sod", "--backend", "serial", sets=[
            "mesh.cells=100", 'scheme.weno="js"', 'scheme.splitting="lf-global"', 'scheme.time="ssprk43"',
            "verify.l1_density=1.0", gas_program.NO_FIELDS])
        reported = self.result("out/sod")
        self.assertEqual(reported["steps"], int(row["steps"]))
        self.assertAlmostEqual(reported["errors"]["l1_density"], float(row["l1_density"]), places=8)

    def test_two_meshes_make_a_doubling_sequence(self):
        self.study(0, "toro-1", "meshes=20:100", "--quiet")
        self.assertEqual(["20", "40", "80", "100"], [row["cells"] for row in self.tables("out/toro-1-study")[0]])

    def test_failed_scheme_is_listed_as_a_row(self):
        self.study(0, "mach-2000", "schemes=js:teno5", "--out", "study", "--quiet",
                   sets=['scheme.positivity="off"', "scheme.cfl=0.6", "mesh.cells=100"])
        rows, document = self.tables("study")
        self.assertEqual(["ok", "numerical-failure"], [row["status"] for row in rows])
        self.assertEqual("", rows[1]["l1_density"])
        self.assertIn("not positive", document["rows"][1]["message"])

    def test_rejects_invalid_points_before_the_first_run(self):
        message = self.study(3, "shu-osher", "meshes=100:12800", "--out", "study").stderr
        self.assertIn("verify.reference.cells", message)
        self.assertFalse((self.folder / "study").exists())

    def test_rejects_a_scene_without_exact_solution(self):
        self.assertIn("[verify] exact", self.study(2, "sedov", "meshes=101:201").stderr)

    def test_check_refuses_what_a_study_does(self):
        for lists, words in (("nonsense", "unknown name 'nonsense'; valid names are meshes, schemes"), ("meshes=50,", "a part is empty"),
                             ("meshes=50:", "'' is not an integer"), ("scheme=js", 'did you mean "schemes"?'), ("schemes=jz", "unknown name 'jz'")):
            for check in ((), ("--check",), ("--check", "--quiet"), ("--print-scene",)):
                with self.subTest(lists, check=check):
                    self.assertIn(words, self.study(2, "sod", lists, *check).stderr)
        self.assertIn("verify.reference.cells", self.study(3, "shu-osher", "meshes=100:12800", "--check").stderr)

    def test_rejects_an_existing_study(self):
        self.study(0, "sod", "meshes=50", "--quiet")
        self.study(2, "sod", "meshes=50", "--quiet")
        self.study(0, "sod", "meshes=50", "--quiet", "--overwrite")

    def test_rejects_a_study_of_the_baseline(self):
        self.study(2, "sod", "meshes=50", "--seed-mode")

    def test_ctrl_c_keeps_finished_rows(self):
        self.assert_interrupted("sod", "meshes=50:6400", ["verify.l1_density=1.0"],
                                lambda process: process.stdout.readline())
        rows = self.tables("study")[0]
        self.assertTrue(1 <= len(rows) < 8, rows)
        self.assertTrue(all(row["status"] == "ok" for row in rows))

    def test_ctrl_c_stops_the_reference_run(self):
        def begun(process):
            while process.poll() is None and not (self.folder / "study/scene.toml").exists():
                time.sleep(0.002)
            time.sleep(0.2)

        self.assert_interrupted("blast", "meshes=50", [], begun)

    def test_reports_a_study_without_successful_runs(self):
        text = self.study(4, "blast", "meshes=100,schemes=z:teno5",
                          sets=['scheme.positivity="off"', "verify.reference.cells=800"]).stderr
        self.assertIn("every run of the study failed", text)
        self.assertEqual(2, len(self.tables("out/blast-study")[0]))

    def test_rejects_a_repeated_axis(self):
        self.assertIn("twice", self.study(2, "sod", "meshes=50,meshes=100").stderr)


class SpringsStudy(springs_program.SpringsTest, StudyTest):
    VERIFY = "verify={frequency={mode=[0,1],tolerance=1},energy_drift=1}"
    LEVEL = "load=[{gravity=[0,0,0]}]"

    def difference(self, coarse, fine, name):
        """Mean over time of the difference of two series, as in the table."""
        time, first, second = coarse["series"]["time"], coarse["series"][name], fine["series"][name]
        self.assertEqual(time, fine["series"]["time"])
        apart = [abs(a - b) for a, b in zip(first, second, strict=True)]
        return sum((apart[k - 1] + apart[k]) / 2 * (time[k] - time[k - 1]) for k in range(1, len(time))) / (time[-1] - time[0])

    def test_writes_one_row_per_point(self):
        scene = self.write(springs_program.DRUM)
        lists = "meshes=61:244,models=quadratic,masses=area:equal,integrators=verlet"
        text = self.study(0, scene, lists, sets=[self.VERIFY, self.LEVEL]).stdout
        self.assertEqual(6, text.count(" vertices "))
        rows, document = self.tables("out/scene-study")
        self.assertEqual([(mass, count) for mass in ("area", "equal") for count in ("61", "127", "217")],
                         [(row["mass"], row["vertices"]) for row in rows])
        errors = {(row["mass"], row["vertices"]): float(row["frequency"]) for row in rows}
        self.assertLess(errors["area", "217"], 0.4 * errors["area", "61"])
        self.assertLess(errors["area", "217"], 0.2 * errors["equal", "217"])
        for k, (row, entry) in enumerate(zip(rows, document["rows"], strict=True)):
            self.assertEqual(("ok", "quadratic", "verlet", "serial"),
                             tuple(row[name] for name in ("status", "model", "integrator", "backend")))
            self.assertGreater(float(row["compute_s"]), 0.0)
            self.assertLess(float(row["energy_drift"]), 1e-2)
            self.assertEqual(int(row["steps"]), entry["steps"])
            for name in ("area", "kinetic", "elastic"):
                if k % 3 == 2:
                    self.assertEqual("", row["cauchy_" + name])
                    continue
                expected = self.difference(entry, document["rows"][k + 1], name)
                self.assertGreater(expected, 0.0)
                self.assertAlmostEqual(1.0, float(row["cauchy_" + name]) / expected, places=8)
        self.assertEqual(("drogue.study/1", "drogue-springs"), (document["schema"], document["program"]))
        self.assertFalse((self.folder / "out/scene-study/point").exists())
        self.assert_a_row_is_the_run_it_stands_for(scene, document["rows"][4])

    def assert_a_row_is_the_run_it_stands_for(self, scene, row):
        self.expect(0, scene, "--backend", "serial", "--out", "run", "--quiet", sets=[
            self.VERIFY, self.LEVEL, "mesh.disk.vertices=127", 'material.model="quadratic"', 'material.mass="equal"',
            'time.integrator="verlet"'])
        reported = self.result("run")
        self.assertEqual(reported["steps"], row["steps"])
        self.assertEqual(reported["errors"], {name: row["errors"][name] for name in reported["errors"]})
        self.assertEqual([0.1, 0.3], row["series"]["time"])
        self.assertEqual(self.history("run")["kinetic"][-1], row["series"]["kinetic"][-1])

    def test_accepts_a_scene_without_closed_form_or_times(self):
        self.study(0, self.write('app = "springs"\n[mesh]\nstring = { vertices = 5 }\n[initial]\nvelocity = { y = "sin(pi*x)" }\n'
                                 '[[pin]]\nwhere = "x == 0 || x == 1"\n[time]\nend_time = 0.001\n'), "meshes=5:20", "--quiet")
        rows, document = self.tables("out/scene-study")
        self.assertEqual(["5", "10", "20"], [row["vertices"] for row in rows])
        self.assertLess(float(rows[1]["cauchy_kinetic"]), float(rows[0]["cauchy_kinetic"]))
        self.assertEqual(101, len(document["rows"][0]["series"]["length"]))
        self.assertNotIn("cauchy_area", rows[0])

    def test_strings_beside_cloth_are_equal_in_every_model(self):
        """The string limits the time step, so that a change of its mass or stiffness would change the number of steps."""
        self.write("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nv 0 0 -0.01\nv 0 0 -0.02\n"
                   "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nl 1 6 7\n", "m.obj")
        scene = self.write('app = "springs"\n[mesh]\nfile = "m.obj"\n[material]\nmembrane_modulus = 20\npoisson = 0\n'
                           'line_density = 0.3\naxial_stiffness = 50\n[time]\nend_time = 2\n')
        text = self.study(0, scene, "models=edge:biquadratic", "--quiet").stderr
        steps = [entry["steps"] for entry in self.tables("out/scene-study")[1]["rows"]]
        self.assertEqual(2, len(steps))
        self.assertEqual(steps[0], steps[1])
        self.assertGreater(steps[0], 1000)
        self.assertNotIn("it is empty", text)

    def test_failed_mesh_is_listed_as_a_row(self):
        scene = self.write(springs_program.DRUM)
        self.study(0, scene, "meshes=61:817", "--out", "study", "--quiet", sets=["time.dt=0.0008"])
        rows, document = self.tables("study")
        self.assertEqual(("ok", "numerical-failure"), (rows[0]["status"], rows[-1]["status"]))
        self.assertEqual(("", ""), (rows[-1]["cauchy_area"], rows[-2]["cauchy_area"]))
        self.assertRegex(document["rows"][-1]["message"], r"oscillations of the cloth at \S+ rad/s are unstable at step 0, t = 0 s; take a shorter time.dt, or \"auto\"$")
        self.assertFalse(list((self.folder / "study").rglob("restart.h5")))
        text = self.study(4, scene, "meshes=61:127", "--out", "none", sets=["time.dt=0.01", "time.end_time=10"]).stderr
        self.assertIn("every run of the study failed", text)
        self.assertEqual(2, len(self.tables("none")[0]))

    def test_reports_usage_errors(self):
        scene = self.write(springs_program.DRUM)
        for lists in ("meshes=1", "meshes=a", "models=weno", "cells=10", "meshes=", "masses", "integrators=rk5", "",
                      "meshes=61,meshes=217"):
            with self.subTest(lists):
                self.assertIn("--study", self.study(2, scene, lists).stderr)
        self.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj")
        scene = self.write('app = "springs"\n[mesh]\nfile = "m.obj"\n[time]\nend_time = 1\n')
        self.assertIn("m.obj", self.study(2, scene, "meshes=61:217").stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_reports_checks_without_a_value(self):
        line = self.study(4, "chain", "meshes=10", sets=["time.end_time=0.01"])
        self.assertNotIn("nan", line.stdout)
        row = self.tables("out/chain-study")[1]["rows"][0]
        self.assertEqual("verification-failed", row["status"])
        self.assertEqual("verify.frequency has no finite value on this mesh: a probe may be at a pinned vertex", row["message"])

    def test_rejects_invalid_points_before_the_first_run(self):
        message = self.study(3, "drum", "models=quadratic:edge").stderr
        self.assertIn("verify.frequency.mode", message)
        self.assertFalse((self.folder / "out").exists())

    def test_ctrl_c_keeps_finished_rows(self):
        self.assert_interrupted(self.write(springs_program.DRUM), "meshes=61:15616", ["time.end_time=2"],
                                lambda process: process.stdout.readline())
        rows = self.tables("study")[0]
        self.assertTrue(1 <= len(rows) < 9, rows)
        self.assertTrue(all(row["status"] == "ok" for row in rows))
        self.assertEqual({"study.csv", "study.json", "scene.toml"}, {file.name for file in (self.folder / "study").iterdir()})


class SizeOfAStudy(gas_program.GasTest):
    def check(self, program, scene, lists, sets=()):
        """What `--check` prints, in some seconds; all the meshes would take minutes."""
        run = gas_program.run(scene, "--study", lists, "--check", sets=sets, cwd=self.folder, program=gas_program.BIN / program, timeout=60)
        self.assertEqual(0, run.returncode, run.stderr)
        return run.stdout

    def test_check_makes_no_large_mesh(self):
        schemes = "schemes=js:z:z2:m:teno5,splittings=lf-global:lf-single:lf-stencil,times=ssprk3:ssprk43"
        self.assertIn("study        780 runs on up to 268435456 cells\n", self.check("drogue-gas", "sod", f"meshes=8:268435456,{schemes}"))
        self.assertIn("study        on up to 16777216 vertices; a mesh of more than 65536 is checked with so many\n",
                      self.check("drogue-springs", "drum", "meshes=61:16777216,models=quadratic:biquadratic,masses=area:equal"))
        self.assertRegex(self.check("drogue-parachute", "taylor-green-2d", "meshes=16:4096,advections=central:weno-js:weno-z,times=ab2:rk3"),
                         r"\nstudy        54 runs on up to 4096 x 4096 x 1 cells, \S+ MiB for their arrays\n")
        gust = self.write(parachute_program.GUST)
        self.assertRegex(self.check("drogue-parachute", gust, "ensemble=8,cells=1:10", ["grid.cells=[120,100,80]", "run.dt=1e-4"]),
                         r"\n +1200 x 1000 x 800 cells, a run about ")


class ReferenceOfARun(gas_program.GasTest):
    def test_ctrl_c_stops_the_reference_of_a_run(self):
        """The interrupted reference leaves a complete run; its continuation verifies it."""
        sets = ["mesh.cells=50", "verify.l1_density=10.0"]
        line = gas_program.arguments("blast", "--backend", "serial", "--quiet", "--out", "run", sets=sets)
        process = subprocess.Popen(line, cwd=self.folder, env=gas_program.ENVIRONMENT)
        history = self.folder / "run/history.csv"
        while process.poll() is None and not (history.exists() and "\n0.038," in history.read_text()):
            time.sleep(0.005)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(130, process.wait(timeout=60))
        reported = self.result("run")
        self.assertEqual(("interrupted", 0.038, []), (reported["status"], reported["time"], reported["checks"]))
        before = history.read_text()
        self.expect(0, "blast", "--backend", "serial", "--quiet", "--out", "run", "--restart", "auto",
                    sets=[*sets, "verify.reference.cells=400"])
        self.assertEqual(before, history.read_text())
        self.assertEqual(2, len(self.result("run")["checks"]))
