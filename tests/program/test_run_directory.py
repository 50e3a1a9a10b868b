# ctest-label: no-sanitizer
"""Run directories: their files, treatment of former runs, and terminal output."""

import subprocess
import time

import gas_program

COARSE = ["mesh.cells=50", "verify.l1_density=1.0", "output.times=[0.4]"]
FILES = ["fields.h5", "fields.xdmf", "history.csv", "restart.h5", "result.json", "scene.toml"]
SHIPPED = gas_program.SOURCE / "miniapps/gas/scenes"


class Directory(gas_program.GasTest):
    def coarse(self, *words, code=0, scene="sod", sets=(), **settings):
        return self.expect(code, scene, "--backend", "serial", *words, sets=[*COARSE, *sets], **settings)

    def names(self, directory="out/sod"):
        return sorted(path.name for path in (self.folder / directory).iterdir())

    def test_default_directory_has_the_name_of_the_scene(self):
        self.coarse()
        self.assertEqual(FILES, self.names())
        self.assertEqual(["out"], [path.name for path in self.folder.iterdir()])

    def test_writes_no_fields_and_history_unless_requested(self):
        sets = [gas_program.NO_FIELDS, "output.history_every=0"]
        self.expect(0, "sod", "--backend", "serial", sets=sets)
        self.assertEqual(["restart.h5", "result.json", "scene.toml"], self.names())
        self.expect(0, "sod", "--backend", "serial", "--overwrite", sets=[*sets, "output.restart_every=0"])
        self.assertEqual(["result.json", "scene.toml"], self.names())

    def test_leaves_a_restart_file_whatever_the_interval(self):
        for interval in (20, 1000000):
            self.coarse("--overwrite", sets=[f"output.restart_every={interval}"])
            self.assertEqual(FILES, self.names())
        self.coarse("--overwrite", sets=["output.restart_every=0"])
        self.assertEqual([name for name in FILES if name != "restart.h5"], self.names())

    def test_scene_toml_reproduces_the_run(self):
        self.coarse()
        again = self.expect(0, self.folder / "out/sod/scene.toml", "--print-scene").stdout
        self.assertEqual((self.folder / "out/sod/scene.toml").read_text(), again)
        self.coarse("--out", "again", scene=self.folder / "out/sod/scene.toml")
        self.assertEqual(gas_program.fields(self.folder / "out/sod").datasets,
                         gas_program.fields(self.folder / "again").datasets)

    def test_rejects_an_existing_run(self):
        self.coarse()
        before = {name: (self.folder / "out/sod" / name).read_bytes() for name in FILES}
        self.assertIn("--overwrite", self.coarse(code=2).stderr)
        self.assertEqual(before, {name: (self.folder / "out/sod" / name).read_bytes() for name in FILES})

    def test_invalid_arguments_keep_the_former_run(self):
        self.coarse()
        before = {name: (self.folder / "out/sod" / name).read_bytes() for name in FILES}
        for words, code, sets in ((["--overwrite"], 3, ["mesh.cell=3"]), (["--restart", "auto"], 3, ["run.endtime=3"]),
                                  (["--overwrite", "--backend", "cuda"], 77, [])):
            with self.subTest(words):
                if code == 77 and "cuda" in self.expect(0, "--version").stdout.split("backends: ")[1].split("\n")[0]:
                    continue
                self.expect(code, "sod", *words, sets=[*COARSE, *sets])
                self.assertEqual(before, {name: (self.folder / "out/sod" / name).read_bytes() for name in FILES})

    def test_restart_auto_rejects_another_scene(self):
        self.coarse()
        for code, gone in ((6, []), (2, ["restart.h5"])):
            for name in gone:
                (self.folder / "out/sod" / name).unlink()
            before = {name: (self.folder / "out/sod" / name).read_bytes() for name in self.names()}
            text = self.expect(code, "lax", "--backend", "serial", "--restart", "auto", "--out", "out/sod").stderr
            self.assertIn("another scene", text)
            self.assertEqual(before, {name: (self.folder / "out/sod" / name).read_bytes() for name in self.names()})

    def test_overwrite_removes_only_the_former_run(self):
        self.coarse(sets=["output.restart_every=20"])
        (self.folder / "out/sod/notes.txt").write_text("mine")
        for name in ("profiles.png", "forces.pdf", "canopies.svg", "spectrum.png", "space_time_rho.png", "fields.mp4"):
            (self.folder / "out/sod" / name).write_text("of the former run")
        self.expect(0, "sod", "--backend", "serial", "--overwrite", sets=[gas_program.NO_FIELDS])
        self.assertEqual(["history.csv", "notes.txt", "restart.h5", "result.json", "scene.toml"], self.names())

    def test_accepts_a_directory_with_foreign_files(self):
        (self.folder / "there").mkdir()
        (self.folder / "there/notes.txt").write_text("mine")
        self.coarse("--out", "there")
        self.assertEqual(sorted([*FILES, "notes.txt"]), self.names("there"))

    def test_invalid_scene_writes_a_result_that_may_be_replaced(self):
        self.coarse(code=3, sets=["mesh.cells=7"])
        self.assertEqual(["result.json"], self.names())
        self.assertEqual(("invalid", 3), (self.result("out/sod")["status"], self.result("out/sod")["exit_code"]))
        self.coarse()

    def test_accepts_unusual_paths(self):
        (self.folder / "real").mkdir()
        (self.folder / "link").symlink_to(self.folder / "real", target_is_directory=True)
        spaces = self.folder / "my scenes (1)"
        spaces.mkdir()
        scene = spaces / "shock tube é.toml"
        scene.write_bytes((SHIPPED / "sod.toml").read_bytes())
        self.coarse("--out", "link/run")
        self.assertEqual(FILES, self.names("real/run"))
        self.coarse("--out", "a/b/../c/./d/")
        self.assertEqual(FILES, self.names("a/c/d"))
        self.coarse("--out", "with space/ü", scene="my scenes (1)/shock tube é.toml")
        self.assertEqual("shock tube é", self.result("with space/ü")["scene"])
        self.coarse(scene=scene)
        self.assertEqual(FILES, self.names("out/shock tube é"))

    def test_runs_from_another_folder(self):
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        run = gas_program.run("sod", "--backend", "serial", "--out", ".", sets=COARSE, cwd=elsewhere)
        self.assertEqual(0, run.returncode, run.stderr)
        self.assertEqual(FILES, self.names("elsewhere"))

    def test_fields_xdmf_uses_relative_paths(self):
        self.coarse()
        self.assertNotIn(str(self.folder), (self.folder / "out/sod/fields.xdmf").read_text())

    def test_reports_a_file_in_place_of_the_directory(self):
        (self.folder / "file").write_text("")
        self.assertIn("file", self.coarse("--out", "file", code=6).stderr)
        self.assertIn("file", self.coarse("--out", "file/below", code=6).stderr)

    def test_rejects_a_directory_in_use(self):
        slow = ["mesh.cells=6400", gas_program.NO_FIELDS]
        line = gas_program.arguments("sod", "--backend", "serial", "--quiet", "--out", "run", sets=slow)
        first = subprocess.Popen(line, cwd=self.folder, env=gas_program.ENVIRONMENT, stderr=subprocess.PIPE, text=True)
        while first.poll() is None and not (self.folder / "run/history.csv").exists():
            time.sleep(0.002)
        second = self.coarse("--out", "run", "--overwrite", code=6)
        self.assertIsNone(first.poll(), "the first run ended before the second began")
        first.terminate()
        message = first.communicate(timeout=60)[1]
        self.assertEqual(130, first.returncode)
        self.assertIn("in use", second.stderr)
        self.assertEqual("interrupted", self.result("run")["status"])
        self.assertEqual(f"drogue-gas: {self.result('run')['message']}\n", message)
        self.assertIn("continue with --restart auto", message)


