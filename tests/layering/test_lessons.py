"""The tables of the lessons are those of their records."""

import os
import subprocess
import sys
import unittest

import layers

ROOT = layers.repository(os.environ)
SCRIPT = ROOT / "scripts/lesson_tables.py"


class Lessons(unittest.TestCase):
    def test_tables_equal_their_records(self):
        process = subprocess.run([sys.executable, "-B", SCRIPT, "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(0, process.returncode, process.stderr)

    def test_every_rung_of_a_record_passed_its_check(self):
        for file in (ROOT / "docs/evidence/ladders").glob("*.jsonl"):
            self.assertNotIn('"check":"failed"', file.read_text(encoding="utf-8"), file.name)


if __name__ == "__main__":
    unittest.main()
