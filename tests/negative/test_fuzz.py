"""A damaged scene is rejected or run; the program never ends by a signal or with an undocumented exit code."""

import os
import pathlib
import subprocess

import bad_scenes
from folder_test import FolderTest
import mutations

PROGRAM = pathlib.Path(os.environ["DROGUE_BIN"]) / "drogue-gas"

SCENES = [text.encode() for text in bad_scenes.SOUND]


class Fuzz(FolderTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene.toml"

    def run_program(self, *arguments):
        return subprocess.run([str(PROGRAM), str(self.scene), *arguments], cwd=self.folder, capture_output=True,
                              timeout=120, check=False)

    def assert_ends_well(self, result, seed, allowed):
        message = result.stderr.decode(errors="replace")
        self.assertIn(result.returncode, allowed, f"mutation {seed}: {message[-2000:]}")
        if result.returncode == 3:
            self.assertTrue(message.startswith((f"{self.scene}:", "--set ")), f"mutation {seed}: {message}")

    def test_undamaged_scenes_are_valid(self):
        for scene in SCENES:
            self.scene.write_bytes(scene)
            result = self.run_program("--check")
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_200_damaged_scenes_end_with_documented_codes(self):
        codes = set()
        for seed in range(1000, 1200):
            self.scene.write_bytes(mutations.mutate(SCENES[seed % 3], seed))
            result = self.run_program("--backend", "serial", "--overwrite", "--quiet", "--out", "out", "--set",
                                      "mesh.cells=16", "--set", "run.max_steps=200")
            self.assert_ends_well(result, seed, {0, 3, 4, 5})
            codes.add(result.returncode)
        self.assertLessEqual({0, 3}, codes)
