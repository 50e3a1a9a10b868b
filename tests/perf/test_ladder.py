"""Ladders of drogue-perf: table, records and bad input."""

import os
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

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


if __name__ == "__main__":
    unittest.main()
