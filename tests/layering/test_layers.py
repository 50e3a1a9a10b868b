"""The includes respect the layers, and each rule is shown to catch a breach."""

import os
import re
import unittest

import layers

ROOT = layers.repository(os.environ)
TEXTS = dict(layers.source_files(ROOT))


class Repository(unittest.TestCase):
    def refused(self, rule, places=("",)):
        """Asserts that no source below `places` breaks a rule of its path and text."""
        self.assertEqual([], [path for path, text in TEXTS.items() if path.startswith(places) and rule(path, text)])

    def test_includes_respect_the_layers(self):
        self.assertEqual([], layers.without_folder(TEXTS))
        self.assertEqual([], [line for path, text in TEXTS.items() for line in layers.violations(path, text)])

    def test_apps_reach_no_kokkos(self):
        """In a CUDA build Kokkos refuses a source that is not compiled by nvcc; the apps are not."""
        self.refused(lambda path, _: layers.reaches_kokkos(path, TEXTS), ("miniapps/", "common/"))

    def test_methods_for_options_share_no_part(self):
        """Each checks the other. What both include lies in no folder of a method."""
        mine, other = "kernels/options/cos/", ("pide", "levy", "grid", "transforms", "batch", "surface", "normalized_put.hpp")
        reached, rest = set(), [path for path in TEXTS if path.startswith(mine)]
        self.assertGreater(len(rest), 10)
        while rest:
            path = rest.pop()
            if path not in reached and path in TEXTS:
                reached.add(path)
                rest += [name for own, name in layers.includes(TEXTS[path]) if own]
        self.assertEqual([], [path for path in sorted(reached) if path.startswith(tuple(f"kernels/options/{name}" for name in other))])

    def test_sources_that_use_kokkos_include_it(self):
        self.refused(lambda path, _: layers.uses_kokkos_unseen(path, TEXTS), ("kernels/",))

    def test_headers_are_guarded(self):
        self.refused(lambda path, text: path.endswith(".hpp") and "#pragma once" not in text)

    def test_sources_show_that_their_header_compiles_alone(self):
        """The header test leaves those headers out."""
        self.refused(lambda path, text: layers.own_header_comes_late(path, text, TEXTS), ("common/", "kernels/", "miniapps/"))

    def test_kernels_in_cuda_have_their_folders(self):
        self.refused(layers.is_misplaced_cuda)

    def test_each_rung_of_a_ladder_is_one_file(self):
        for ladder in ("weno", "springs", "options", "transfers"):
            own = {path: text for path, text in TEXTS.items() if path.startswith(f"perf/ladders/{ladder}/") and path.endswith(".hpp")}
            names = {path: re.findall(r'RungText\{\s*"([^"]+)"', text) for path, text in own.items()}
            rungs = [(path.split("/")[-1], name.replace("-", "_") + ".hpp") for path, found in names.items() for name in found]
            self.assertEqual([], [rung for rung in rungs if rung[0] != rung[1]])
            self.assertEqual(len(re.findall("_rung<", TEXTS[f"perf/ladders/{ladder}/ladder.cpp"])), len(rungs), ladder)
            self.assertGreater(len(rungs), 3, ladder)


