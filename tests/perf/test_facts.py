"""Facts for a roofline diagram in the records of drogue-perf."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["DROGUE_BIN"]) / "drogue-perf"


def is_available():
    """True if the program is built (sanitizer builds omit it) and finds its device."""
    if not PROGRAM.exists():
        return False
    return subprocess.run([PROGRAM, "run", "--filter", "^$"], capture_output=True, check=False).returncode != 77


@unittest.skipUnless(is_available(), "drogue-perf is not built, or finds no device")
class Facts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cases = "^(ceiling/(fp64|cache|launch)/serial|gas-step/(serial|dense-loop)/1024|springs-step/serial/2640)$"
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "records.jsonl"
            subprocess.run([PROGRAM, "run", "--quick", "--filter", cases, "--out", file], capture_output=True,
                           check=True)
            cls.records = {record["case"]: record for record in map(json.loads, file.read_text().splitlines())}

    def facts(self, case):
        self.assertEqual("passed", self.records[case]["check"])
        return self.records[case]["facts"]

    def test_step_records_bytes_and_flops(self):
        facts = self.facts("gas-step/serial/1024")
        self.assertEqual(("serial", 1024, ""), (facts["backend"], facts["cells"], facts["variant"]))
        # Four tiles of 256 cells, with nine halo cells read on either side, three numbers per cell.
        self.assertEqual(4 * (274 + 256) * 24, facts["bytes"])
        # Three stages with about 500 operations per cell, and a few per cent in the halo.
        self.assertAlmostEqual(1500, facts["flops"] / 1024, delta=150)

    def test_steps_record_instructions_and_launches(self):
        facts = self.facts("gas-step/serial/1024")
        # The step, and the kernel that accepts it.
        self.assertEqual((2, "plain"), (facts["launches"], facts["driver"]))
        # Fused multiply-adds are one instruction of two operations; comparisons are no operations.
        self.assertTrue(0.5 < facts["instructions"] / facts["flops"] < 1.0)
        facts = self.facts("springs-step/serial/2640")
        self.assertEqual(4, facts["launches"])
        # 636 bytes per vertex, and 112 per slot of its ring of seven or, in the padding of slices, more.
        self.assertTrue(636 + 112 * 7 < facts["bytes"] / facts["cells"] < 636 + 112 * 9)

    def test_launches_record_neither_bytes_nor_flops(self):
        self.assertEqual({"backend": "serial"}, self.facts("ceiling/launch/serial"))

    def test_omits_unknown_flops_and_bytes(self):
        expected = {"backend": "serial", "cells": 1024, "variant": "dense-loop"}
        self.assertEqual(expected, self.facts("gas-step/dense-loop/1024"))

    def test_ceilings_record_bytes_and_flops(self):
        for case in ("ceiling/fp64/serial", "ceiling/cache/serial"):
            facts = self.facts(case)
            self.assertEqual({"backend", "flops", "bytes"}, set(facts))
            self.assertEqual("serial", facts["backend"])
        # 24 bytes and two operations per value.
        self.assertEqual(12 * self.facts("ceiling/cache/serial")["flops"], self.facts("ceiling/cache/serial")["bytes"])
