# ctest-label: no-sanitizer
"""Springs runs that are killed or interrupted and continued equal uninterrupted runs bit for bit."""

import random
import shutil
import signal
import time

import gas_program
import springs_program

SETS = ["mesh.disk.vertices=271", "time.end_time=2.5", "output.times=[0.6, 1.3, 2.5]", "output.restart_every=50"]


class Restart(springs_program.SpringsTest):
    def setUp(self):
        super().setUp()
        self.random = random.Random(self.id())
        self.scene = self.write(springs_program.DRUM)

    def begin(self, backend, *words, sets=SETS):
        return super().begin(self.scene, "--backend", backend, *words, sets=sets)

    def finish(self, backend, folder="part", *words):
        self.expect(0, self.scene, "--quiet", "--backend", backend, "--out", folder, *words, sets=SETS)

    def test_killed_run_equals_uninterrupted_run(self):
        for backend in ("serial", gas_program.threaded()):
            with self.subTest(backend):
                self.finish(backend, "whole", "--overwrite")
                shutil.rmtree(self.folder / "part", ignore_errors=True)
                for attempt in range(3):
                    process = self.begin(backend, *(["--restart", "auto"] if attempt else []))
                    time.sleep(self.random.uniform(0.0, 0.05))
                    process.kill()
                    process.wait()
                    (self.folder / "part/.lock").unlink(missing_ok=True)
                self.finish(backend, "part", "--restart", "auto")
                self.assert_same_runs()

    def test_interrupted_run_equals_uninterrupted_run(self):
        self.finish("serial", "whole")
        for number in (signal.SIGINT, signal.SIGTERM):
            again = ["--restart", "auto"] if (self.folder / "part").exists() else []
            process = self.begin("serial", *again)
            process.send_signal(number)
            self.assertEqual(130, process.wait(timeout=30), process.stderr.read())
            reported = self.result("part")
            self.assertEqual(("interrupted", 130), (reported["status"], reported["exit_code"]))
            self.assertLess(reported["time"], 2.5)
        self.finish("serial", "part", "--restart", "auto")
        self.assert_same_runs()

    def test_finished_run_continues_to_a_later_end_time(self):
        """It equals a run with an output at the former end bit for bit, which ends its steps there too."""
        cases = {"drum": (springs_program.DRUM, ()), "rk4": (springs_program.DRUM, ("time.integrator=rk4",)),
                 "fixed": (springs_program.DRUM, ("time.dt=7e-4",)), "contact": (springs_program.FALLING.replace("restart_every = 20\n", ""), ())}
        for name, (text, more) in cases.items():
            with self.subTest(name):
                self.scene = self.write(text)
                words = ["--quiet", "--backend", "serial", "--out"]
                self.expect(0, self.scene, *words, "part", "--overwrite", sets=[*more, "time.end_time=0.08", "output.times=[0.05, 0.08]"])
                sets = [*more, "time.end_time=0.15", "output.times=[0.05, 0.08, 0.15]"]
                self.expect(0, self.scene, *words, "part", "--restart", "auto", sets=sets)
                self.expect(0, self.scene, *words, "whole", "--overwrite", sets=sets)
                self.assert_same_runs()
                self.assertEqual(self.result("whole").get("energy"), self.result("part").get("energy"))

    def test_rejects_invalid_restarts(self):
        self.finish("serial", "part")
        words = ["--quiet", "--backend", "serial", "--out", "part", "--restart", "auto"]
        for change in ("mesh.disk.vertices=61", "material.poisson=0.2", "pin.0.axes=xy"):
            with self.subTest(change):
                message = self.expect(6, self.scene, *words, sets=[*SETS, change]).stderr
                self.assertIn("another scene", message)
        file = self.folder / "part/restart.h5"
        file.write_bytes(file.read_bytes()[:-100])
        self.assertIn("truncated", self.expect(6, self.scene, *words, sets=SETS).stderr)

    def test_continued_contact_equals_uninterrupted_contact(self):
        """Contact lists and accumulated contact work are part of the state."""
        self.scene = self.write(springs_program.FALLING)
        words = ["--quiet", "--backend", "serial", "--out"]
        self.expect(0, self.scene, *words, "whole")
        process = self.begin("serial", sets=[])
        process.kill()
        process.wait()
        (self.folder / "part/.lock").unlink(missing_ok=True)
        self.expect(0, self.scene, *words, "part", "--restart", "auto")
        self.assert_same_runs()
        work = self.history("whole")["contact_work"]
        self.assertLess(work[-1], work[0])

    def test_finished_run_is_not_repeated(self):
        """The accumulated time of the last step may exceed the end time by 1 ulp."""
        words = ["--quiet", "--backend", "serial", "--out"]
        for end in (0.06, 0.07, 0.11, 0.12, 0.23, 0.29):
            sets = ["output.restart_every=1", f"time.end_time={end}", f"output.times=[{end}]"]
            self.expect(0, self.scene, *words, f"{end}", sets=sets)
            rows = self.history(f"{end}")
            self.expect(0, self.scene, *words, f"{end}", "--restart", "auto", sets=sets)
            self.assertEqual((rows, end), (self.history(f"{end}"), self.result(f"{end}")["time"]))

    def test_rejects_the_folder_of_another_run(self):
        self.finish("serial", "part")
        words = ["--quiet", "--backend", "serial", "--out", "other"]
        self.expect(0, self.scene, *words, sets=[*SETS, "material.poisson=0.2"])
        before = (self.folder / "other/history.csv").read_text()
        message = self.expect(2, self.scene, *words, "--restart", "part/restart.h5", sets=SETS).stderr
        self.assertIn("'other' holds a run of another scene; choose another --out", message)
        self.assertEqual(before, (self.folder / "other/history.csv").read_text())

    def test_history_starts_at_the_restart_if_rows_are_lost(self):
        """Rows lost from history.csv stay lost: new rows begin at the restart."""
        self.finish("serial", "part")
        history = self.folder / "part/history.csv"
        history.write_text(history.read_text().splitlines()[0] + "\n")
        self.finish("serial", "part", "--restart", "auto")
        first = self.history("part")["step"][0]
        self.assertEqual(0, first % 50)
        self.assertGreater(first, 0)

    def test_rejects_an_end_time_that_has_passed(self):
        self.finish("serial", "part")
        sets = [*SETS, "time.end_time=1.5", "output.times=[0.6]"]
        message = self.expect(6, self.scene, "--out", "new", "--restart", "part/restart.h5", sets=sets).stderr
        self.assertRegex(message, r"cannot continue from restart file 'part/restart.h5': it is of t = 2\.\S+ s, later than time.end_time = 1.5\n$")

    def test_failed_run_continues_with_shorter_steps(self):
        """A run that failed because of a long time step continues with a shorter one."""
        words = ["--quiet", "--backend", "serial", "--out", "part"]
        message = self.expect(4, self.scene, *words, sets=[*SETS, "time.dt=0.03"]).stderr
        self.assertIn("restart.h5 holds", message)
        for change in ("time.dt=0.0005", "time.safety=0.5"):
            with self.subTest(change):
                self.expect(0, self.scene, *words, "--restart", "auto", sets=[*SETS, change])
                self.assertLessEqual(self.result("part")["dt_min"], 0.001)
                shutil.rmtree(self.folder / "part")
                self.expect(4, self.scene, *words, sets=[*SETS, "time.dt=0.03"])

    def test_run_continued_in_another_folder_is_verified_as_a_whole(self):
        """The rows of the former folder are copied unless the columns differ."""
        sets = ["time.integrator=rk4", "output.restart_every=500", "verify.energy_drift=1e-3"]
        words = ["--quiet", "--backend", "serial", "--out"]
        self.expect(5, "free-patch", *words, "whole", sets=sets)
        self.expect(5, "free-patch", *words, "part", "--restart", "whole/restart.h5", sets=sets)
        self.assertEqual(self.result("whole")["checks"], self.result("part")["checks"])
        self.assertEqual((self.folder / "whole/history.csv").read_text(), (self.folder / "part/history.csv").read_text())
        self.expect(0, "free-patch", *words, "other", "--restart", "whole/restart.h5", sets=[
            "time.integrator=rk4", "output.probes=[{at=[0,0,0]}]", "verify={}"])
        time = self.history("other")["time"]
        self.assertGreater(time[0], 0.0)

    def test_continues_to_a_later_end_time(self):
        self.finish("serial", "part")
        longer = [*SETS, "time.end_time=3", "output.times=[0.6, 1.3, 2.5, 3]"]
        self.expect(0, self.scene, "--quiet", "--backend", "serial", "--out", "part", "--restart", "auto", sets=longer)
        self.expect(0, self.scene, "--quiet", "--backend", "serial", "--out", "whole", sets=longer)
        self.assertEqual(self.fields("whole").datasets["/steps/000003/position"],
                         self.fields("part").datasets["/steps/000003/position"])

    def test_refuses_output_times_that_have_passed_without_an_output(self):
        self.finish("serial", "part")
        sets = [*SETS, "time.end_time=3", "output.times=[0.6, 1.1, 1.3, 3]"]
        message = self.expect(6, self.scene, "--quiet", "--backend", "serial", "--out", "part", "--restart", "auto", sets=sets).stderr
        self.assertIn("output.times 1.1: the run continues from t = 2.49", message)
