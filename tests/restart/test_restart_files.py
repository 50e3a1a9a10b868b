"""Rejected restart files, and permitted changes between a run and its continuation."""

import fcntl
import os

import gas_program

SETS = ["mesh.cells=200", "output.restart_every=25", "output.times=[0.1, 0.2]", "run.end_time=0.2",
        "verify.l1_density=1.0"]


class RestartFiles(gas_program.GasTest):
    def setUp(self):
        super().setUp()
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "run", sets=SETS)
        self.file = self.folder / "run/restart.h5"
        self.bytes = self.file.read_bytes()

    def resume(self, code, *words, scene="sod", sets=SETS):
        words = words or ("--restart", "auto")
        return self.expect(code, scene, "--quiet", "--backend", "serial", "--out", "run", *words, sets=sets).stderr

    def assert_refused(self, word, scene="sod", sets=SETS):
        kept = self.contents()
        message = self.resume(6, scene=scene, sets=sets)
        self.assertIn("restart.h5", message)
        self.assertIn(word, message)
        self.assertEqual(kept, self.contents())

    def contents(self, directory="run"):
        """Contents of all files by name."""
        return {file.name: file.read_bytes() for file in (self.folder / directory).iterdir()}

    def test_rejects_truncated_files(self):
        for length in (len(self.bytes) - 1, len(self.bytes) // 2, 600, 512):
            with self.subTest(length):
                self.file.write_bytes(self.bytes[:length])
                self.assert_refused("truncated")

    def test_rejects_files_that_are_no_restart_file(self):
        for content in (b"", b"x", b"time [s]\n0\n" * 100, bytes(range(256)) * 64, self.bytes[:100],
                        (self.folder / "run/fields.h5").read_bytes()):
            with self.subTest(length=len(content)):
                self.file.write_bytes(content)
                self.assert_refused("restart file")

    def test_rejects_damaged_files(self):
        for place in (513, 2048, len(self.bytes) - 1):
            with self.subTest(place):
                damaged = bytearray(self.bytes)
                damaged[place] ^= 0x10
                self.file.write_bytes(damaged)
                self.assert_refused("damaged")

    def test_rejects_a_later_format(self):
        self.file.write_bytes(self.bytes.replace(b"drogue.restart/1", b"drogue.restart/2", 1))
        self.assert_refused("drogue.restart/2")

    def test_rejects_another_scene(self):
        self.assert_refused("another scene", scene="toro-1",
                            sets=["run.end_time=0.1", "output.times=[0.1]", "verify.l1_density=1.0"])

    def test_rejects_the_folder_of_another_run(self):
        words = ["--quiet", "--backend", "serial", "--out", "other"]
        self.expect(0, "sod", *words, sets=[*SETS, "mesh.cells=100"])
        names = ("history.csv", "fields.h5", "scene.toml", "result.json")
        before = [(self.folder / "other" / name).read_bytes() for name in names]
        message = self.expect(2, "sod", *words, "--restart", "run/restart.h5", sets=SETS).stderr
        self.assertIn("'other' holds a run of another scene; choose another --out", message)
        self.assertEqual(before, [(self.folder / "other" / name).read_bytes() for name in names])
        later = [*SETS, "run.end_time=0.25", "output.times=[0.1, 0.2, 0.25]"]
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "new", "--restart", "run/restart.h5", sets=later)
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "new", "--restart", "run/restart.h5", sets=later)

    def test_rejects_another_scheme_or_mesh(self):
        for change in ("mesh.cells=100", 'scheme.weno="js"', "scheme.cfl=0.5", "gas.gamma=1.3",
                       'boundary.left="reflecting"'):
            with self.subTest(change):
                self.assert_refused("another scene", sets=[*SETS, change])

    def test_rejects_an_end_time_that_has_passed(self):
        self.assert_refused(" s, later than run.end_time = 0.1", sets=[*SETS, "run.end_time=0.1", "output.times=[0.1]"])

    def test_reports_a_missing_file(self):
        self.assertIn("no/such.h5", self.resume(2, "--restart", "no/such.h5"))

    def test_reports_a_folder_instead_of_a_file(self):
        self.assertIn("'run'", self.resume(6, "--restart", "run"))

    def test_continues_a_named_file_in_a_new_directory(self):
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "new", "--restart", str(self.file), sets=SETS)
        old, new = self.folder / "run", self.folder / "new"
        last = gas_program.fields(old), gas_program.fields(new)
        for field in ("rho", "u", "p"):
            one, other = (file.datasets[f"/steps/{file.children('/steps')[-1]}/{field}"] for file in last)
            self.assertEqual(one, other)

    def test_continues_to_a_later_end_time(self):
        longer = [*SETS, "run.end_time=0.4", "output.times=[0.1, 0.2, 0.4]", "run.max_steps=5000"]
        self.resume(0, sets=longer)
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "whole", sets=longer)
        whole, part = self.folder / "whole", self.folder / "run"
        self.assertEqual(gas_program.fields(whole).datasets, gas_program.fields(part).datasets)
        self.assertEqual((whole / "history.csv").read_text(), (part / "history.csv").read_text())
        self.assertEqual(0.4, self.result("run")["time"])

    def test_finished_run_continues_to_a_later_end_time(self):
        """It equals a run with an output at the former end bit for bit: that run shortens the same steps."""
        sets = ["mesh.cells=200", "output.history_every=7", "verify.l1_density=1.0"]
        words = ["--quiet", "--backend", "serial", "--out"]
        longer = [*sets, "run.end_time=0.4", "output.times=[0.1, 0.2, 0.4]"]
        for words_of_run in ((), ("--seed-mode",)):
            with self.subTest(words_of_run):
                self.expect(0, "sod", *words, "part", "--overwrite", *words_of_run, sets=[*sets, "run.end_time=0.2", "output.times=[0.1, 0.2]"])
                self.expect(0, "sod", *words, "part", "--restart", "auto", *words_of_run, sets=longer)
                self.expect(0, "sod", *words, "whole", "--overwrite", *words_of_run, sets=longer)
                for name in ("history.csv", "fields.xdmf", "scene.toml"):
                    self.assertEqual((self.folder / "whole" / name).read_text(), (self.folder / "part" / name).read_text())
                whole, part = gas_program.fields(self.folder / "whole"), gas_program.fields(self.folder / "part")
                self.assertEqual(whole.datasets, part.datasets)
                for key in ("steps", "time", "dt_min", "dt_max", "errors", "checks", "limiter"):
                    self.assertEqual(self.result("whole")[key], self.result("part")[key], key)

    def test_end_of_a_continued_run_replaces_the_restart_file_of_the_former_end(self):
        """Also if the interval of restart files is longer than the run; the last file of an interval stays."""
        words = ["--quiet", "--backend", "serial", "--out"]
        sets = ["mesh.cells=200", "verify.l1_density=1.0", "output.times=[0.1, 0.2]"]
        self.expect(0, "sod", *words, "part", sets=[*sets, "run.end_time=0.1", "output.times=[0.1]"])
        self.expect(0, "sod", *words, "part", "--restart", "auto", sets=[*sets, "output.restart_every=1000", "run.end_time=0.2"])
        self.expect(0, "sod", *words, "whole", sets=[*sets, "run.end_time=0.2"])
        self.assertEqual(self.contents("whole")["restart.h5"], self.contents("part")["restart.h5"])
        self.resume(0)
        self.assertEqual(self.bytes, self.file.read_bytes())

    def test_refuses_to_continue_a_finished_run_without_a_restart_file(self):
        """It would begin anew, and its files would be lost."""
        sets = [*SETS, "output.restart_every=0"]
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "bare", sets=sets)
        before = self.contents("bare")
        later = [*sets, "run.end_time=0.25", "output.times=[0.1, 0.2, 0.25]"]
        for wanted in (sets, later):
            message = self.expect(2, "sod", "--quiet", "--backend", "serial", "--out", "bare", "--restart", "auto", sets=wanted).stderr
            self.assertIn("a finished run and no restart file", message)
            self.assertEqual(before, self.contents("bare"))

    def test_refuses_an_end_before_that_of_the_finished_run(self):
        """Without a restart file of its end, the former one lies before both."""
        later = ["run.end_time=0.25", "output.times=[0.1, 0.2, 0.25]", "output.restart_every=0"]
        self.resume(0, sets=[*SETS, *later])
        before = self.contents()
        message = self.resume(2, sets=[*SETS, *later, "run.end_time=0.22", "output.times=[0.1, 0.2, 0.22]"])
        self.assertIn("holds a run finished at t = 0.25 s, later than run.end_time = 0.22; choose another --out", message)
        self.assertEqual(before, self.contents())
        self.resume(0, sets=[*SETS, *later])

    def test_says_which_pictures_it_removes(self):
        for name in ("fields.png", "space_time_rho.png", "mine.png"):
            (self.folder / "run" / name).write_bytes(b"picture")
        self.assert_refused(" s, later than run.end_time = 0.1", sets=[*SETS, "run.end_time=0.1", "output.times=[0.1]"])
        done = gas_program.run("sod", "--quiet", "--backend", "serial", "--out", "run", "--restart", "auto", sets=SETS, cwd=self.folder)
        self.assertEqual((0, "drogue-gas: the run continues, and its former pictures are removed: fields.png, space_time_rho.png; "
                          "drogue-plot draws them again\n"), (done.returncode, done.stderr))
        self.assertNotIn("fields.png", self.contents())
        self.assertIn("mine.png", self.contents())

    def test_names_the_variable_that_locks_files(self):
        """A reader that locks fields.h5, as a viewer does while it has it open."""
        (self.folder / "run/fields.png").write_bytes(b"picture")
        later = [*SETS, "run.end_time=0.25", "output.times=[0.1, 0.2, 0.25]"]
        with open(self.folder / "run/fields.h5", "rb") as reader:
            fcntl.flock(reader, fcntl.LOCK_SH)
            before = self.contents()
            words = ["--quiet", "--backend", "serial", "--out", "run", "--restart", "auto"]
            message = self.expect(6, "sod", *words, sets=later, environment={"HDF5_USE_FILE_LOCKING": "TRUE"}).stderr
            self.assertIn("fields.h5", message)
            self.assertIn("HDF5_USE_FILE_LOCKING = TRUE", message)
            self.assertEqual(before, self.contents())
        (self.folder / "run/fields.png").unlink()
        self.resume(0, sets=later)

    def test_refuses_files_that_it_must_not_write(self):
        later = [*SETS, "run.end_time=0.25", "output.times=[0.1, 0.2, 0.25]"]
        for name in ("history.csv", "fields.h5"):
            with self.subTest(name):
                file = self.folder / "run" / name
                file.chmod(0o444)
                if os.access(file, os.W_OK):
                    self.skipTest("this user may write every file")
                before = self.contents()
                self.assertIn(f"{name}': Permission denied", self.resume(6, sets=later))
                self.assertEqual(before, self.contents())
                file.chmod(0o644)
        self.resume(0, sets=later)

    def test_continues_on_another_backend(self):
        self.expect(0, "sod", "--quiet", "--backend", gas_program.threaded(), "--out", "run", "--restart", "auto", sets=SETS)

    def test_rejects_other_fields(self):
        """fields.xdmf lists the same fields for all outputs."""
        for fields in ('["rho"]', '["rho", "u"]'):
            with self.subTest(fields):
                before = self.contents()
                message = self.resume(6, sets=[*SETS, f"output.fields={fields}"])
                self.assertEqual(before, self.contents())
                self.assertIn("fields.h5", message)
                self.assertIn("other fields", message)
        self.resume(0, sets=[*SETS, 'output.fields=["p", "u", "rho"]'])

    def test_refuses_output_times_that_have_passed_without_an_output(self):
        """The run would leave them out without a word."""
        end = "run.end_time=0.25"
        for times, missing in (("[0.05, 0.1, 0.15, 0.2, 0.25]", "0.05, 0.15:"), ("[0, 0.1, 0.2, 0.25]", "0.0:")):
            for words in (["--out", "run", "--restart", "auto"], ["--out", "new", "--restart", "run/restart.h5"]):
                with self.subTest(times=times, words=words):
                    before = self.contents()
                    message = self.expect(6, "sod", "--quiet", "--backend", "serial", *words,
                                          sets=[*SETS, end, f"output.times={times}"]).stderr
                    self.assertIn(f"output.times {missing}", message)
                    self.assertEqual(before, self.contents())
        self.resume(0, sets=[*SETS, end, "output.times=[0.2, 0.25]"])

    def test_run_that_continued_elsewhere_continues_there(self):
        """Its fields.h5 holds the outputs since then; those before lie in the other folder."""
        words = ["--quiet", "--backend", "serial", "--out", "new", "--restart"]
        later = [*SETS, "run.end_time=0.25", "output.times=[0.1, 0.2, 0.25]"]
        self.expect(0, "sod", *words, "run/restart.h5", sets=later)
        later = [*SETS, "run.end_time=0.3", "output.times=[0.1, 0.2, 0.25, 0.3]"]
        self.expect(0, "sod", *words, "auto", sets=later)
        written = gas_program.fields(self.folder / "new")
        times = [written.attributes[f"/steps/{name}"]["time"] for name in written.children("/steps")]
        self.assertEqual([0.2, 0.25, 0.3], times)
        (self.folder / "run/fields.h5").unlink()
        self.assertIn("output.times 0.1: the run continues", self.resume(6, sets=later))

    def test_restart_and_overwrite_exclude_each_other(self):
        self.resume(2, "--restart", "auto", "--overwrite")
