# ctest-label: no-sanitizer
"""Option --study with an ensemble: perturbed runs on two grids, their error bars, failures and continuation."""

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

    def by_folder(self):
        return {row["folder"]: {name: value for name, value in row.items() if name != "wall_s"} for row in self.rows()}

    def file_of(self, folder):
        return (self.folder / "study" / folder / "result.json").read_bytes()

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
        while process.poll() is None and not (self.folder / "study" / file).exists() and time.monotonic() < limit:
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(130, process.returncode, err)
        return out, err

    def test_ctrl_c_in_a_run_speaks_of_no_restart(self):
        out, err = self.interrupted("ensemble=2,jobs=1", "cells-1/seed-1/history.csv", [*SHORT, "run.end_time=100"])
        self.assertRegex(out, r"^cells-1/seed-1 +1 of 2  interrupted, \d+ steps in \S+ s\n")
        self.assertNotIn("restart", out + err)
        self.assertIn("the same command runs the others", err)
        self.assertEqual([], list((self.folder / "study").rglob("*.log")), "no run was wrong")

    def test_the_same_command_goes_on_after_ctrl_c(self):
        lists = "ensemble=8,jobs=2"
        out, err = self.interrupted(lists, "cells-1/seed-1/result.json", SHORT)
        self.assertRegex(err, r": interrupted by a signal; the tables hold the finished runs, and the same command runs the others\n$")
        study = self.result("study")
        self.assertEqual(("interrupted", 0, 8), (study["status"], study["study"]["failed"], study["study"]["runs"]))
        finished = study["study"]["finished"]
        self.assertTrue(1 <= finished < 8, finished)
        self.assertEqual(finished, [row["status"] for row in self.rows()].count("ok"))
        self.assertRegex(out, rf"\n\w+: {finished} of 8 runs in ")
        self.assertIsInstance(study["study"]["canopy_0_peak_line_force"], float)
        kept = {row["folder"]: self.file_of(row["folder"]) for row in self.rows() if row["status"] == "ok"}
        again = self.study(0, lists, sets=SHORT).stdout
        self.assertTrue(again.startswith(f"{finished} of 8 runs were there already; --overwrite runs them anew\n"), again)
        self.assertEqual(8 - finished, again.count(" steps in "))
        self.assertEqual(kept, {folder: self.file_of(folder) for folder in kept})
        continued, results = self.by_folder(), self.result("study")["study"]
        self.study(0, lists, "--quiet", "--overwrite", sets=SHORT)
        self.assertEqual(self.by_folder(), continued, "as the study that nothing interrupted")
        self.assertEqual(self.result("study")["study"], results)

    def test_crashes_and_more_runs_keep_what_is_finished(self):
        self.study(0, "ensemble=2", "--quiet", sets=SHORT)
        (self.folder / "study/result.json").unlink()
        (self.folder / "study/cells-1/seed-2/result.json").unlink()
        before, kept = self.by_folder(), self.file_of("cells-1/seed-1")
        self.assertIn("1 of 3 runs were there already", self.study(0, "ensemble=3", sets=SHORT).stdout)
        self.assertEqual(kept, self.file_of("cells-1/seed-1"))
        self.assertEqual(before, {folder: row for folder, row in self.by_folder().items() if folder != "cells-1/seed-3"})
        self.assertRegex(self.study(0, "ensemble=3", sets=SHORT).stdout, r"^3 of 3 runs were there already; .*\n\w+: 3 of 3 runs in ")

    def test_refuses_finished_runs_of_another_scene_or_program(self):
        self.study(0, "ensemble=1", "--quiet", sets=SHORT)
        kept = {path: path.read_bytes() for path in (self.folder / "study").rglob("*.*")}
        refusal = self.study(2, "ensemble=2", sets=[*SHORT, "run.end_time=0.2"]).stderr
        self.assertIn("'study/cells-1/seed-1' holds a run of another scene: run.end_time was 0.1 and is 0.2; choose another --out, "
                      "or give --overwrite to run all anew", refusal)
        self.assertIn("another scene: canopy[0].perturbation", self.study(2, "ensemble=1,cells=1:2", sets=SHORT).stderr)
        self.assertEqual(kept, {path: path.read_bytes() for path in kept})
        result = self.folder / "study/cells-1/seed-1/result.json"
        result.write_text(result.read_text(encoding="utf-8").replace('"git": "', '"git": "0'), encoding="utf-8")
        self.assertRegex(self.study(2, "ensemble=1", sets=SHORT).stderr, r"holds a run of another program: version \S+ of commit 0\S*, not \S+ of ")
        self.study(0, "ensemble=1", "--quiet", "--overwrite", sets=[*SHORT, "run.end_time=0.2"])

    @staticmethod
    def plate(low):
        """A square of 8 x 8 squares normal to x, as OBJ."""
        vertices = [f"v 0 {low + 0.05 * j} {low + 0.05 * k}\n" for k in range(9) for j in range(9)]
        corners = [1 + j + 9 * k for k in range(8) for j in range(8)]
        return "".join(vertices + [f"f {i} {i + 1} {i + 10}\nf {i} {i + 10} {i + 9}\n" for i in corners])

    def test_refuses_finished_runs_of_another_mesh_file(self):
        self.write(self.plate(0.2), "plate.obj")
        scene = self.write(parachute_program.PLATE.split("[[body]]")[0] + '[[body]]\nkind = "file"\nfile = "plate.obj"\ncentre = [0.8, 0, 0]\n'
                           "[run]\nend_time = 0.1\nmax_dt = 0.01\n")
        self.study(0, "ensemble=1", "--quiet", scene=scene)
        self.write(self.plate(0.21), "plate.obj")
        self.assertIn("holds a run of another scene: a mesh file has changed;", self.study(2, "ensemble=1", scene=scene).stderr)

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
        for lists, words in (("ensemble=0", "ensemble=0 is not an integer"), ("ensemble=2,meshes=8", "meshes cannot be combined with ensemble, cells and jobs"),
                             ("cells=0.1:1", "grid.cells"), ("ensembel=2", 'did you mean "ensemble"?'), ("ensemble=2,", "a part is empty"),
                             ("meshes=8:16", "verify.exact")):
            for check in ((), ("--check",), ("--check", "--quiet")):
                with self.subTest(lists, check=check):
                    self.assertIn(words, self.study(2, lists, *check).stderr)
                    self.assertFalse((self.folder / "study").exists())

    def test_a_run_of_another_kind_is_kept(self):
        self.assertEqual(0, self.start(self.write(parachute_program.CANOPY), "--backend", "serial", "--quiet", "--out", "study", sets=SHORT).returncode)
        self.assertIn("already holds a run", self.study(2, "ensemble=1", sets=SHORT).stderr)


