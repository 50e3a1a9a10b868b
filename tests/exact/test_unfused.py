"""Checks in the machine code that the options of the preset exact leave no fused multiply-add."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import disassembly

BUILD = pathlib.Path(os.environ["DROGUE_BUILD"])
# Sums of products of complex numbers, which gcc 12.2 fuses in spite of -ffp-contract=off where it vectorises them.
SOURCE = "kernels/options/cos/characteristic_exponent.cpp"


def fused_operations(options):
    """Number of fused operations of SOURCE, compiled as in this build but with more options."""
    _, words = disassembly.compilation(BUILD, SOURCE)
    with tempfile.TemporaryDirectory() as folder:
        target = pathlib.Path(folder) / "object.o"
        at = words.index("-o")
        command = [*words[:at], *options, "-o", target, *words[at + 2:]]
        subprocess.run(command, cwd=BUILD, check=True, capture_output=True)
        text = disassembly.disassembled(disassembly.cache(BUILD)["CMAKE_OBJDUMP"], target)
    return len(disassembly.FUSED.findall(text))


@unittest.skipIf(disassembly.reason_to_skip(BUILD), disassembly.reason_to_skip(BUILD))
class FusedOperations(unittest.TestCase):
    def test_exact_options_leave_no_fused_operation(self):
        if fused_operations(["-ffp-contract=fast"]) == 0:
            self.skipTest("this processor has no fused multiply-add")
        options = disassembly.cache(BUILD)["DROGUE_UNFUSED_OPTIONS"].split(";")
        self.assertEqual(0, fused_operations(options), options)
