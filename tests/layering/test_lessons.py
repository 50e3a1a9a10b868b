"""The tables of the lessons are those of their records."""

import json
import os
import re
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

    def test_each_rung_is_one_short_file(self):
        found = 0
        for ladder in ("weno", "springs", "options", "transfers"):
            rungs = re.findall(r"make_rung<", (ROOT / f"perf/ladders/{ladder}/ladder.hpp").read_text(encoding="utf-8"))
            texts = 0
            for header in sorted((ROOT / "perf/ladders" / ladder).glob("*.hpp")):
                text = header.read_text(encoding="utf-8")
                for name in re.findall(r'RungText text\{\s*"([^"]+)"', text):
                    self.assertEqual(header.stem, name.replace("-", "_"))
                    self.assertLess(text.count("\n"), 150, header.name)
                    texts += 1
            self.assertEqual(len(rungs), texts, ladder)
            found += texts
        self.assertGreater(found, 25)

    def test_times_that_a_rung_states_are_those_of_its_record(self):
        folder = ROOT / "perf/ladders"
        stated = 0
        for ladder in ("weno", "springs", "options", "transfers"):
            lines = (ROOT / f"docs/evidence/ladders/{ladder}-cuda-h100.jsonl").read_text(encoding="utf-8").splitlines()
            records = [json.loads(line) for line in lines]
            times = {time * 1e6 for r in records for time in (r["median"], r["facts"]["predicted_s"])}
            for header in sorted((folder / ladder).glob("*.hpp")):
                text = re.sub(r'"\s*"', "", header.read_text(encoding="utf-8"))
                for number in re.findall(r"\b([0-9.]+) us\b", text):
                    digits = len(number.replace(".", "").lstrip("0"))
                    rounded = {float(f"{time:.{digits}g}") for time in times}
                    self.assertIn(float(number), rounded, f"{header.name}: {number} us")
                    stated += 1
        self.assertGreater(stated, 30)


if __name__ == "__main__":
    unittest.main()
