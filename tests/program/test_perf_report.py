"""drogue-perf report: page, CSV and JSON of a folder of records, and refusals."""

import csv
import json
import os
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import perf_program

RECORDS = os.environ["DROGUE_SOURCE"] + "/docs/evidence/planted"
PLOT = perf_program.PROGRAM.with_name("drogue-plot")


class Report(perf_program.PerfTest):
    def test_writes_page_and_exports(self):
        if subprocess.run([PLOT, "--version"], capture_output=True, check=False).returncode != 0:
            self.skipTest("drogue-plot has no Python packages")
        text = self.expect(0, "report", RECORDS, "--out", "made").stdout
        self.assertEqual(["made/records.csv", "made/reframe.json", "made/report.html"], text.splitlines())
        with (self.folder / "made/records.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(24, len(rows))
        self.assertEqual({"30"}, {row["samples"] for row in rows})
        cases = json.loads((self.folder / "made/reframe.json").read_text(encoding="utf-8"))["runs"][0]["testcases"]
        self.assertEqual([row["case"] for row in rows], [case["name"] for case in cases])
        page = (self.folder / "made/report.html").read_text(encoding="utf-8")
        self.assertTrue(all(row["case"] in page for row in rows))

    def test_refuses_folders_without_valid_records(self):
        self.assertIn("there is no folder 'missing'", self.expect(2, "report", "missing").stderr)
        self.assertIn("holds no records", self.expect(2, "report", ".").stderr)
        shutil.copy(RECORDS + "/old.jsonl", self.folder / "a.jsonl")
        (self.folder / "b.jsonl").write_text("{", encoding="utf-8")
        process = self.expect(3, "report", ".")
        self.assertRegex(process.stderr, r"^\./b\.jsonl:1: the line ends within a record")
        self.assertEqual(["a.jsonl", "b.jsonl"], sorted(file.name for file in self.folder.iterdir()))
        (self.folder / "b.jsonl").unlink()
        self.assertIn("cannot be made", self.expect(6, "report", ".", "--out", "a.jsonl/x").stderr)


if __name__ == "__main__":
    unittest.main()