class EachRuleCatchesItsBreach(unittest.TestCase):
    def test_includes_that_a_layer_forbids(self):
        for path, include, word in (
            ("common/run/x.hpp", "<Kokkos_Core.hpp>", "does without"),
            ("common/run/x.hpp", '"kernels/gas/parameters.hpp"', "may only use"),
            ("kernels/reference/gas/x.hpp", "<Kokkos_Core.hpp>", "does without"),
            ("kernels/reference/gas/x.hpp", '"kernels/gas/flux/weno.hpp"', "may only use"),
            *(("kernels/gas/x.hpp", f"<{name}>", "does without")
              for name in ("toml++/toml.h", "CLI/App.hpp", "fstream", "hdf5.h", "mpi.h")),
            ("kernels/gas/x.hpp", '"common/program/failure.hpp"', "may only use"),
            ("kernels/gas/x.hpp", '"kernels/reference/gas/weno.hpp"', "independent"),
            ("kernels/linear/poisson/x.cpp", "<mpi.h>", "does without"),
            ("kernels/flow/halo/x.hpp", "<mpi.h>", "does without"),
            ("kernels/linear/parallel/x.cpp", "<Kokkos_Core.hpp>", "does without"),
            ("kernels/linear/poisson/hypre_x.cpp", "<fstream>", "does without"),
            ("miniapps/gas/x.cpp", '"miniapps/springs/scene/scene.hpp"', "may only use"),
            ("miniapps/gas/x.cpp", "<Kokkos_Core.hpp>", "does without"),
            ("miniapps/framework/x.cpp", '"kernels/gas/solver.hpp"', "may only use"),
            ("miniapps/framework/x.cpp", '"miniapps/gas/scene/scene.hpp"', "may only use"),
            ("miniapps/framework/x.cpp", "<Kokkos_Core.hpp>", "does without"),
            ("perf/x.cpp", '"miniapps/gas/main.hpp"', "no library"),
        ):
            found = layers.violations(path, f"#pragma once\n#include {include}\n")
            self.assertEqual(1, len(found), (path, include, found))
            self.assertIn(word, found[0])

    def test_includes_that_a_layer_allows(self):
        for path, include in (("kernels/linear/poisson/hypre_x.cpp", "<mpi.h>"), ("kernels/linear/parallel/x.cpp", "<mpi.h>"),
                              ("miniapps/gas/x.cpp", '"miniapps/framework/simulation.hpp"')):
            self.assertEqual([], layers.violations(path, f"#include {include}\n"))

    def test_layer_without_folder(self):
        files = [layer.place + "a.hpp" for layer in layers.LAYERS if layer.place != "perf/"]
        self.assertEqual(["perf/"], layers.without_folder(files))

    def test_cuda_outside_of_its_folders(self):
        kernel, launch = "__global__ void k();\n", "k<<<1, 32>>>();\n"
        for path, text in (("kernels/gas/x.hpp", kernel), ("perf/cases/x.cpp", launch), ("perf/ladders/weno/x.cu", "")):
            self.assertTrue(layers.is_misplaced_cuda(path, text), path)
        self.assertFalse(layers.is_misplaced_cuda("perf/raw/x.cu", kernel + launch))
        self.assertFalse(layers.is_misplaced_cuda("kernels/gas/x.hpp", "// as k<<<1, 32>>>()\nint a;\n"))

    def test_own_header_first(self):
        files = {"common/a.cpp", "common/a.hpp", "common/b.cpp"}
        own, other = '#include "common/a.hpp"\n', "#include <vector>\n"
        for path, text, late in (("a", own + other, False), ("a", other + own, True), ("a", other, True), ("b", other, False)):
            self.assertEqual(late, layers.own_header_comes_late(f"common/{path}.cpp", text, files))

    def test_chain_to_kokkos(self):
        texts = {"miniapps/gas/a.cpp": '#include "kernels/b.hpp"\n', "kernels/b.hpp": '#include "kernels/c.hpp"\n',
                 "kernels/c.hpp": "#include <Kokkos_Core.hpp>\n"}
        self.assertEqual([*texts, "<Kokkos_Core.hpp>"], layers.reaches_kokkos("miniapps/gas/a.cpp", texts))

    def test_kokkos_without_its_include(self):
        use = "int n = Kokkos::num_threads();\n"
        texts = {"kernels/a.hpp": use, "kernels/b.hpp": "#include <Kokkos_Core.hpp>\n" + use,
                 "kernels/c.hpp": '#include "kernels/b.hpp"\nKOKKOS_FUNCTION void f();\n', "kernels/d.hpp": "// Kokkos::View\n"}
        self.assertEqual(["kernels/a.hpp"], [path for path in texts if layers.uses_kokkos_unseen(path, texts)])
