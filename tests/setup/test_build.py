"""CMake refuses what cannot be built."""

import os
import subprocess
from pathlib import Path

from folder_test import FolderTest

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))


class Build(FolderTest):
    def cmake(self, *arguments, **environment):
        """What CMake says on standard error in one line."""
        result = subprocess.run(["cmake", *arguments], cwd=self.folder, env=os.environ | environment, capture_output=True, text=True)
        return " ".join(result.stderr.split())

    def test_compiler_without_hip(self):
        said = self.cmake("-S", SOURCE, "-B", "build", "-G", "Ninja", "-DDROGUE_HIP=ON", CXX="g++")
        self.assertRegex(said, r"C\+\+ compiler \S+g\+\+ \(GNU\) compiles no HIP: configure with -DCMAKE_CXX_COMPILER=hipcc, or unset")

    def test_openmp_is_refused_only_if_it_is_asked_for(self):
        (self.folder / "script.cmake").write_text(f"cmake_policy(VERSION 3.25)\nset(PROJECT_SOURCE_DIR {SOURCE})\n"
                                                  f"include({SOURCE}/cmake/DrogueBackends.cmake)\n", encoding="utf-8")
        for options in ([], ["-DDROGUE_OPENMP=OFF"], ["-DDROGUE_OPENMP=ON", "-DKokkos_ENABLE_OPENMP=ON"]):
            self.assertEqual("", self.cmake("-DKokkos_ENABLE_SERIAL=ON", *options, "-P", "script.cmake"))
        said = self.cmake("-DKokkos_ENABLE_SERIAL=ON", "-DDROGUE_OPENMP=ON", "-P", "script.cmake")
        self.assertIn("The backend openmp needs a Kokkos with Kokkos_ENABLE_OPENMP=ON;", said)
