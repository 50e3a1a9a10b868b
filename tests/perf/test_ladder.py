"""Ladders of drogue-perf: table, records and bad input."""

import os
import pathlib
import re
import subprocess

import perf_program


class Ladder(perf_program.PerfTest):
    def test_prints_and_records_every_rung(self):
        text = self.expect(0, "ladder", "weno", "--backend", "serial", "--quick", "--explain", "--out", "rungs.jsonl").stdout
        self.assertIn("GPU only", text)
        self.assertIn("On a host the copies are memcpy", text)
        records = self.records("rungs.jsonl")
        self.assertGreaterEqual(len(records), 8)
        for record in records:
            self.assertEqual("passed", record["check"])
            self.assertEqual("weno", record["facts"]["ladder"])
            self.assertGreater(record["facts"]["predicted_s"], 0.0)
            self.assertIn(record["facts"]["rung"], text)

    def test_names_the_nearest_ladder(self):
        self.assertIn('did you mean "weno"', self.expect(2, "ladder", "wenno").stderr)

    def test_check_finds_the_shipped_exercises_broken(self):
        process = self.expect(5, "ladder", "check", "--backend", "serial")
        self.assertEqual(4, process.stdout.count("broken: "))
        self.assertIn("4 of 4 exercises are broken", process.stderr)
        # Speed is no part of a test: slow or fast, each exercise states both factors.
        wanted = dict(re.findall(r"(?m)^(\w+) .*(?:slow|fast): [0-9.]+ times as fast \(goal ([0-9.]+)\)", process.stdout))
        answers = pathlib.Path(os.environ["DROGUE_SOURCE"], "docs/lessons/answers.md").read_text(encoding="utf-8")
        self.assertEqual(dict(re.findall(r"(?m)^\| `(\w+)` \|.*\| ([0-9.]+) \| [0-9.]+ \|$", answers)), wanted)
        self.assertEqual(4, len(wanted))

    def test_check_accepts_the_solutions(self):
        process = subprocess.run([perf_program.PROGRAM, "ladder", "check", "--backend", "serial", "--solutions"],
                                 cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertIn(process.returncode, (0, 5))  # by their speed on a machine that others use
        self.assertNotIn("broken: ", process.stdout)
        self.assertEqual(4, process.stdout.count("mended"))
        self.assertIn("--solutions", self.expect(2, "ladder", "weno", "--solutions").stderr)
