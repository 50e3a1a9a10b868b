"""CMake and scripts/build.sh say what a build lacks, and refuse what cannot be built. A fake stands in for cmake."""

import os
import subprocess
from pathlib import Path

from folder_test import FolderTest

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
LOG = """-- Detecting C compile features
CMake Warning at cmake/X.cmake:1 (message):
  The Kokkos in /k was built for no processor.
Call Stack (most recent call first):

CMake Warning:
  Manually-specified variables were not used by the project:

    OTHER

-- Kokkos has no OpenMP: --backend openmp will not be compiled in
-- HDF5 1.10.8 is serial: runs on several ranks cannot write one file together
-- Kokkos 4.7.0 in /k (SERIAL)
-- Configuring done
"""


class Build(FolderTest):
    def cmake(self, *arguments, **environment):
        """What CMake says on standard error in one line."""
        result = subprocess.run(["cmake", *arguments], cwd=self.folder, env=os.environ | environment, capture_output=True, text=True)
        return " ".join(result.stderr.split())

    def test_script_prints_warnings_and_libraries(self):
        (self.folder / "log").write_text(LOG, encoding="utf-8")
        fake = self.folder / "cmake"
        fake.write_text(f'#!/bin/sh\n[ "$1" = --build ] || cat {self.folder}/log\n', encoding="utf-8")
        fake.chmod(0o755)
        said = subprocess.run([SOURCE / "scripts/build.sh", "host"], capture_output=True, text=True, check=True, env=os.environ | {
            "PATH": f"{self.folder}:{os.environ['PATH']}", "DROGUE_DEPS": str(self.folder / "deps")}).stderr
        for line in LOG.splitlines()[1:-1]:
            self.assertIn(line.replace("-- ", "== ", 1), said)
        self.assertNotIn("Detecting", said)
        self.assertNotIn("Configuring", said)

    def test_compiler_without_hip(self):
        said = self.cmake("-S", SOURCE, "-B", "build", "-G", "Ninja", "-DDROGUE_HIP=ON", CXX="g++")
        self.assertRegex(said, r"C\+\+ compiler \S+g\+\+ \(GNU\) compiles no HIP: configure with -DCMAKE_CXX_COMPILER=hipcc, or unset")

    def test_openmp_is_refused_only_if_it_is_asked_for(self):
        (self.folder / "script.cmake").write_text(f"cmake_policy(VERSION 3.25)\nset(PROJECT_SOURCE_DIR \"{SOURCE}\")\n"
                                                  f"include(\"{SOURCE}/cmake/DrogueBackends.cmake\")\n", encoding="utf-8")
        for options in ([], ["-DDROGUE_OPENMP=OFF"], ["-DDROGUE_OPENMP=ON", "-DKokkos_ENABLE_OPENMP=ON"]):
            self.assertEqual("", self.cmake("-DKokkos_ENABLE_SERIAL=ON", *options, "-P", "script.cmake"))
        said = self.cmake("-DKokkos_ENABLE_SERIAL=ON", "-DDROGUE_OPENMP=ON", "-P", "script.cmake")
        self.assertIn("The backend openmp needs a Kokkos with Kokkos_ENABLE_OPENMP=ON;", said)
