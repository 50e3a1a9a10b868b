"""Figures of the dissertation from runs of this build."""

import os
import subprocess
import sys

import packages  # before modules that need the packages  isort: skip
from folder_test import FolderTest


class Dissertation(FolderTest):
    def draw(self, figures):
        command = [sys.executable, packages.SOURCE / "scripts/studies/draw_dissertation.py", "--bin", os.environ["DROGUE_BIN"],
                   "--figures", figures, "--work", self.folder / "runs", "--to", self.folder]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def test_draws_sod_and_prints_its_errors(self):
        done = self.draw("5.14")
        self.assertEqual((0, "5.14 400 0.00258\n5.14 3200 0.00041\n"), (done.returncode, done.stdout), done.stderr)
        self.assertGreater((self.folder / "shi-5-14.png").stat().st_size, 10_000)

    def test_refuses_unknown_figures(self):
        done = self.draw("5.9")
        self.assertNotEqual(0, done.returncode)
        self.assertIn("no figure 5.9: 5.2, 5.3, 5.5", done.stderr)
