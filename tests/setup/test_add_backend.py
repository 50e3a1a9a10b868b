# ctest-label: no-sanitizer
"""The steps of docs/adding-a-backend.md, done in a copy of the sources, add a backend that configures."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
BUILD = Path(os.environ.get("DROGUE_BUILD", SOURCE / "build/host"))
PATCH = re.compile(r"^```diff\n# (\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CACHE = dict(re.findall(r"^(\w+):\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))


def apply(patch, text):
    """The text after a patch, each of whose hunks fits in one place."""
    for hunk in patch.split("@@\n"):
        lines = hunk.splitlines(keepends=True)
        before = "".join(line[1:] for line in lines if line[0] != "+")
        after = "".join(line[1:] for line in lines if line[0] != "-")
        if text.count(before) != 1:
            raise AssertionError(f"fits in {text.count(before)} places:\n{before}")
        text = text.replace(before, after)
    return text


@unittest.skipIf("ON" in (CACHE.get("DROGUE_CUDA"), CACHE.get("DROGUE_HIP")), "the Kokkos of a build for a device needs its option")
class AddBackend(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.work = Path(folder.name)
        cls.tree = cls.work / "tree"
        cls.tree.mkdir()
        for name in ("common", "kernels", "miniapps", "perf", "tests", "cmake", "scripts"):
            shutil.copytree(SOURCE / name, cls.tree / name, ignore=shutil.ignore_patterns("__pycache__", "node_modules"))
        for name in ("CMakeLists.txt", "CMakePresets.json"):
            shutil.copy(SOURCE / name, cls.tree)
        page = (SOURCE / "docs/adding-a-backend.md").read_text(encoding="utf-8")
        cls.patched = []
        for name, patch in PATCH.findall(page):
            path = cls.tree / name
            path.write_text(apply(patch, path.read_text(encoding="utf-8")), encoding="utf-8")
            cls.patched.append(name)
        cls.sentence = re.search(r"^The backend sycl needs a Kokkos with Kokkos_ENABLE_SYCL=ON", page, re.MULTILINE).group()

    def configure(self, kokkos):
        command = ["cmake", "-S", self.tree, "-B", self.work / f"build-{kokkos.name}", "-G", "Ninja", "-DDROGUE_SYCL=ON",
                   f"-DKokkos_DIR={kokkos}", f"-DKokkosKernels_DIR={CACHE['KokkosKernels_DIR']}", "-DDROGUE_HEADER_TEST=OFF"]
        return subprocess.run(command, capture_output=True, text=True)

    def kokkos_with_sycl(self):
        """Folder of a package that is the Kokkos of this build and claims to have SYCL."""
        folder = self.work / "Kokkos-sycl"
        folder.mkdir(exist_ok=True)
        real = CACHE["Kokkos_DIR"]
        (folder / "KokkosConfig.cmake").write_text(f'include("{real}/KokkosConfig.cmake")\nset(Kokkos_ENABLE_SYCL ON)\n', encoding="utf-8")
        (folder / "KokkosConfigVersion.cmake").write_text(f'include("{real}/KokkosConfigVersion.cmake")\n', encoding="utf-8")
        return folder

    def test_patches_are_found(self):
        self.assertEqual(["cmake/DrogueBackends.cmake", "kernels/device/backend_list.hpp", "kernels/device/backend.cpp",
                          "CMakePresets.json"], self.patched)

    def test_kokkos_without_the_backend_is_refused(self):
        result = self.configure(Path(CACHE["Kokkos_DIR"]))
        self.assertNotEqual(0, result.returncode)
        self.assertIn(self.sentence, " ".join(result.stderr.split()))

    def test_backend_gets_instances_tests_and_its_name(self):
        result = self.configure(self.kokkos_with_sycl())
        self.assertEqual(0, result.returncode, result.stderr)
        build = self.work / "build-Kokkos-sycl"
        instance = (build / "generated/kernels/gas/instances/stage_sycl.cpp").read_text(encoding="utf-8")
        self.assertIn("#define DROGUE_INSTANCE_SPACE Kokkos::SYCL", instance)
        targets = subprocess.run(["ninja", "-C", build, "-t", "targets", "all"], capture_output=True, text=True, check=True).stdout
        self.assertIn("gas_kernels_test_sycl:", targets)
        self.assertNotIn("gas_kernels_test_serial:", targets)
        version = (build / "generated/common/version.cpp.in").read_text(encoding="utf-8")
        self.assertIn('.known_backends = "serial openmp hip cuda sycl"', version)

    def test_lists_that_differ_are_refused(self):
        header = self.tree / "kernels/device/backend_list.hpp"
        text = header.read_text(encoding="utf-8")
        self.addCleanup(header.write_text, text, encoding="utf-8")
        for old, new in (('name = "sycl"', 'name = "oneapi"'), ("needs_device = true", "needs_device = false"),
                         ("ExecutionSpace = Kokkos::SYCL", "ExecutionSpace = Kokkos::Cuda")):
            self.assertIn(old, text)
            header.write_text(text.replace(old, new), encoding="utf-8")
            result = self.configure(self.kokkos_with_sycl())
            self.assertNotEqual(0, result.returncode)
            self.assertIn("Make both lists agree", " ".join(result.stderr.split()))

    def test_list_of_the_sources_has_the_backend(self):
        source = self.work / "list.cpp"
        source.write_text("""
            #include "kernels/device/backend_list.hpp"
            using namespace drogue::device;
            static_assert(std::tuple_size_v<CompiledBackends> == 2);
            static_assert(std::tuple_element_t<1, CompiledBackends>::name == "sycl");
            static_assert(backend_of<Kokkos::SYCL> == Backend::sycl);
            static_assert(needs_device(Backend::sycl) && !needs_device(Backend::serial));
        """, encoding="utf-8")
        command = [CACHE["CMAKE_CXX_COMPILER"], "-std=c++20", "-fsyntax-only", "-I", self.tree, "-DDROGUE_HAVE_SERIAL=1",
                   "-DDROGUE_HAVE_SYCL=1", source]
        result = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(0, result.returncode, result.stderr)

    def test_presets_are_sound(self):
        presets = subprocess.run(["cmake", "--list-presets"], cwd=self.tree, capture_output=True, text=True)
        self.assertEqual(0, presets.returncode, presets.stderr)
        self.assertIn('"sycl"', presets.stdout)


class Patches(unittest.TestCase):
    def test_hunks_that_fit(self):
        self.assertEqual("a\nx\nc\nd\ny\n", apply(" a\n-b\n+x\n@@\n d\n+y\n", "a\nb\nc\nd\n"))

    def test_hunk_that_fits_nowhere_or_twice(self):
        for text in ("a\n", "b\nb\n"):
            with self.assertRaisesRegex(AssertionError, "places"):
                apply(" b\n+x\n", text)
