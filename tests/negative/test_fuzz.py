"""A damaged scene is refused or run: it never ends the program by a signal or with an exit code that is not documented."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import bad_scenes
import mutations

PROGRAM = pathlib.Path(os.environ["DROGUE_BIN"]) / "drogue-gas"

# Every way a scene is written: expressions, regions and tables beside inline tables.
EXPRESSIONS = """\
app = "gas"
[gas]
gamma = 1.4
[mesh]
cells = 40
domain = [-1, 1]
[initial.expression]
rho = "1 + 0.2*sin(pi*x)^2 + (x < 0 ? 0.1 : besselj(0, x))"
u = "1"
p = "max(1, 2, exp(-x^2/dx))"
[boundary]
left = "periodic"
right = "periodic"
[run]
end_time = 0.02
"""
REGIONS = """\
app = "gas"
description = '''
Three states.'''
gas.gamma = 1.4
mesh = { cells = 40, domain = [0.0, 1.0] }
[run]
end_time = 1_0.0e-3
[boundary]
left = "reflecting"
[[initial.regions]]
until = 0.1
rho = 1
p = 1000.0
[[initial.regions]] # the last
rho = 1.0
u = -0.5
p = 1e-2
[scheme]
weno = "teno5"
positivity = "on"
"""
SCENES = [text.encode() for text in (bad_scenes.GOOD, EXPRESSIONS, REGIONS)]


class Fuzz(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.scene = pathlib.Path(self._folder.name) / "scene.toml"

    def run_program(self, *arguments):
        return subprocess.run([str(PROGRAM), str(self.scene), *arguments], cwd=self._folder.name, capture_output=True,
                              timeout=120, check=False)

    def assert_ends_well(self, result, seed, allowed):
        message = result.stderr.decode(errors="replace")
        self.assertIn(result.returncode, allowed, f"mutation {seed}: {message[-2000:]}")
        if result.returncode == 3:
            self.assertTrue(message.startswith((f"{self.scene}:", "--set ")), f"mutation {seed}: {message}")

    def test_the_undamaged_scenes_are_right(self):
        for scene in SCENES:
            self.scene.write_bytes(scene)
            result = self.run_program("--check")
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_200_damaged_scenes_are_run(self):
        codes = set()
        for seed in range(1000, 1200):
            self.scene.write_bytes(mutations.mutate(SCENES[seed % 3], seed))
            result = self.run_program("--backend", "serial", "--overwrite", "--quiet", "--out", "out", "--set",
                                      "mesh.cells=16", "--set", "run.max_steps=200")
            self.assert_ends_well(result, seed, {0, 3, 4, 5})
            codes.add(result.returncode)
        self.assertLessEqual({0, 3}, codes)


if __name__ == "__main__":
    unittest.main()
