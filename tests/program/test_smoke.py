# ctest-label: smoke no-sanitizer
"""One shipped scene or batch per program, and the list of drogue-perf."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

RUNS = (
    ("drogue-gas", "sod", "--out", "sod"),
    ("drogue-springs", "catenary", "--out", "catenary"),
    ("drogue-options", "price", "example", "--out", "prices.csv"),
    ("drogue-parachute", "taylor-green-2d", "--out", "taylor-green-2d"),
    ("drogue-perf", "list"),
)


class Smoke(unittest.TestCase):
    def test_programs_end_verified(self):
        for program, *words in RUNS:
            with self.subTest(program), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run(
                    [Path(os.environ["DROGUE_BIN"]) / program, *words],
                    cwd=folder, capture_output=True, text=True, check=False,
                )
                self.assertEqual((0, ""), (done.returncode, done.stderr))
