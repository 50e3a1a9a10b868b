# ctest-label: no-sanitizer
"""A run that was killed and continued gives the bits of one that was not."""

import os
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import gas_program
import restarting


class Killed(restarting.RestartTest):
    def test_same_bits(self):
        for scene, backend in (("sod", "serial"), ("blast", gas_program.threaded()), ("entropy-wave", "serial")):
            with self.subTest(scene):
                self.folder = self.fresh_folder(scene)
                self.whole(scene, backend)
                self.kill_and_continue(scene, backend, 3)
                self.assert_same_runs()

    def test_the_limiter_was_in_it(self):
        """Else the blast above would not test what it is there for."""
        self.whole("blast", "serial")
        told = self.result("whole")["limiter"]
        self.assertTrue(told["redone_steps"] > 0 and told["touches"] > 0 and told["cells"] > 0, told)

    def test_seed_mode(self):
        sets = ["mesh.cells=400", "output.restart_every=20", "output.history_every=7", "verify.l1_density=1.0"]
        self.whole("sod", "serial", "--seed-mode", sets=sets)
        self.kill_and_continue("sod", "serial", 2, "--seed-mode", sets=sets)
        self.assert_same_runs()

    def test_killed_before_its_first_restart_file(self):
        """One job script serves every submission: `auto` begins anew where there is nothing to continue."""
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


if __name__ == "__main__":
    unittest.main()
