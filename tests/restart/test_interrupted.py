# ctest-label: no-sanitizer
"""Runs that are interrupted after a whole step and continued equal uninterrupted runs bit for bit."""

import signal
import time

import gas_program
import restarting


class Interrupted(restarting.RestartTest):
    def interrupt(self, number, *words, scene="sod", backend="serial", sets=None):
        process = self.begin(scene, backend, *words, sets=sets)
        time.sleep(self.random.uniform(0.0, 0.05))
        process.send_signal(number)
        code = process.wait(timeout=30)
        self.assertEqual(130, code, process.stderr.read())
        self.assertEqual(b"", process.stderr.read())
        reported = self.result("part")
        self.assertEqual(("interrupted", 130), (reported["status"], reported["exit_code"]))
        self.assertIn("restart.h5", reported["message"])
        self.assertTrue((self.folder / "part/restart.h5").exists())
        return reported

    def assert_continues(self, number, scene="sod", backend="serial"):
        self.whole(scene, backend)
        reported = self.interrupt(number, scene=scene, backend=backend)
        self.assertGreater(reported["steps"], 0)
        self.assertLess(reported["time"], self.result("whole")["time"])
        again = self.interrupt(number, "--restart", "auto", scene=scene, backend=backend)
        self.assertGreaterEqual(again["steps"], reported["steps"])
        self.expect(0, scene, "--quiet", "--backend", backend, "--out", "part", "--restart", "auto",
                    sets=restarting.CASES[scene])
        self.assert_same_runs()

    def test_ctrl_c_ends_after_a_whole_step(self):
        self.assert_continues(signal.SIGINT)

    def test_sigterm_ends_after_a_whole_step(self):
        self.assert_continues(signal.SIGTERM, scene="entropy-wave", backend=gas_program.threaded())

    def test_notices_of_shells_and_batch_systems_end_after_a_whole_step(self):
        """Sent twice: a shell that ends and its terminal both send SIGHUP, and SIGXCPU comes every second."""
        sets = ["mesh.cells=6400", "output.restart_every=25", gas_program.NO_FIELDS]
        for number in (signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU, signal.SIGALRM):
            with self.subTest(number.name):
                process = self.begin("sod", "serial", "--overwrite", sets=sets)
                process.send_signal(number)
                process.send_signal(number)
                self.assertEqual(130, process.wait(timeout=30), process.stderr.read())
                self.assertEqual(("interrupted", 130), tuple(self.result("part")[key] for key in ("status", "exit_code")))
                self.assertTrue((self.folder / "part/restart.h5").exists())
                self.assertFalse((self.folder / "part/.lock").exists())

    def test_continues_after_very_short_stretches(self):
        sets = ["mesh.cells=3000", "output.restart_every=1", "output.times=[0.4]"]
        for words in ((), ("--seed-mode",)):
            with self.subTest(words):
                self.interrupt(signal.SIGINT, "--overwrite", *words, sets=sets)
                (self.folder / "part/restart.h5").unlink()

    def test_run_without_its_history_leaves_a_restart_file(self):
        process = self.begin("sod", "serial", sets=[*restarting.CASES["sod"], "run.end_time=0.4", "output.times=[0.4]"])
        (self.folder / "part/history.csv").unlink()
        (self.folder / "part/restart.h5").unlink()
        self.assertEqual(6, process.wait(timeout=60))
        self.assertIn(b"history.csv' was deleted or replaced during the run", process.stderr.read())
        self.assertEqual(0.4, self.result("part")["time"])
        self.assertTrue((self.folder / "part/restart.h5").exists())

    def test_finished_run_is_not_repeated(self):
        """Resubmission of the job script of a finished run changes nothing."""
        self.whole("sod", "serial")
        before = (self.folder / "whole/history.csv").read_text()
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "whole", "--restart", "auto",
                    sets=restarting.CASES["sod"])
        self.assertEqual(before, (self.folder / "whole/history.csv").read_text())
