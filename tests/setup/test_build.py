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
