"""Added masses as scripts/studies/measure_added_mass.py measures them, on made histories."""

import math
import os
import subprocess
import sys
import unittest
from pathlib import Path

SCRIPT = Path(os.environ["DROGUE_SOURCE"]) / "scripts/studies/measure_added_mass.py"
sys.path.insert(0, str(SCRIPT.parent))

import measure_added_mass


def history(force, steps=377):
    times = [3.0 * k / steps for k in range(steps + 1)]
    return [{"time": t, "body_0_force_x": force(2.0 * math.pi * t)} for t in times]


class MeasureAddedMass(unittest.TestCase):
    def test_separates_parts_of_force(self):
        inertia, drag, rest, largest = measure_added_mass.parts(history(lambda p: 3 * math.sin(p) - 2 * math.cos(p) + 7))
        self.assertAlmostEqual(3.0, inertia, delta=0.05)
        self.assertAlmostEqual(-2.0, drag, delta=0.05)
        self.assertLess(rest, 0.05)
        self.assertAlmostEqual(7.0 + math.sqrt(13.0), largest, delta=0.01)

    def test_higher_harmonics_are_the_rest(self):
        inertia, _, rest, _ = measure_added_mass.parts(history(lambda p: math.sin(p) + 0.5 * math.sin(3 * p), 300))
        self.assertAlmostEqual(1.0, inertia, delta=1e-12)
        self.assertAlmostEqual(0.5 / math.sqrt(2.0), rest, delta=1e-12)

    def test_refuses_impossible_arguments(self):
        for words in (["--cells", "0"], ["--amplitude", "0"], ["--bin", "/nowhere"]):
            with self.subTest(words):
                run = subprocess.run([SCRIPT, *words], capture_output=True, text=True, check=False)
                self.assertEqual(1, run.returncode)
                self.assertEqual(1, len(run.stderr.splitlines()), run.stderr)
