"""The includes respect the layers, and each rule is shown to catch a breach."""

import os
import unittest

import layers

ROOT = layers.repository(os.environ)
TEXTS = dict(layers.source_files(ROOT))


class Repository(unittest.TestCase):
    def test_sources_are_found(self):
        for place in ("common/", "kernels/gas/", "kernels/reference/", "miniapps/gas/", "tests/"):
            self.assertTrue(any(path.startswith(place) for path in TEXTS), place)

    def test_includes_respect_the_layers(self):
        self.assertEqual([], [line for path, text in TEXTS.items() for line in layers.violations(path, text)])

    def test_apps_reach_no_kokkos(self):
        """In a CUDA build Kokkos refuses a source that is not compiled by nvcc; the apps are not."""
        for path in TEXTS:
            if path.startswith(("miniapps/", "common/")):
                self.assertEqual([], layers.reaches_kokkos(path, TEXTS))

    def test_methods_for_options_share_no_part(self):
        """Each checks the other. What both include lies in no folder of a method."""
        mine, other = "kernels/options/cos/", ("pide", "levy", "grid", "transforms", "batch", "surface", "normalized_put.hpp")
        reached, rest = set(), [path for path in TEXTS if path.startswith(mine)]
        self.assertGreater(len(rest), 10)
        while rest:
            path = rest.pop()
            if path in reached or path not in TEXTS:
                continue
            reached.add(path)
            rest += [name for own, name in layers.includes(TEXTS[path]) if own]
        self.assertEqual([], [path for path in sorted(reached) if path.startswith(tuple(f"kernels/options/{name}" for name in other))])

    def test_sources_that_use_kokkos_include_it(self):
        self.assertEqual([], [path for path in TEXTS
                              if path.startswith("kernels/") and layers.uses_kokkos_unseen(path, TEXTS)])

    def test_own_includes_exist(self):
        missing = [
            f"{path}: {name}"
            for path, text in TEXTS.items()
            for own, name in layers.includes(text)
            if own and name not in TEXTS and not (ROOT / path).parent.joinpath(name).exists()
        ]
        self.assertEqual([], missing)

    def test_headers_are_guarded(self):
        self.assertEqual([], [p for p, t in TEXTS.items() if p.endswith(".hpp") and "#pragma once" not in t])

    def test_sources_show_that_their_header_compiles_alone(self):
        """The header test leaves those headers out."""
        places = ("common/", "kernels/", "miniapps/")
        self.assertEqual([], [p for p, t in TEXTS.items() if p.startswith(places)
                              and layers.own_header_comes_late(p, t, TEXTS)])

    def test_kernels_in_cuda_have_their_folders(self):
        self.assertEqual([], [path for path, text in TEXTS.items() if layers.is_misplaced_cuda(path, text)])

    def test_every_layer_has_its_folder(self):
        self.assertEqual([], layers.without_folder(TEXTS))


