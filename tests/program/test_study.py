"""--study: one table of errors and times over meshes and schemes."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import gas_program


class Study(gas_program.GasTest):
    def study(self, code, scene, lists, *words, sets=()):
        """Runs a study; that there is nothing here to draw pictures with is no failure."""
        run = self.start(scene, "--backend", "serial", "--study", lists, *words, sets=sets)
        self.assertEqual(code, run.returncode, run.stderr)
        return run

    def tables(self, directory):
        folder = self.folder / directory
        with (folder / "study.csv").open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        return rows, json.loads((folder / "study.json").read_text(encoding="utf-8"))

    def test_tables(self):
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

    def test_a_row_is_the_run_it_stands_for(self):
        self.study(0, "sod", "meshes=100,schemes=js,splittings=lf-global,times=ssprk43", "--quiet")
        row, = self.tables("out/sod-study")[0]
        self.expect(0, "sod", "--backend", "serial", sets=[
            "mesh.cells=100", 'scheme.weno="js"', 'scheme.splitting="lf-global"', 'scheme.time="ssprk43"',
            "verify.l1_density=1.0", gas_program.NO_FIELDS])
        told = self.result("out/sod")
        self.assertEqual(told["steps"], int(row["steps"]))
        self.assertAlmostEqual(told["errors"]["l1_density"], float(row["l1_density"]), places=8)

    def test_meshes_double(self):
        self.study(0, "toro-1", "meshes=20:100", "--quiet")
        self.assertEqual(["20", "40", "80", "100"], [row["cells"] for row in self.tables("out/toro-1-study")[0]])

    def test_a_scheme_that_fails_is_a_row(self):
        self.study(0, "mach-2000", "schemes=js:teno5", "--out", "study", "--quiet",
                   sets=['scheme.positivity="off"', "scheme.cfl=0.6", "mesh.cells=100"])
        rows, document = self.tables("study")
        self.assertEqual(["ok", "numerical-failure"], [row["status"] for row in rows])
        self.assertEqual("", rows[1]["l1_density"])
        self.assertIn("not positive", document["rows"][1]["message"])

    def test_what_cannot_be_run_is_found_first(self):
        message = self.study(3, "shu-osher", "meshes=100:12800", "--out", "study").stderr
        self.assertIn("verify.reference.cells", message)
        self.assertFalse((self.folder / "study").exists())

    def test_a_scene_without_errors(self):
        self.assertIn("[verify] exact", self.study(2, "sedov", "meshes=101:201").stderr)

    def test_existing_study_is_refused(self):
        self.study(0, "sod", "meshes=50", "--quiet")
        self.study(2, "sod", "meshes=50", "--quiet")
        self.study(0, "sod", "meshes=50", "--quiet", "--overwrite")

    def test_seed_mode_has_no_study(self):
        self.study(2, "sod", "meshes=50", "--seed-mode")

    def assert_interrupted(self, scene, lists, sets, begun):
        line = gas_program.arguments(scene, "--backend", "serial", "--study", lists, "--out", "study", sets=sets)
        process = subprocess.Popen(line, cwd=self.folder, env=gas_program.ENVIRONMENT, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        begun(process)
        process.send_signal(signal.SIGINT)
        text = process.communicate(timeout=60)
        self.assertEqual(130, process.returncode, text)

    def test_ctrl_c_keeps_the_rows_that_are_done(self):
        self.assert_interrupted("sod", "meshes=50:6400", ["verify.l1_density=1.0"],
                                lambda process: process.stdout.readline())
        rows = self.tables("study")[0]
        self.assertTrue(1 <= len(rows) < 8, rows)
        self.assertTrue(all(row["status"] == "ok" for row in rows))

    def test_ctrl_c_in_the_reference(self):
        def begun(process):
            while process.poll() is None and not (self.folder / "study/scene.toml").exists():
                time.sleep(0.002)
            time.sleep(0.2)

        self.assert_interrupted("blast", "meshes=50", [], begun)

    def test_nothing_succeeds(self):
        text = self.study(4, "blast", "meshes=100,schemes=z:teno5",
                          sets=['scheme.positivity="off"', "verify.reference.cells=400"]).stderr
        self.assertIn("every run of the study failed", text)
        self.assertEqual(2, len(self.tables("out/blast-study")[0]))

    def test_an_axis_named_twice(self):
        self.assertIn("twice", self.study(2, "sod", "meshes=50,meshes=100").stderr)


class ReferenceOfARun(gas_program.GasTest):
    def test_ctrl_c(self):
        """The run itself is done; continued, it is verified."""
        sets = ["mesh.cells=50", "verify.l1_density=10.0"]
        line = gas_program.arguments("blast", "--backend", "serial", "--quiet", "--out", "run", sets=sets)
        process = subprocess.Popen(line, cwd=self.folder, env=gas_program.ENVIRONMENT)
        history = self.folder / "run/history.csv"
        while process.poll() is None and not (history.exists() and "\n0.038," in history.read_text()):
            time.sleep(0.005)
        process.send_signal(signal.SIGTERM)
        self.assertEqual(130, process.wait(timeout=60))
        told = self.result("run")
        self.assertEqual(("interrupted", 0.038, []), (told["status"], told["time"], told["checks"]))
        before = history.read_text()
        self.expect(0, "blast", "--backend", "serial", "--quiet", "--out", "run", "--restart", "auto",
                    sets=[*sets, "verify.reference.cells=400"])
        self.assertEqual(before, history.read_text())
        self.assertEqual(2, len(self.result("run")["checks"]))


if __name__ == "__main__":
    unittest.main()