class Output(gas_program.GasTest):
    def test_prints_a_summary(self):
        text = self.expect(0, "sod", "--backend", "serial", sets=COARSE).stdout
        for word in ("sod on serial", "steps", "l1_density", "tolerance 1", "passed", "conservation", "out/sod"):
            self.assertIn(word, text)

    def test_quiet_prints_nothing(self):
        run = self.expect(0, "sod", "--quiet", sets=COARSE)
        self.assertEqual(("", ""), (run.stdout, run.stderr))

    def test_quiet_runs_report_failures(self):
        self.expect(3, "sod", "--quiet", sets=["mesh.cells=7"])

    def test_pipe_shows_no_progress(self):
        run = self.expect(0, "sod", "--backend", "serial", sets=["mesh.cells=800", gas_program.NO_FIELDS])
        self.assertNotIn("\r", run.stdout + run.stderr)
        self.assertNotIn("ETA", run.stdout + run.stderr)

    def short_run(self, *words):
        """Terminal output of a short run."""
        return self.terminal("sod", "--backend", "serial", "--out", "run", "--overwrite", *words,
                             sets=["mesh.cells=1600", gas_program.NO_FIELDS])

    def test_terminal_shows_one_progress_line(self):
        shown = self.short_run()
        self.assertIn("ETA", shown)
        self.assertIn("steps/s", shown)
        progress = [line for line in shown.split("\n") if "ETA" in line]
        self.assertEqual(1, len(progress), "progress stays on one line")
        self.assertIn("\r", progress[0])

    def test_quiet_terminal_shows_nothing(self):
        self.assertEqual("", self.short_run("--quiet"))