class EachRuleCatchesItsBreach(unittest.TestCase):
    def assert_caught(self, path, include, word):
        found = layers.violations(path, f"#pragma once\n#include {include}\n")
        self.assertEqual(1, len(found), found)
        self.assertIn(word, found[0])

    def test_common_includes_neither_kokkos_nor_kernels(self):
        self.assert_caught("common/run/x.hpp", "<Kokkos_Core.hpp>", "does without")
        self.assert_caught("common/run/x.hpp", '"kernels/gas/parameters.hpp"', "may only use")

    def test_reference(self):
        self.assert_caught("kernels/reference/gas/x.hpp", "<Kokkos_Core.hpp>", "does without")
        self.assert_caught("kernels/reference/gas/x.hpp", '"kernels/gas/flux/weno.hpp"', "may only use")

    def test_kernels_include_no_mini_app(self):
        for library in ("<toml++/toml.h>", "<CLI/App.hpp>", "<fstream>", "<hdf5.h>", "<mpi.h>"):
            self.assert_caught("kernels/gas/x.hpp", library, "does without")
        self.assert_caught("kernels/gas/x.hpp", '"common/program/failure.hpp"', "may only use")
        self.assert_caught("kernels/gas/x.hpp", '"kernels/reference/gas/weno.hpp"', "independent")

    def test_mpi_stands_behind_one_class_and_hypre(self):
        for path in ("kernels/linear/poisson/hypre_x.cpp", "kernels/linear/parallel/x.cpp"):
            self.assertEqual([], layers.violations(path, "#include <mpi.h>\n"))
        for path in ("kernels/linear/poisson/x.cpp", "kernels/flow/halo/x.hpp"):
            self.assert_caught(path, "<mpi.h>", "does without")
        self.assert_caught("kernels/linear/parallel/x.cpp", "<Kokkos_Core.hpp>", "does without")
        self.assert_caught("kernels/linear/poisson/hypre_x.cpp", "<fstream>", "does without")

    def test_layer_without_folder(self):
        files = [
            "common/a.hpp",
            "kernels/gas/a.hpp",
            "kernels/linear/parallel/a.cpp",
            "kernels/linear/poisson/hypre_a.cpp",
            "kernels/reference/gas/a.hpp",
            "miniapps/framework/a.hpp",
        ]
        self.assertEqual(["perf/"], layers.without_folder(files))

    def test_miniapps(self):
        self.assert_caught("miniapps/gas/x.cpp", '"miniapps/springs/scene/scene.hpp"', "may only use")
        self.assert_caught("miniapps/gas/x.cpp", "<Kokkos_Core.hpp>", "does without")

    def test_cuda_outside_of_its_folders(self):
        kernel, launch = "__global__ void k();\n", "k<<<1, 32>>>();\n"
        for path, text in (("kernels/gas/x.hpp", kernel), ("perf/cases/x.cpp", launch), ("perf/ladders/weno/x.cu", "")):
            self.assertTrue(layers.is_misplaced_cuda(path, text), path)
        self.assertFalse(layers.is_misplaced_cuda("perf/raw/x.cu", kernel + launch))
        self.assertFalse(layers.is_misplaced_cuda("kernels/gas/x.hpp", "// as k<<<1, 32>>>()\nint a;\n"))

    def test_framework(self):
        path = "miniapps/framework/x.cpp"
        self.assert_caught(path, '"kernels/gas/solver.hpp"', "may only use")
        self.assert_caught(path, '"miniapps/gas/scene/scene.hpp"', "may only use")
        self.assert_caught(path, "<Kokkos_Core.hpp>", "does without")
        for app in ("gas", "springs"):
            self.assertEqual([], layers.violations(f"miniapps/{app}/x.cpp", '#include "miniapps/framework/simulation.hpp"\n'))

    def test_own_header_first(self):
        files = {"common/a.cpp", "common/a.hpp", "common/b.cpp"}
        own, other = '#include "common/a.hpp"\n', "#include <vector>\n"
        self.assertFalse(layers.own_header_comes_late("common/a.cpp", own + other, files))
        self.assertTrue(layers.own_header_comes_late("common/a.cpp", other + own, files))
        self.assertTrue(layers.own_header_comes_late("common/a.cpp", other, files))
        self.assertFalse(layers.own_header_comes_late("common/b.cpp", other, files))

    def test_chain_to_kokkos(self):
        texts = {
            "miniapps/gas/a.cpp": '#include "kernels/b.hpp"\n',
            "kernels/b.hpp": '#include "kernels/c.hpp"\n',
            "kernels/c.hpp": "#include <Kokkos_Core.hpp>\n",
        }
        chain = layers.reaches_kokkos("miniapps/gas/a.cpp", texts)
        self.assertEqual(["miniapps/gas/a.cpp", "kernels/b.hpp", "kernels/c.hpp", "<Kokkos_Core.hpp>"], chain)

    def test_kokkos_without_its_include(self):
        use = "int n = Kokkos::num_threads();\n"
        texts = {"kernels/a.hpp": use, "kernels/b.hpp": "#include <Kokkos_Core.hpp>\n" + use,
                 "kernels/c.hpp": '#include "kernels/b.hpp"\nKOKKOS_FUNCTION void f();\n', "kernels/d.hpp": "// Kokkos::View\n"}
        self.assertEqual(["kernels/a.hpp"], [path for path in texts if layers.uses_kokkos_unseen(path, texts)])


if __name__ == "__main__":
    unittest.main()
