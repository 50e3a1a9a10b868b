"""Checks in the machine code that a host step works on packs of cells."""

import os
import pathlib
import subprocess
import tempfile
import unittest

import disassembly

BUILD = pathlib.Path(os.environ["DROGUE_BUILD"])
# WENO-JS in full precision, all stages in one kernel.
FUNCTOR = "StepFunctor<Kokkos::Serial, (drogue::reconstruction::Reconstruction)0, (drogue::gas::Precision)0, false>"
# GCC may keep the face loop in a separate function.
CHUNK = "FaceChunk<drogue::device::Pack<double,"
FACE_DIVISIONS = 7  # `face_arithmetic` in perf/models/gas_step.hpp


def reason_to_skip():
    """Reason why this build cannot be checked, or None."""
    if "ON" in (disassembly.cache(BUILD).get(f"DROGUE_{device}") for device in ("CUDA", "HIP")):
        return "in a build for a GPU host backends have one lane"
    return disassembly.reason_to_skip(BUILD)


def complaints(counts, register):
    """Deviations of the instructions of a step from packed code, one sentence each."""
    def total(form, *operations):
        return sum(n for (operation, kind, at), n in counts.items()
                   if kind == form and (form == "s" or at == register) and (not operations or operation in operations))

    found = []
    # With 512-bit registers, an approximation with refinement counts as the operation that it replaces.
    divisions = total("p", "div", "rcp14")
    if divisions < FACE_DIVISIONS:
        found.append(f"{divisions} packed divisions in {register}, a face alone has {FACE_DIVISIONS}")
    if total("p", "sqrt", "rsqrt14") < 1:
        found.append(f"no packed square root in {register}")
    # Ghost cells and the remainder after the last full pack are scalar.
    if total("p") < 5 * total("s"):
        found.append(f"{total('p')} packed operations in {register} beside {total('s')} scalar ones")
    if total("s", "div") >= FACE_DIVISIONS:
        found.append(f"{total('s', 'div')} scalar divisions: a face is computed by one lane")
    return found


@unittest.skipIf(reason_to_skip(), reason_to_skip())
class Step(unittest.TestCase):
    def test_step_is_packed(self):
        object_file, words = disassembly.compilation(BUILD, "/step_serial.cpp")
        text = disassembly.disassembled(disassembly.cache(BUILD)["CMAKE_OBJDUMP"], object_file)
        counts = disassembly.arithmetic(text, (FUNCTOR, CHUNK))
        self.assertTrue(counts, f"no arithmetic in {FUNCTOR}")
        self.assertEqual([], complaints(counts, disassembly.widest_register(words)), counts)


@unittest.skipIf(reason_to_skip(), reason_to_skip())
class Root(unittest.TestCase):
    def test_root_is_one_instruction_on_processors_that_split_registers(self):
        # For Zen 1 GCC vectorises loops by 128 bits, here and wherever -march=native means Zen 1.
        _, words = disassembly.compilation(BUILD, "/step_serial.cpp")
        # A compiled header, whose options begin with this one, holds for its own processor alone.
        words = words[:words.index("-Winvalid-pch" if "-Winvalid-pch" in words else "-o")]
        with tempfile.TemporaryDirectory() as folder:
            source, compiled = pathlib.Path(folder, "root.cpp"), pathlib.Path(folder, "root.o")
            source.write_text('#include "kernels/device/pack.hpp"\n'
                              "using Four = drogue::device::Pack<double, 4>;\n"
                              "Four four_roots(Four x) { return square_root(x); }\n", encoding="utf-8")
            subprocess.run([*words, "-march=znver1", "-mtune=znver1", "-c", source, "-o", compiled], check=True)
            text = disassembly.disassembled(disassembly.cache(BUILD)["CMAKE_OBJDUMP"], compiled)
        self.assertEqual({("sqrt", "p", "ymm"): 1}, disassembly.arithmetic(text, ("four_roots",)))


class ScalarCodeDetection(unittest.TestCase):
    PACKED = [f" {k:x}:\tvdivpd %ymm1,%ymm2,%ymm3" for k in range(7)] + [" 10:\tvsqrtpd %ymm1,%ymm2"]

    def complaints(self, *lines, register="ymm"):
        text = "\n".join([f"0000 <void {FUNCTOR}::operator()() const>:", *lines, "0100 <other>:",
                          *[f" 1{k}0:\tdivsd %xmm1,%xmm0" for k in range(9)]])
        return complaints(disassembly.arithmetic(text, (FUNCTOR, CHUNK)), register)

    def test_accepts_packed_code(self):
        self.assertEqual([], self.complaints(*self.PACKED))

    def test_accepts_approximations_of_512_bits(self):
        approximated = [line.replace("div", "rcp14").replace("sqrt", "rsqrt14").replace("ymm", "zmm")
                        for line in self.PACKED]
        self.assertEqual([], self.complaints(*approximated, register="zmm"))

    def test_detects_scalar_code(self):
        scalar = [line.replace("pd", "sd").replace("ymm", "xmm") for line in self.PACKED]
        self.assertEqual(4, len(self.complaints(*scalar)))

    def test_detects_scalar_code_beside_packed(self):
        sentence, = self.complaints(*self.PACKED, " 20:\tvfmadd213sd %xmm1,%xmm2,%xmm3", " 21:\tmulsd (%rax),%xmm3")
        self.assertIn("8 packed operations in ymm beside 2 scalar ones", sentence)

    def test_detects_narrow_packs(self):
        self.assertEqual(2, len(self.complaints(*self.PACKED, register="zmm")))
        self.assertEqual(2, len(self.complaints(*[line.replace("ymm", "xmm") for line in self.PACKED])))

    def test_detects_a_scalar_root(self):
        sentence, = self.complaints(*self.PACKED[:7], " 10:\tvsqrtsd %xmm1,%xmm1,%xmm2")
        self.assertIn("no packed square root", sentence)
