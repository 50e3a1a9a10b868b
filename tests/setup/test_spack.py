"""Versions, variants and packages of the Spack recipe and environment exist and are those of CMake."""

import ast
import os
import re
import unittest
from pathlib import Path

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
REPOSITORY = SOURCE / "scripts/spack/spack_repo/drogue"
RECIPE = ast.parse((REPOSITORY / "packages/drogue/package.py").read_text(encoding="utf-8"))
CMAKE = "".join(path.read_text(encoding="utf-8") for path in sorted((SOURCE / "cmake").glob("*.cmake")))
# Variants of Spack's package kokkos (spack/spack-packages, packages/kokkos/package.py): those with two values, and others.
BOOLEAN = {"serial", "openmp", "cuda", "wrapper", "cmake_lang", "pic", "shared"}
VALUED = {"cxxstd", "cuda_arch"}


def calls(name):
    """Positional and keyword texts of the calls of a directive; a name in an f-string becomes {}."""

    def text(node):
        if isinstance(node, ast.JoinedStr):
            return "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
        return node.value if isinstance(node, ast.Constant) else None

    for node in ast.walk(RECIPE):
        if isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", "")) == name:
            yield [text(argument) for argument in node.args], {k.arg: text(k.value) for k in node.keywords}


def package(spec):
    return re.match(r"[a-z0-9-]+", spec)[0]


def specs():
    """Specs that the recipe depends on, by package."""
    found = {}
    for (spec, *_), _ in calls("depends_on"):
        found.setdefault(package(spec), []).append(spec)
    return found


def with_two_digits(version):
    """A version of Kokkos as Spack writes it, with its patch in two digits."""
    return re.sub(r"\.(\d)$", r".0\1", version)


class Spack(unittest.TestCase):
    def test_layout_is_that_of_spack_1(self):
        text = (REPOSITORY / "repo.yaml").read_text(encoding="utf-8")
        self.assertRegex(text, r"(?m)^repo:\n  namespace: drogue\n  api: v2\.\d+$")
        # The namespace is a module spack_repo.drogue, and build systems are no part of spack.package.
        self.assertEqual(("spack_repo", "drogue"), REPOSITORY.parts[-2:])
        modules = {node.module for node in ast.walk(RECIPE) if isinstance(node, ast.ImportFrom)}
        self.assertLessEqual({"spack_repo.builtin.build_systems.cmake", "spack_repo.builtin.build_systems.cuda"}, modules)

    def test_variants_of_kokkos_exist(self):
        for spec in specs()["kokkos"]:
            for sign, name in re.findall(r"([+~])([a-z_]+)", spec):
                self.assertIn(name, BOOLEAN, f"{sign}{name} in {spec}")
            for name in re.findall(r"([a-z_]+)=", spec):
                self.assertIn(name, VALUED, spec)

    def test_cuda_compiles_in_the_language_of_cmake(self):
        self.assertIn("Kokkos_ENABLE_COMPILE_AS_CMAKE_LANGUAGE", CMAKE)
        cuda, = (spec for spec in specs()["kokkos"] if "+cuda" in spec)
        self.assertIn("+cmake_lang", cuda)
        self.assertIn("~wrapper", cuda)

    def test_architectures_are_those_of_the_build(self):
        page = (SOURCE / "docs/building.md").read_text(encoding="utf-8")
        listed = re.search(r"`DROGUE_CUDA_ARCH` \| `90` \| ([0-9, ]+) or", page)[1]
        loop, = (node for node in ast.walk(RECIPE) if isinstance(node, ast.For))
        self.assertEqual(listed.split(", "), [item.value for item in loop.iter.elts])

    def test_versions_are_those_of_cmake(self):
        tried = re.search(r"(?m)^set\(DROGUE_TRIED_KOKKOS ([0-9. ]+)\)$", CMAKE)[1].split()
        for name in ("kokkos", "kokkos-kernels"):
            for spec in (next(spec for spec in specs()[name] if "@" in spec), self.environment()[name]):
                self.assertEqual([with_two_digits(version) for version in tried], re.search(r"@([0-9.,]+)", spec)[1].split(","))
        minimum = re.search(r"cmake_minimum_required\(VERSION ([0-9.]+)\)", (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
        self.assertIn(f"cmake@{minimum}:", specs()["cmake"])

    def test_recipe_refuses_the_miscompiled_release(self):
        release = re.search(r'Kokkos_VERSION VERSION_GREATER_EQUAL "([0-9.]+)"', CMAKE)[1]
        self.assertIn("^kokkos@" + with_two_digits(release), [spec for (spec, *_), _ in calls("conflicts")])

    def test_python_packages_are_those_of_the_pictures(self):
        wanted = (SOURCE / "scripts/requirements.txt").read_text(encoding="utf-8").split("# what the above pull in")[0]
        names = set(re.findall(r"(?m)^([a-z0-9-]+)==", wanted))
        # For MP4 films alone; drogue-plot names it where it lacks.
        names.remove("imageio-ffmpeg")
        self.assertGreaterEqual(names, {"numpy", "matplotlib", "h5py", "jinja2", "pillow"})
        for name in names:
            self.assertIn("py-" + name, specs())
            self.assertIn("py-" + name, self.environment())

    def environment(self):
        """Specs of spack.yaml by package."""
        lines = re.findall(r"(?m)^    - (.+)$", (SOURCE / "spack.yaml").read_text(encoding="utf-8"))
        return {package(line): line for line in lines}

    def test_environment_and_recipe_agree(self):
        tools = {"ninja", "c", "cxx"}
        self.assertEqual(set(specs()) - tools, set(self.environment()) - tools)

    def test_options_exist(self):
        for arguments, _ in [*calls("define"), *calls("define_from_variant")]:
            if package := re.fullmatch("CMAKE_DISABLE_FIND_PACKAGE_(.+)", arguments[0]):
                self.assertIn(f"find_package({package[1]}", CMAKE)
            elif not arguments[0].startswith(("BUILD_TESTING", "CMAKE_")):
                self.assertRegex(CMAKE, rf"\b{arguments[0]}\b")
