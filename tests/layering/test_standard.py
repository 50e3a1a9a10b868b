"""Sources that take precompiled headers include the standard headers they use, and the check finds one that is missing."""

import os
import re
import unittest

import layers
import standard

ROOT = layers.repository(os.environ)
TEXTS = dict(layers.source_files(ROOT))


class Repository(unittest.TestCase):
    def test_sources_include_what_they_use(self):
        self.assertEqual([], [line for path in TEXTS for line in standard.missing(path, TEXTS)])

    def test_every_precompiled_header_is_checked(self):
        text = (ROOT / "cmake/DrogueOptions.cmake").read_text(encoding="utf-8")
        compiled = re.search(r"target_precompile_headers\(\$\{target\} PRIVATE ([^)]*)\)", text).group(1)
        self.assertLess(set(re.findall(r"<(\w+)>", compiled)), set(standard.NAMES))


class Check(unittest.TestCase):
    def missing(self, text, **others):
        return standard.missing("a.cpp", {"a.cpp": text, **{f"{name}.hpp": of_file for name, of_file in others.items()}})

    def test_use_without_header(self):
        self.assertEqual(["a.cpp uses std::sort without <algorithm>"], self.missing("#include <vector>\nstd::ranges::sort(v);\n"))

    def test_header_reached_through_own_headers(self):
        self.assertEqual([], self.missing('#include "b.hpp"\nstd::map<int, int> a;\n', b='#include "c.hpp"\n', c="#include <map>\n"))
        self.assertEqual(1, len(self.missing('#include "b.hpp"\nstd::map<int, int> a;\n', b="#include <list>\n")))

    def test_header_that_brings_another(self):
        self.assertEqual([], self.missing("#include <filesystem>\nstd::string a;\n"))

    def test_text_is_no_use(self):
        self.assertEqual([], self.missing('// std::sort\nconst char* a = "std::vector \\" std::map";\n'))
