"""CMake takes releases of Kokkos that were tried, from where they are named, and refuses others in a sentence with the remedy."""

import os
import re
import subprocess
from pathlib import Path

from folder_test import FolderTest

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
SCRIPT = f"""
cmake_policy(VERSION 3.25)
list(APPEND CMAKE_PREFIX_PATH "${{SHIPPED}}")
include("{SOURCE}/cmake/DrogueFindKokkos.cmake")
message(STATUS "Kokkos in ${{Kokkos_DIR}}, Kokkos Kernels in ${{KokkosKernels_DIR}}")
"""
CUDA = {"DROGUE_CUDA": "ON", "DROGUE_CUDA_ARCH_RESOLVED": "90", "Kokkos_ENABLE_CUDA": "ON", "Kokkos_CUDA_ARCHITECTURES": "90",
        "Kokkos_ENABLE_COMPILE_AS_CMAKE_LANGUAGE": "ON"}
OLD_VIEW = {"Kokkos_ENABLE_IMPL_VIEW_LEGACY": "ON"}
HIP = {"DROGUE_HIP": "ON", "Kokkos_ENABLE_HIP": "ON"}


class KokkosReleases(FolderTest):
    def package(self, name, version, settings, prefix=None):
        """Folder of a CMake package of this version that sets variables."""
        folder = prefix / "lib/cmake" / name if prefix else self.folder / f"{name}-{version}"
        folder.mkdir(exist_ok=True, parents=True)
        config = "".join(f"set({variable} {value})\n" for variable, value in settings.items())
        (folder / f"{name}Config.cmake").write_text(config, encoding="utf-8")
        (folder / f"{name}ConfigVersion.cmake").write_text(
            f'set(PACKAGE_VERSION "{version}")\nif(NOT PACKAGE_VERSION VERSION_LESS PACKAGE_FIND_VERSION)\n'
            "  set(PACKAGE_VERSION_COMPATIBLE TRUE)\nendif()\n", encoding="utf-8")
        return f"-D{name}_DIR={folder}"

    def prefix(self, version, kernels=None):
        """Prefix of an installation of Kokkos and, of this or another version, Kokkos Kernels."""
        prefix = self.folder / f"prefix-{version}-{kernels}"
        self.package("Kokkos", version, {"Kokkos_ENABLE_SERIAL": "ON", "Kokkos_ARCH": "NATIVE"}, prefix)
        self.package("KokkosKernels", kernels or version, {}, prefix)
        return prefix

    def cmake(self, *arguments, **environment):
        """What CMake says on standard error in one line, and on standard output."""
        script = self.folder / "script.cmake"
        script.write_text(SCRIPT, encoding="utf-8")
        result = subprocess.run(["cmake", *arguments, "-P", script], env=os.environ | environment, capture_output=True, text=True)
        said = " ".join(result.stderr.split())
        self.assertEqual("CMake Error" in said, result.returncode != 0, said)
        return said, result.stdout

    def check(self, version, settings=None, kernels=None):
        """What CMake says of a Kokkos of this version: nothing if it takes it."""
        packages = [self.package("Kokkos", version, {"Kokkos_ENABLE_SERIAL": "ON", "Kokkos_ARCH": "NATIVE", **(settings or {})}),
                    self.package("KokkosKernels", kernels or version, {})]
        return self.cmake(*packages)[0]

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
        self.assertEqual(tried, versions)

    def test_untried_release(self):
        for version in ("4.5.0", "4.6.99", "4.7.1", "4.8.0", "5.1.1"):
            said = self.check(version)
            self.assertIn(f"Kokkos {version} in {self.folder}/Kokkos-{version} was not tried, as 4.5.1,", said)
            self.assertIn("or try it with -DDROGUE_UNTRIED_KOKKOS=ON.", said)
            self.assert_warns(version, {"DROGUE_UNTRIED_KOKKOS": "ON"})
        self.assertIn("nvcc miscompiled in 4.7.0", self.assert_warns("5.1.1", CUDA | {"DROGUE_UNTRIED_KOKKOS": "ON"}))

    def assert_warns(self, version, settings, **more):
        said = " ".join(self.check(version, settings, **more).split())
        self.assertIn(f"Kokkos {version} with Kokkos Kernels", said)
        self.assertIn("was not tried.", said)
        self.assertNotIn("CMake Error", said)
        return said

    def test_kernels_of_another_release(self):
        said = self.check("4.7.0", kernels="4.5.1")
        self.assertIn(f"Kokkos Kernels 4.5.1 in {self.folder}/KokkosKernels-4.5.1 was not tried with Kokkos 4.7.0:", said)
        self.assert_warns("4.7.0", {"DROGUE_UNTRIED_KOKKOS": "ON"}, kernels="4.5.1")

    def test_miscompiled_view(self):
        for settings in (CUDA, CUDA | {"DROGUE_UNTRIED_KOKKOS": "ON"}):
            self.assertIn("has the mdspan View, which nvcc miscompiles as C++20", self.check("4.7.0", settings))

    def test_set_up_is_a_remedy_for_its_own_kokkos_alone(self):
        prefix = self.prefix("4.6.1")
        for settings, remedy, command in (
            (CUDA | {"Kokkos_CUDA_ARCHITECTURES": "80"}, "configure with -DDROGUE_CUDA_ARCH=80, or point Kokkos_ROOT at one for 90",
             "DROGUE_CUDA_ARCH=90 scripts/setup.sh"),
            ({"DROGUE_CUDA": "ON"}, "point Kokkos_ROOT at a CUDA build", "scripts/setup.sh where nvcc is installed"),
            ({"DROGUE_HIP": "ON"}, "point Kokkos_ROOT at a HIP build", "scripts/setup.sh --hip"),
        ):
            arguments = [f"-D{name}={value}" for name, value in settings.items()]
            self.assertIn(f": {remedy}, or run {command}.", self.cmake(f"-DSHIPPED={prefix}", *arguments)[0])
            for named in ([f"-DKokkos_ROOT={prefix}"], [f"-DSHIPPED={prefix}", "-DDROGUE_SYSTEM=ON"]):
                self.assertIn(f": {remedy}. ", self.cmake(*named, *arguments)[0] + " ")

    def test_named_installation_comes_before_the_shipped_one(self):
        shipped, own = self.prefix("4.5.1"), self.prefix("4.6.1")
        taken = f"Kokkos in {own}/lib/cmake/Kokkos, Kokkos Kernels in {own}/lib/cmake/KokkosKernels"
        stale = [f"-DKokkos_DIR={shipped}/lib/cmake/Kokkos", f"-DDROGUE_FOUND_Kokkos={shipped}/lib/cmake/Kokkos"]
        roots = [f"-DKokkos_ROOT={own}", f"-DKokkosKernels_ROOT={own}"]
        for arguments, environment in (
            (roots, {}), (roots[:1], {}), ([*roots, *stale], {}), ([], {"Kokkos_ROOT": str(own), "KokkosKernels_ROOT": str(own)}),
            ([f"-D{name}_DIR={own}/lib/cmake/{name}" for name in ("Kokkos", "KokkosKernels")], {"Kokkos_ROOT": str(shipped)}),
        ):
            said, output = self.cmake(f"-DSHIPPED={shipped}", *arguments, **environment)
            self.assertEqual("", said)
            self.assertIn(taken, output)

    def test_shipped_installation_is_found(self):
        shipped = self.prefix("4.5.1")
        for arguments in ([], ["-DKokkos_ROOT="], [f"-DKokkos_DIR={self.folder}/gone", f"-DDROGUE_FOUND_Kokkos={self.folder}/gone"]):
            said, output = self.cmake(f"-DSHIPPED={shipped}", *arguments)
            self.assertEqual("", said)
            self.assertIn(f"Kokkos in {shipped}/lib/cmake/Kokkos,", output)

    def test_named_installation_that_cannot_be_used_is_not_replaced(self):
        shipped, old = self.prefix("4.5.1"), self.prefix("4.4.1")
        nowhere, config = self.folder / "nowhere", "lib/cmake/Kokkos"
        for setting in (f"Kokkos_ROOT={nowhere}", f"Kokkos_DIR={nowhere}"):
            said = self.cmake(f"-DSHIPPED={shipped}", f"-D{setting}")[0]
            self.assertIn(f"{setting} cannot be used: there is no KokkosConfig.cmake; every kernel needs Kokkos", said)
            self.assertIn("or leave it empty for that of scripts/setup.sh.", said)
            said = self.cmake(f"-DSHIPPED={shipped}", f"-D{setting}", "-DDROGUE_SYSTEM=ON")[0]
            self.assertIn("Point Kokkos_ROOT at the prefix of such a release (docs/building.md#kokkos-of-a-module).", said)
        self.assertIn(f"Kokkos_ROOT={nowhere} cannot be used", self.cmake(f"-DSHIPPED={shipped}", Kokkos_ROOT=str(nowhere))[0])
        for setting in (f"Kokkos_ROOT={old}", f"Kokkos_DIR={old}/{config}"):
            self.assertIn(f"{setting} cannot be used: Kokkos 4.4.1 in {old}/{config} is too old;",
                          self.cmake(f"-DSHIPPED={shipped}", f"-D{setting}")[0])
        said = self.cmake(f"-DSHIPPED={shipped}", f"-DKokkosKernels_ROOT={old}")[0]
        self.assertIn(f"KokkosKernels_ROOT={old} cannot be used: Kokkos Kernels 4.4.1 in {old}/lib/cmake/KokkosKernels is too old;", said)

    def test_too_old_and_missing_ones_are_named(self):
        old = self.prefix("4.4.1")
        system = ["-DDROGUE_SYSTEM=ON", "-DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF", "-DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF"]
        said = self.cmake(*system, f"-DSHIPPED={old}")[0]
        self.assertIn(f"Kokkos 4.4.1 in {old}/lib/cmake/Kokkos is too old; every kernel needs Kokkos, of which 4.5.1, 4.6.1, 4.7.0 "
                      "were tried. Point Kokkos_ROOT at the prefix of such a release (docs/building.md#kokkos-of-a-module).", said)
        said = self.cmake(*system)[0]
        self.assertIn("Kokkos was not found; every kernel needs", said)
        self.assertNotIn("setup.sh", said)
        self.assertIn("or run scripts/setup.sh.", self.cmake(*system, "-DDROGUE_SYSTEM=OFF")[0])
        newer = self.prefix("4.6.1", kernels="4.4.1")
        said = self.cmake(*system, f"-DSHIPPED={newer}")[0]
        self.assertIn(f"Kokkos Kernels 4.4.1 in {newer}/lib/cmake/KokkosKernels is too old; batched linear algebra needs Kokkos "
                      f"Kernels 4.6.1, the release of Kokkos in {newer}/lib/cmake/Kokkos.", said)
