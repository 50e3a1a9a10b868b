"""Tests, of which several are compiled as one, include the headers of the types they use, and the check finds one that is missing."""

import os
import unittest

import layers
import own

TEXTS = dict(layers.source_files(layers.repository(os.environ)))


class Repository(unittest.TestCase):
    def test_sources_include_the_types_they_use(self):
        headers = own.headers_of_types(TEXTS)
        self.assertGreater(len(headers), 500)
        self.assertEqual([], [line for path in TEXTS for line in own.missing(path, TEXTS, headers)])


class Check(unittest.TestCase):
    def missing(self, text, **others):
        texts = {"a.cpp": text, "b.hpp": "class Solver {};\nstruct Part;\n", "c.hpp": '#include "b.hpp"\n',
                 **{f"{name}.hpp": of_file for name, of_file in others.items()}}
        return own.missing("a.cpp", texts, own.headers_of_types(texts))

    def test_use_without_header(self):
        self.assertEqual(['a.cpp uses Solver without "b.hpp"'], self.missing("Solver s;\n"))

    def test_header_reached_through_own_headers(self):
        self.assertEqual([], self.missing('#include "c.hpp"\nSolver s;\n'))

    def test_name_of_two_types_is_left_out(self):
        self.assertEqual([], self.missing("Solver s;\n", d="template <class Solver> void run(Solver);\n"))

    def test_text_suites_and_members_are_no_use(self):
        self.assertEqual([], self.missing('// Solver\nTEST(Solver, Steps) { f("Solver", R"(a "Solver")", x.Solver, Kokkos::Solver); }\n'))
