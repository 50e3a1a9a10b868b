"""Installs this build into a fresh prefix, builds a small program against the package, and runs it."""

import json
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
        cls.work = Path(folder.name)
        cls.run_command("cmake", "--install", BUILD, "--prefix", cls.prefix)

    @classmethod
    def run_command(cls, *command):
        result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if result.returncode:
            raise AssertionError(f"{command}\n{result.stdout}\n{result.stderr}")
        return result.stdout

    def build(self, name):
        """Configures and builds the consumer `name` against the package; returns its build folder."""
        options = [f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_BUILD_TYPE={cached('CMAKE_BUILD_TYPE')}"]
        if cached("DROGUE_SANITIZE") == "ON":
            options.append("-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined")
        if cached("DROGUE_CUDA") == "ON":
            options.append(f"-DCMAKE_CUDA_COMPILER={cached('CMAKE_CUDA_COMPILER')}")
        folder = self.work / name
        self.run_command("cmake", "-S", SOURCE / "tests/install" / name, "-B", folder, "-G", "Ninja", *options)
        self.run_command("cmake", "--build", folder)
        if cached("DROGUE_CUDA") == "ON" and not has_gpu():
            self.skipTest("built and linked; a CUDA build of Kokkos starts on no machine without a GPU")
        return folder

    def test_consumer_builds_and_runs(self):
        self.assertEqual("steps 20 mass 2.000000000000\n", self.run_command(self.build("consumer") / "consumer"))

    def test_mini_app_of_120_lines(self):
        """A mini-app outside of the repository has the command line, files and exit codes of the shipped ones."""
        files = [path for path in (SOURCE / "tests/install/mini_app").rglob("*") if path.is_file()]
        lines = {path.name: path.read_text(encoding="utf-8").splitlines() for path in files}
        self.assertLessEqual(sum(map(len, lines.values())), 120, {name: len(text) for name, text in lines.items()})
        self.assertEqual([], [line for text in lines.values() for line in text if len(line) > 120])
        program = self.build("mini_app") / "drogue-heat"

        def run(code, *words):
            result = subprocess.run([program, *words], cwd=self.work, capture_output=True, text=True)
            self.assertEqual(code, result.returncode, f"{words}\n{result.stdout}\n{result.stderr}")
            return result.stdout + result.stderr

        self.assertIn("sine  A sine decays", run(0, "--list-scenes"))
        self.assertIn("drogue-heat", run(0, "--version"))
        self.assertIn("end_time = 0.02", run(0, "sine", "--print-scene"))
        common = ["sine", "--backend", "serial", "--out", "heat"]
        self.assertIn("linf", run(0, *common))
        folder = self.work / "heat"
        self.assertEqual({"fields.h5", "fields.xdmf", "history.csv", "restart.h5", "result.json", "scene.toml"},
                         {path.name for path in folder.iterdir()})
        reported = json.loads((folder / "result.json").read_text(encoding="utf-8"))
        self.assertEqual(("drogue-heat", "ok", 0.02), (reported["program"], reported["status"], reported["time"]))
        self.assertLess(reported["errors"]["linf"], 1e-3)
        self.assertEqual(3, (folder / "fields.xdmf").read_text(encoding="utf-8").count("<Time Value="))
        whole = (folder / "history.csv").read_text(encoding="utf-8")
        self.assertIn("holds a run", run(2, *common))
        self.assertIn("unknown key", run(3, *common, "--overwrite", "--set", "ends=1"))
        self.assertIn("linf is", run(5, *common, "--overwrite", "--set", "linf=0"))
        self.assertIn("no --study", run(2, "sine", "--study", "meshes=10:20"))
        with self.subTest("a run in two parts equals one run"):
            first = ["--overwrite", "--set", "end_time=0.01", "--set", "output.times=[0.0, 0.01]"]
            run(5, *common, *first, "--set", "output.restart_every=41", "--set", "linf=0")
            run(0, *common, "--restart", "auto")
            self.assertEqual(whole.splitlines()[-1], (folder / "history.csv").read_text(encoding="utf-8").splitlines()[-1])

    def test_headers_name_no_other_layer(self):
        include = self.prefix / "include/drogue"
        self.assertTrue((include / "kernels/gas/solver.hpp").is_file())
        self.assertEqual(["common", "kernels", "miniapps"], sorted(path.name for path in include.iterdir()))
        self.assertEqual(["framework"], [path.name for path in (include / "miniapps").iterdir()])
        self.assertFalse((include / "kernels/reference").exists())

    def test_arithmetic_is_handed_on(self):
        """A consumer of an exact build, and no other, compiles without fused multiply-add."""
        targets = (self.prefix / "lib/cmake/Drogue/DrogueTargets.cmake").read_text(encoding="utf-8")
        exact = cached("DROGUE_EXACT") == "ON"
        self.assertEqual(exact, "DROGUE_EXACT=1" in targets)
        self.assertEqual(exact, "-ffp-contract=off" in targets)

    def test_no_path_of_the_source_tree(self):
        for path in (self.prefix / "lib/cmake/Drogue").iterdir():
            text = path.read_text(encoding="utf-8")
            self.assertNotIn(f"{SOURCE}/cmake", text, path)
            for layer in ("common", "kernels", "miniapps"):
                self.assertNotIn(f"{SOURCE}/{layer}", text, path)


if __name__ == "__main__":
    unittest.main()
