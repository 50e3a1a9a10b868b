"""CMake takes releases of Kokkos that were tried, and refuses others in a sentence that names the way to try them."""

import os
import re
import subprocess
from pathlib import Path

from folder_test import FolderTest

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
SCRIPT = f"""
cmake_policy(VERSION 3.25)
find_package(Kokkos 4.5 CONFIG REQUIRED)
find_package(KokkosKernels 4.5 CONFIG REQUIRED)
include("{SOURCE}/cmake/DrogueCheckKokkos.cmake")
"""
CUDA = {"DROGUE_CUDA": "ON", "DROGUE_CUDA_ARCH_RESOLVED": "90", "Kokkos_ENABLE_CUDA": "ON", "Kokkos_CUDA_ARCHITECTURES": "90",
        "Kokkos_ENABLE_COMPILE_AS_CMAKE_LANGUAGE": "ON"}
OLD_VIEW = {"Kokkos_ENABLE_IMPL_VIEW_LEGACY": "ON"}
HIP = {"DROGUE_HIP": "ON", "Kokkos_ENABLE_HIP": "ON"}


class KokkosReleases(FolderTest):
    def package(self, name, version, settings):
        """Folder of a CMake package of this version that sets variables."""
        folder = self.folder / f"{name}-{version}"
        folder.mkdir(exist_ok=True)
        config = "".join(f"set({variable} {value})\n" for variable, value in settings.items())
        (folder / f"{name}Config.cmake").write_text(config, encoding="utf-8")
        (folder / f"{name}ConfigVersion.cmake").write_text(
            f'set(PACKAGE_VERSION "{version}")\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n', encoding="utf-8")
        return f"-D{name}_DIR={folder}"

    def check(self, version, settings=None, kernels=None):
        """What CMake says of a Kokkos of this version: nothing if it takes it."""
        script = self.folder / "script.cmake"
        script.write_text(SCRIPT, encoding="utf-8")
        packages = [self.package("Kokkos", version, {"Kokkos_ENABLE_SERIAL": "ON", "Kokkos_ARCH": "NATIVE", **(settings or {})}),
                    self.package("KokkosKernels", kernels or version, {})]
        result = subprocess.run(["cmake", *packages, "-P", script], capture_output=True, text=True)
        said = " ".join(result.stderr.split())
        self.assertEqual("CMake Error" in said, result.returncode != 0, said)
        return said

    def test_a_kokkos_for_no_processor_is_slow(self):
        for processors, is_slow in (("", True), ("HOPPER90", True), ("HOPPER90;NATIVE", False), ("SKX", False)):
            self.assertEqual("was built for no processor" in self.check("4.6.1", {"Kokkos_ARCH": f'"{processors}"'}), is_slow)

    def test_releases_of_the_page_are_taken(self):
        page = (SOURCE / "docs/building.md").read_text(encoding="utf-8")
        versions = re.findall(r"(?m)^\| (4\.[0-9.]+)(?: \| | \(shipped\))", page)
        shipped = re.search(r"(?m)^KOKKOS_VERSION=(.+)$", (SOURCE / "scripts/dependencies.env").read_text(encoding="utf-8"))[1]
        self.assertIn(f"\n| {shipped} (shipped) |", page)
        for version in versions:
            for settings in ({}, CUDA | OLD_VIEW, HIP):
                self.assertEqual("", self.check(version, settings))
        tried = re.search(r"was not tried, as (.+) were", self.check("5.0.0"))[1].split(", ")
        self.assertEqual(tried, [version.rpartition(".")[0] for version in versions])

    def test_untried_release(self):
        for version in ("4.8.0", "4.6.99", "5.1.1"):
            said = self.check(version)
            self.assertIn(f"Kokkos {version} in {self.folder}/Kokkos-{version} was not tried, as 4.5,", said)
            self.assertIn("or try it with -DDROGUE_UNTRIED_KOKKOS=ON.", said)
            self.assertEqual("", self.check(version, {"DROGUE_UNTRIED_KOKKOS": "ON"}))

    def test_kernels_of_another_release(self):
        said = self.check("4.7.0", kernels="4.5.1")
        self.assertIn(f"Kokkos Kernels 4.5.1 in {self.folder}/KokkosKernels-4.5.1 was not tried with Kokkos 4.7.0:", said)
        self.assertEqual("", self.check("4.7.0", {"DROGUE_UNTRIED_KOKKOS": "ON"}, kernels="4.5.1"))

    def test_patches_of_a_tried_release(self):
        for version in ("4.5.0", "4.7.4"):
            self.assertEqual("", self.check(version))

    def test_miscompiled_view(self):
        for settings in (CUDA, CUDA | {"DROGUE_UNTRIED_KOKKOS": "ON"}):
            self.assertIn("Kokkos 4.7.0 with nvcc and C++20 is miscompiled", self.check("4.7.0", settings))
