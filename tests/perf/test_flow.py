"""Memory of flow solvers and bytes of their steps, as drogue-perf records them."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["DROGUE_BIN"]) / "drogue-perf"
GHOSTS = 3


def records(*words):
    """Records of a command on the Serial backend."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "records.jsonl"
        subprocess.run([PROGRAM, *words, "--quick", "--out", file], capture_output=True, check=True)
        return {record["case"]: record for record in map(json.loads, file.read_text().splitlines())}


def array_bytes(n):
    """Bytes of three velocity fields with ghost cells and two scalar fields on n^3 cells; rows of 64 bytes."""
    row = (8 + n + GHOSTS + 7) // 8 * 8
    return 8 * (3 * (3 * row * (n + 2 * GHOSTS) ** 2 + 64) + 2 * n**3)


@unittest.skipUnless(PROGRAM.exists(), "builds with sanitizers omit drogue-perf")
class Memory(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.facts = {case: record["facts"] for case, record in
                     records("table", "memory", "--backend", "serial").items()}

    def test_allocations_are_those_of_five_fields(self):
        for n in (32, 64):
            for sides in ("periodic", "tunnel"):
                extra = self.facts[f"flow-memory/serial/{n}x{n}x{n}/{sides}"]["array_bytes"] / array_bytes(n) - 1
                self.assertTrue(0 <= extra < 0.01, (n, sides, extra))

    def test_large_grid_needs_less_than_100_bytes_per_cell(self):
        # By the formula that the test above confirms: 512^3 cells would fill the memory of a small machine.
        self.assertLess(array_bytes(512) / 512**3, 100)

    def test_implicit_diffusion_adds_a_scalar_field_and_a_force_three(self):
        n = 64
        base = {sides: self.facts[f"flow-memory/serial/64x64x64/{sides}"]["array_bytes"]
                for sides in ("periodic", "tunnel")}
        added = self.facts["flow-memory/serial/64x64x64/periodic/crank-nicolson"]["array_bytes"] - base["periodic"]
        self.assertAlmostEqual(1, added / (8 * n**3), delta=0.05)
        added = self.facts["flow-memory/serial/64x64x64/tunnel/force"]["array_bytes"] - base["tunnel"]
        self.assertAlmostEqual(1, added / ((array_bytes(n) - 16 * n**3) / 3), delta=0.01)


@unittest.skipUnless(PROGRAM.exists(), "builds with sanitizers omit drogue-perf")
class Steps(unittest.TestCase):
    def test_record_the_bytes_of_their_kernels_and_the_error_of_their_solver(self):
        found = records("run", "--filter", "^flow-step/serial")
        for case, cells in (("32x32x32/periodic", 32**3), ("20x20x40/tunnel", 20 * 20 * 40)):
            record = found[f"flow-step/serial/{case}"]
            self.assertEqual("passed", record["check"])
            self.assertEqual((cells, 304 * cells), (record["facts"]["cells"], record["facts"]["bytes"]))
            # A wrong flux gives an error of order one.
            self.assertTrue(0 < record["facts"]["solution_error"] < 1 / int(case.split("x")[0]))
