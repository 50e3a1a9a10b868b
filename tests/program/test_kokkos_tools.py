# ctest-label: no-sanitizer
"""Connectors of Kokkos Tools in all programs: labels of kernels, and NVTX ranges by a connector of ours."""

import os
import pathlib
import re
import subprocess
import unittest

from folder_test import FolderTest

BIN = pathlib.Path(os.environ["DROGUE_BIN"])
BUILD = pathlib.Path(os.environ["DROGUE_BUILD"])
CONNECTOR = BUILD / "tests/libdrogue_label_connector.so"
NVTX, INJECTION = BUILD / "lib/libdrogue_nvtx.so", BUILD / "tests/libdrogue_nvtx_injection.so"
# Own kernels, and what Kokkos does for Views: to initialise one of ours, to fill, to copy.
LABEL = re.compile(r"drogue::\w+::[\w:]+$|Kokkos::View::initialization \[drogue::[\w: ]+\](?: via memset)?$|"
                   r"Kokkos::ViewFill-\dD$|Kokkos::Impl::host_space_deepcopy_double$")
RUNS = {
    "gas": ["drogue-gas", "sod", "--out", "gas"],
    "fabric": ["drogue-springs", "catenary", "--out", "fabric"],
    "options": ["drogue-options", "price", "example", "--out", "prices.csv"],
    "flow": ["drogue-parachute", "taylor-green-2d", "--set", "run.end_time=0.05", "--set", "output.times=[0.05]", "--out", "flow"],
    "ladders": ["drogue-perf", "ladder", "options", "--quick", "--backend", "serial"],
}


class Connectors(FolderTest):
    def run_with(self, words, connector, **more):
        """Output of a program that must not depend on the connector."""
        environment = {**os.environ, "KOKKOS_TOOLS_LIBS": str(connector), "OMP_WAIT_POLICY": "passive", **more}
        # On a GPU, graphs and persistent kernels have no callbacks.
        words = words if "--backend" in words else [*words, "--backend", "serial"]
        done = subprocess.run([BIN / words[0], *words[1:]], cwd=self.folder, env=environment, capture_output=True, text=True,
                              timeout=300, check=False)
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)

    def test_kernels_of_all_programs_have_labels(self):
        for area, words in RUNS.items():
            with self.subTest(area):
                file = self.folder / f"{area}.txt"
                self.run_with(words, CONNECTOR, DROGUE_LABELS=str(file))
                labels = set(file.read_text(encoding="utf-8").splitlines())
                self.assertEqual([], sorted(label for label in labels if not LABEL.match(label)))
                self.assertTrue(any(label.startswith("drogue::") for label in labels), labels)
                if area != "ladders":
                    self.assertTrue(any(label.startswith(f"drogue::{area}::") for label in labels), labels)

    def test_counters_count_beside_a_connector(self):
        file = self.folder / "labels.txt"
        self.run_with(RUNS["gas"], CONNECTOR, DROGUE_LABELS=str(file))
        with_connector = (self.folder / "gas/result.json").read_text(encoding="utf-8")
        self.run_with([*RUNS["gas"][:-1], "gas-2"], "", DROGUE_LABELS=str(file))
        without = (self.folder / "gas-2/result.json").read_text(encoding="utf-8")
        launches = [re.search(r'"kernel_launches": *(\d+)', text)[1] for text in (with_connector, without)]
        self.assertEqual(launches[0], launches[1])
        # Counting begins after the start of Kokkos, and includes what Kokkos launches itself.
        labels = file.read_text(encoding="utf-8").splitlines()
        self.assertTrue(sum(label.startswith("drogue::") for label in labels) <= int(launches[0]) <= len(labels))

    @unittest.skipUnless(NVTX.exists(), "there are no headers of NVTX")
    def test_ranges_of_nvtx_are_named_as_kernels(self):
        file = self.folder / "ranges.txt"
        self.run_with(RUNS["options"], NVTX, NVTX_INJECTION64_PATH=str(INJECTION), DROGUE_RANGES=str(file))
        lines = file.read_text(encoding="utf-8").splitlines()
        self.assertIn("push drogue::options::price", lines)
        depth = 0
        for line in lines:
            depth += 1 if line.startswith("push ") else -1
            self.assertIn(depth, (0, 1, 2), line)
        self.assertEqual(0, depth)
