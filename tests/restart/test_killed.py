# ctest-label: no-sanitizer
"""Runs that are killed and continued equal uninterrupted runs bit for bit."""

import gas_program
import restarting


class Killed(restarting.RestartTest):
    def test_continued_run_equals_uninterrupted_run(self):
        for scene, backend in (("sod", "serial"), ("blast", gas_program.threaded()), ("entropy-wave", "serial")):
            with self.subTest(scene):
                self.folder = self.fresh_folder(scene)
                self.whole(scene, backend)
                self.kill_and_continue(scene, backend, 3)
                self.assert_same_runs()

    def test_run_uses_the_limiter(self):
        """Precondition of the tests above: the limiter acts in the blast."""
        self.whole("blast", "serial")
        reported = self.result("whole")["limiter"]
        self.assertTrue(reported["redone_steps"] > 0 and reported["touches"] > 0 and reported["cells"] > 0, reported)

    def test_continued_baseline_run_equals_uninterrupted_run(self):
        sets = ["mesh.cells=400", "output.restart_every=20", "output.history_every=7", "verify.l1_density=1.0"]
        self.whole("sod", "serial", "--seed-mode", sets=sets)
        self.kill_and_continue("sod", "serial", 2, "--seed-mode", sets=sets)
        self.assert_same_runs()

    def test_restarts_from_the_beginning_without_a_restart_file(self):
        """`--restart auto` starts from the beginning if there is no restart file, so one job script suffices."""
        self.whole("sod", "serial")
        for name in ("history.csv", "fields.h5", "scene.toml", "fields.xdmf"):
            (self.folder / "part").mkdir(exist_ok=True)
            (self.folder / "part" / name).write_bytes((self.folder / "whole" / name).read_bytes())
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "part", "--restart", "auto",
                    sets=restarting.CASES["sod"])
        self.assert_same_runs()

    def fresh_folder(self, name):
        folder = self.folder / name
        folder.mkdir()
        return folder
