# ctest-label: no-sanitizer
"""Option --study with an ensemble: perturbed runs on two grids, their error bars, failures and interruption."""

import csv
import signal
import subprocess
import time

import gas_program
import parachute_program

SHORT = ["run.end_time=0.1", "output.times=[0.1]", "output.history_every=1"]


class Ensemble(gas_program.GasTest):
    program = parachute_program.PROGRAM

    def study(self, code, lists, *words, sets=(), scene=None):
        scene = scene or self.write(parachute_program.CANOPY)
        process = self.start(scene, "--backend", "serial", "--study", lists, "--out", "study", *words, sets=sets)
        self.assertEqual(code, process.returncode, process.stderr)
        return process

    def rows(self):
        with open(self.folder / "study/runs.csv", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_gives_error_bars(self):
        text = self.study(0, "ensemble=2,cells=0.8:1,jobs=2", sets=SHORT).stdout
        rows = self.rows()
        self.assertEqual({"cells-0.8/seed-1", "cells-0.8/seed-2", "cells-1/seed-1", "cells-1/seed-2"}, {row["folder"] for row in rows})
        name = "canopy_0.peak_line_force"
        values = {row["folder"]: float(row[name]) for row in rows}
        self.assertEqual(4, len(set(values.values())), "every run has its own start")
        study = self.result("study")["study"]
        self.assertEqual((4, 4, 0), (study["runs"], study["finished"], study["failed"]))
        fine = [values["cells-1/seed-1"], values["cells-1/seed-2"]]
        self.assertAlmostEqual(sum(fine) / 2, study["canopy_0_peak_line_force"], places=4)
        coarse = (values["cells-0.8/seed-1"] + values["cells-0.8/seed-2"]) / 2
        self.assertAlmostEqual(coarse, study["canopy_0_peak_line_force_coarse"], places=4)
        # Student's factor of two runs.
        self.assertAlmostEqual(12.706 * abs(fine[0] - fine[1]) / 2, study["canopy_0_peak_line_force_sampling"], delta=1e-3 * fine[0])
        self.assertGreater(study["canopy_0_peak_line_force_grid"], 1.5 * abs(sum(fine) / 2 - coarse) / 0.25)
        self.assertGreater(study["canopy_0_peak_line_force_error"], study["canopy_0_peak_line_force_grid"])
        self.assertRegex(text, r"\n  canopy\[0\] peak line force, N = \S+ \+- \S+ \(sampling \S+, grid \S+\); of a run: standard deviation \S+, "
                               r"5 to 95 % \S+ to \S+\n")
        self.assertRegex(text, r"\n  canopy\[0\] C_D0 = \S+ \+- \S+ \(sampling \S+, grid \S+\)\n")
        self.assertEqual([], list((self.folder / "study").rglob("*.log")), "nothing was wrong")

    def test_a_run_is_that_of_its_assignments(self):
        self.study(0, "ensemble=1,cells=1.25", "--quiet", sets=SHORT)
        row, = self.rows()
        resolved = (self.folder / "study" / row["folder"] / "scene.toml").read_text(encoding="utf-8")
        self.assertIn("cells = [25, 25, 38]", resolved)
        process = self.start(self.write(resolved, "again.toml"), "--backend", "serial", "--quiet", "--out", "again")
        self.assertEqual(0, process.returncode, process.stderr)
        again = self.result("again")["canopy_0"]
        for name in ("peak_line_force", "peak_line_force_time", "drag_coefficient"):
            self.assertAlmostEqual(1.0, float(row[f"canopy_0.{name}"]) / again[name], places=8)

    def test_failed_runs_cost_no_others(self):
        steps = self.steps_of("ensemble=1,cells=0.8:1")
        self.assertLess(steps["cells-0.8/seed-1"], steps["cells-1/seed-1"])
        limit = (steps["cells-0.8/seed-1"] + steps["cells-1/seed-1"]) // 2
        process = self.study(4, "ensemble=2,cells=0.8:1", "--overwrite", sets=[*SHORT, f"run.max_steps={limit}"])
        status = {row["folder"]: row["status"] for row in self.rows()}
        self.assertEqual({"cells-0.8/seed-1": "ok", "cells-0.8/seed-2": "ok", "cells-1/seed-1": "numerical-failure",
                          "cells-1/seed-2": "numerical-failure"}, status)
        self.assertRegex(process.stderr, r"2 of 4 runs failed, and the error bars lack them; 'study/cells-1/seed-1': run\.max_steps = \d+ reached")
        reported = self.result("study")
        self.assertEqual(("numerical-failure", 4), (reported["status"], reported["exit_code"]))
        self.assertEqual((4, 2, 2), tuple(reported["study"][key] for key in ("runs", "finished", "failed")))

    def steps_of(self, lists):
        self.study(0, lists, "--quiet", sets=SHORT)
        return {row["folder"]: int(row["steps"]) for row in self.rows()}

    def interrupted(self, lists, file, sets):
        """What a study prints that a signal ends once a file of it exists."""
        line = gas_program.arguments(self.write(parachute_program.CANOPY), "--backend", "serial", "--study", lists, "--out", "study",
                                     sets=sets, program=self.program)
        process = subprocess.Popen(line, cwd=self.folder, env=gas_program.ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        limit = time.monotonic() + 300
        while not (self.folder / "study" / file).exists() and time.monotonic() < limit:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(130, process.returncode, err)
        return out, err

    def test_ctrl_c_in_a_run_speaks_of_no_restart(self):
        out, err = self.interrupted("ensemble=2,jobs=1", "cells-1/seed-1/history.csv", [*SHORT, "run.end_time=100"])
        self.assertRegex(out, r"^cells-1/seed-1 +1 of 2  interrupted, \d+ steps in \S+ s\n")
        self.assertNotIn("restart", out + err)
        self.assertIn("--overwrite begins the study anew", err)
        self.assertEqual([], list((self.folder / "study").rglob("*.log")), "no run was wrong")

    def test_ctrl_c_keeps_finished_runs(self):
        out, err = self.interrupted("ensemble=40,jobs=2", "runs.csv", SHORT)
        self.assertRegex(err, r"interrupted by a signal; the tables hold the finished points, and --overwrite begins the study anew\n$")
        study = self.result("study")
        self.assertEqual(("interrupted", 0, 40), (study["status"], study["study"]["failed"], study["study"]["runs"]))
        finished = study["study"]["finished"]
        self.assertTrue(1 <= finished < 40, finished)
        self.assertEqual(finished, [row["status"] for row in self.rows()].count("ok"))
        self.assertRegex(out, rf"\n\w+: {finished} of 40 runs in ")
        self.assertIsInstance(study["study"]["canopy_0_peak_line_force"], float)

    def test_flow_without_sheets_has_its_checks(self):
        scene = self.write(parachute_program.PLATE + """[verify]
history = [{ column = "body_0_force_x", statistic = "mean", from = 0.1, value = 1, tolerance = 1e9 }]
""")
        self.study(0, "ensemble=2,cells=1:1.5", "--quiet", sets=["output.history_every=1"], scene=scene)
        study = self.result("study")["study"]
        self.assertNotIn("body_0_frontal_area", study)
        self.assertGreater(study["body_0_drag_coefficient_deviation"], 0.0)
        self.assertGreater(study["body_0_force_x_mean"], 0.0)
        self.assertLess(study["body_0_force_x_mean_deviation"], 0.01 * study["body_0_force_x_mean"])
        self.assertGreater(study["body_0_force_x_mean_deviation"], 0.0, "the runs differ")
        self.assertAlmostEqual(1.5, study["cells"] / study["coarse_cells"])

    def test_check_states_the_cost_and_runs_nothing(self):
        text = self.study(0, "ensemble=8,cells=1:1.5", "--check").stdout
        self.assertRegex(text, r"\nstudy        16 runs, 8 on each grid, \d+ at once here\n +20 x 20 x 30 cells, a run about .* on two cores, .* on one H200\n"
                               r" +30 x 30 x 45 cells, a run about .*\n +all about .* one after another\n$")
        self.assertFalse((self.folder / "study").exists())

    def test_reports_usage_errors(self):
        for lists, words in (("ensemble=0", "ensemble=0 is not an integer"), ("ensemble=2,meshes=8", "unknown name 'meshes'"),
                             ("cells=0.1:1", "grid.cells"), ("ensembel=2", 'did you mean "ensemble"?'), ("ensemble=2,", "a part is empty"),
                             ("meshes=8:16", "verify.exact")):
            for check in ((), ("--check",), ("--check", "--quiet")):
                with self.subTest(lists, check=check):
                    self.assertIn(words, self.study(2, lists, *check).stderr)
                    self.assertFalse((self.folder / "study").exists())

    def test_an_existing_study_is_kept(self):
        self.study(0, "ensemble=1", "--quiet", sets=SHORT)
        self.assertIn("already holds a run", self.study(2, "ensemble=1", sets=SHORT).stderr)


