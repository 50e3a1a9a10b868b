"""Installs this build into a fresh prefix, builds a small program against the package, and runs it."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["DROGUE_SOURCE"])
BUILD = Path(os.environ["DROGUE_BUILD"])
CACHE = dict(
    line.split("=", 1)
    for line in (BUILD / "CMakeCache.txt").read_text(encoding="utf-8").splitlines()
    if "=" in line and not line.startswith(("#", "//"))
)


def cached(name):
    """The value of a CMake cache variable whatever its type, empty if there is none."""
    return next((value for key, value in CACHE.items() if key.split(":")[0] == name), "")


def has_gpu():
    return shutil.which("nvidia-smi") and subprocess.run(["nvidia-smi", "-L"], capture_output=True).returncode == 0


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.prefix = Path(folder.name) / "prefix"
        cls.work = Path(folder.name) / "consumer"
        cls.run_command("cmake", "--install", BUILD, "--prefix", cls.prefix)

    @classmethod
    def run_command(cls, *command):
        result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if result.returncode:
            raise AssertionError(f"{command}\n{result.stdout}\n{result.stderr}")
        return result.stdout

    def test_consumer(self):
        options = [f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_BUILD_TYPE={cached('CMAKE_BUILD_TYPE')}"]
        if cached("DROGUE_SANITIZE") == "ON":
            options.append("-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined")
        if cached("DROGUE_CUDA") == "ON":
            options.append(f"-DCMAKE_CUDA_COMPILER={cached('CMAKE_CUDA_COMPILER')}")
        self.run_command("cmake", "-S", SOURCE / "tests/install/consumer", "-B", self.work, "-G", "Ninja", *options)
        self.run_command("cmake", "--build", self.work)
        if cached("DROGUE_CUDA") == "ON" and not has_gpu():
            self.skipTest("built and linked; a CUDA build of Kokkos starts on no machine without a GPU")
        self.assertEqual("steps 20 mass 2.000000000000\n", self.run_command(self.work / "consumer"))

    def test_headers_name_no_other_layer(self):
        include = self.prefix / "include/drogue"
        self.assertTrue((include / "kernels/gas/solver.hpp").is_file())
        self.assertEqual(["kernels"], sorted(path.name for path in include.iterdir()))
        self.assertFalse((include / "kernels/reference").exists())

    def test_arithmetic_is_handed_on(self):
        """A consumer of an exact build compiles without fused multiply-add; no other learns of it."""
        targets = (self.prefix / "lib/cmake/Drogue/DrogueTargets.cmake").read_text(encoding="utf-8")
        exact = cached("DROGUE_EXACT") == "ON"
        self.assertEqual(exact, "DROGUE_EXACT=1" in targets)
        self.assertEqual(exact, "-ffp-contract=off" in targets)

    def test_no_path_of_the_source_tree(self):
        for path in (self.prefix / "lib/cmake/Drogue").iterdir():
            text = path.read_text(encoding="utf-8")
            self.assertNotIn(f"{SOURCE}/cmake", text, path)
            self.assertNotIn(f"{SOURCE}/kernels", text, path)


if __name__ == "__main__":
    unittest.main()
