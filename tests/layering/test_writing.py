"""The tree keeps the rules of writing, and each rule is shown to catch a breach. One test per rule."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import layers
import writing

ROOT = layers.repository(os.environ)
TEXTS = {path: text for path, text in writing.read_tree(
    ROOT, ("common", "kernels", "miniapps", "perf", "tests", "scripts", "docs", "cmake", "README.md", "CONTRIBUTING.md",
           "CHANGELOG.md")).items() if path not in writing.OWN}


class Repository(unittest.TestCase):
    maxDiff = None

    def breaches(self, rule):
        return [line for path, text in TEXTS.items() for line in rule(path, text)]

    def test_sources_are_found(self):
        for folder in ("common/", "kernels/", "miniapps/", "perf/", "tests/", "scripts/", "docs/", "cmake/"):
            self.assertTrue(any(path.startswith(folder) for path in TEXTS), folder)

    def test_comments_open_with_a_noun_or_a_verb(self):
        self.assertEqual([], self.breaches(writing.refused_openings))

    def test_comments_do_not_personify(self):
        self.assertEqual([], self.breaches(writing.personified))

    def test_names_of_tests_assert(self):
        self.assertEqual([], self.breaches(writing.riddles))

    def test_prose_wraps(self):
        self.assertEqual([], self.breaches(writing.wide_lines))

    def test_no_replaced_name_is_left(self):
        self.assertEqual([], self.breaches(writing.replaced_names))

    def test_no_replaced_word_is_left(self):
        self.assertEqual([], self.breaches(writing.replaced_words))

    def test_messages_are_clear(self):
        self.assertEqual([], self.breaches(writing.unclear_strings))

    def test_rates_are_per_unit(self):
        self.assertEqual([], self.breaches(writing.rates_with_an_article))

    def test_kept_keys_are_used_and_explained(self):
        glossary = TEXTS["docs/glossary.md"]
        for word, places in writing.KEPT.items():
            used = [path for path, text in TEXTS.items() if path.startswith(places) and not path.startswith("tests/")
                    and path.endswith(writing.CODE) and word in [words for _, words in writing.strings(text)]]
            self.assertTrue(used, word)
            self.assertTrue(re.search(rf"\b{word}\b", glossary), word)

    def test_public_headers_state_units_and_errors(self):
        public = set(writing.public_headers(TEXTS))
        self.assertGreater(len(public), 10)
        self.assertEqual([], [line for path in sorted(public)
                              for line in writing.missing_contracts(path, TEXTS[path], TEXTS.get(writing.FACADES.get(path), ""))])


class EachRuleCatchesItsBreach(unittest.TestCase):
    def test_openings_of_code(self):
        for opening in ("What is slack", "Of what has none", "That which is", "Those of a put", "The same of a vertex"):
            for text in (f"/// {opening}.\nint f();\n", f"/** {opening}. */\nint f();\n", f"int a;  ///< {opening}\n"):
                self.assertEqual(1, len(writing.refused_openings("kernels/a.hpp", text)), text)
        good = "/// Position of a vertex, m.\n/// What follows is the second line of it.\nint f();"
        self.assertEqual([], writing.refused_openings("kernels/a.hpp", good))
        self.assertEqual([], writing.refused_openings("kernels/a.hpp", "/// Whatever works, offset by one.\n"))

    def test_openings_of_plain_comments(self):
        self.assertEqual([], writing.refused_openings("a.hpp", "// The same order as in the oracle.\n"))
        for path, text in (("a.hpp", "// What computes.\n"), ("a.hpp", "int a;  // Of what has none\n"), ("a.py", "# What computes.\n"),
                           ("a.cmake", "# What computes.\n"), ("a.sh", "true\n# Those of a put.\n")):
            self.assertEqual(1, len(writing.refused_openings(path, text)), text)

    def test_personified_code(self):
        for path, text in (
            ("a.hpp", "/// Tells all teams the value.\n"),
            ("a.hpp", "int a;  // the teams know it\n"),
            ("a.hpp", "/* A grid\n * that says so. */\n"),
            ("a.py", '"""The records say why."""\n'),
            ("a.cmake", "# Each is\n# asked once.\n"),
        ):
            self.assertEqual(1, len(writing.personified(path, text)), text)
        for path, text in (
            ("a.hpp", "// The known length of `told`, \"as told\", say 3.\n"),
            ("a.hpp", "int a;  // say 3\n"),
            ("a.hpp", 'f("the user says // so");\n'),
            ("a.cmake", "# f(<wanted> WANTED): an entry.\nset(asked)\n"),
            ("a.md", "The README says why.\n"),
        ):
            self.assertEqual([], writing.personified(path, text), text)

    def test_riddles_in_names_of_tests(self):
        for path, name in (("a.cpp", "WhatCannotBeIsRefused"), ("a.cpp", "AStackOfThreeComesToRest"), ("a.cpp", "OfAChain"),
                           ("a.cpp", "TheClockStays"), ("a.cpp", "BoundKnowsIt"), ("test_a.py", "a_string"),
                           ("test_a.py", "failure_is_told_at_once")):
            text = f"TEST(Suite, {name}) {{\n}}\n" if path == "a.cpp" else f"    def test_{name}(self):\n"
            self.assertEqual(1, len(writing.riddles(path, text)), name)
        for path, name in (("a.cpp", "RejectsNonFinitePositions"), ("a.cpp", "AddsUnknownTimes"), ("a.cpp", "TheoryHolds"),
                           ("test_a.py", "rejects_unknown_keys"), ("test_a.py", "another_order")):
            text = f"TYPED_TEST(Suite,\n     {name}) {{\n}}\n" if path == "a.cpp" else f"    def test_{name}(self):\n"
            self.assertEqual([], writing.riddles(path, text), name)

    def test_openings_of_python(self):
        self.assertEqual(1, len(writing.refused_openings("a.py", 'def f():\n    """What it is."""\n')))
        self.assertEqual([], writing.refused_openings("a.py", 'def f():\n    """Return the sum."""\n    return "What"\n'))

    def test_suspect_openings_are_warnings(self):
        self.assertIn("warning", writing.suspect_openings("a.hpp", "/// Whether it is so.\n")[0])

    def test_finds_wide_prose(self):
        wide = "word " * 25
        self.assertEqual(1, len(writing.wide_lines("a.md", wide)))
        for allowed in ("| " + wide + "|", "```\n" + wide + "\n```", "![a picture](" + 130 * "x" + ")",
                        "[name]: https://" + 130 * "x", "word " * 24):
            self.assertEqual([], writing.wide_lines("a.md", allowed), allowed)

    def test_refuses_replaced_words_within_names(self):
        for text in ("bool is_held = false;", "struct TypedSpokes {};", "void advance_together();", "// calls `asked_for()`"):
            self.assertEqual(1, len(writing.replaced_words("kernels/a.hpp", text)), text)
        for path, text in (("tests/a.cpp", "TEST(Ranks, FailTogether)"),
                           ("kernels/a.hpp", 'const char* name = "is_held";'), ("scripts/a.py", "is_held = 1"),
                           ("kernels/a.hpp", "int tasks = shield + desktop_mode;")):
            self.assertEqual([], writing.replaced_words(path, text), text)

    def test_replaced_names(self):
        for path, text in (
            ("kernels/gas/a.hpp", "struct Judgement {};\n"),
            ("kernels/gas/a.hpp", "// returns a `Judgement`\n"),
            ("scripts/a.py", "seed_mode = 1\n"),
            ("docs/a.md", "`kernels/fabric`: `Cloth`\n"),
            ("kernels/fabric/a.hpp", "void settle();\n"),
            ("kernels/gas/solver_on.hpp", ""),
            ("tests/unit/a.cpp", "double reach = 1.0;\n"),
            ("miniapps/springs/a.cpp", "bool held = true;\n"),
            ("kernels/fabric/a.hpp", "int alone = 1;\n"),
        ):
            self.assertEqual(1, len(writing.replaced_names(path, text)), text)
        for path, text in (
            ("kernels/gas/a.hpp", "// Judgement of Solomon\n"),
            ("miniapps/a.cpp", 'say("Cloth and bar");\n'),
            ("scripts/a.py", '", ".join(held)\n'),
            ("scripts/a.py", "axes.bar(x, y)\n"),
            ("docs/a.md", "Cloth, `--seed-mode`\n"),
            ("kernels/gas/a.hpp", "int keep = place(fixed);\n"),
            ("CHANGELOG.md", "`bar` is now `tolerance`\n"),
        ):
            self.assertEqual([], writing.replaced_names(path, text), text)

    def test_strings_are_read(self):
        text = """#include "law"
// a "law"
f("of this "
  "law", 'a', 1'000, "\\"", R"(raw "law")");  /* "law" */
"""
        self.assertEqual([(3, "of this law"), (4, '\\"'), (4, 'raw "law"')], writing.strings(text))

    def test_unclear_strings(self):
        for path, text in (
            ("kernels/a.cpp", 'f("no grid covers this law");\n'),
            ("miniapps/a.cpp", 'f("as far as the "\n  "reach of it");\n'),
            ("common/a.cpp", 'key("bar");\n'),
            ("common/a.cpp", 'f("above the bar");\n'),
            ("perf/a.cpp", 'f("in seed mode");\n'),
            ("kernels/a.cpp", 'key("check.touches");\n'),
            ("perf/a.cpp", 'f("Those of the run");\n'),
            ("common/a.cpp", 'f("the springs know it");\n'),
        ):
            self.assertEqual(1, len(writing.unclear_strings(path, text)), text)
        for path, text in (
            ("tests/a.cpp", 'f("no grid covers this law");\n'),
            ("miniapps/a.cpp", 'f("a run cannot reach the target time alone");\n'),
            ("miniapps/a.cpp", 'f("give --method seed its --mesh, or --seed-mode; seed: the baseline");\n'),
            ("miniapps/a.cpp", 'key("tuning.seed.pinned", "limiter.touches");\n'),
            ("common/scene/read.cpp", 'renamed("bar", "tolerance");\n'),
            ("common/a.cpp", '// above the "bar law"\n'),
        ):
            self.assertEqual([], writing.unclear_strings(path, text), text)

    def test_refuses_rates_without_per(self):
        for path, text in (("perf/a.cpp", 'print("%f us a %s");\n'), ("scripts/a.py", 'unit = "\\u00b5s a step"\n'),
                           ("tests/a.py", 'f"ns a {unit}"\n')):
            self.assertEqual(1, len(writing.rates_with_an_article(path, text)), text)
        for path, text in (("perf/a.cpp", 'print("%f us per step");\n'), ("scripts/a.py", 'a = "terms a step needs"\n')):
            self.assertEqual([], writing.rates_with_an_article(path, text), text)

    def test_reads_no_files_that_git_ignores(self):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name in ("a.md", ".cache/b.md", "out/c.md"):
                (root / name).parent.mkdir(exist_ok=True)
                (root / name).write_text("text")
            self.assertEqual(["a.md", "out/c.md"], sorted(writing.read_tree(root)))
            (root / ".gitignore").write_text("out/\n.cache/\n")
            try:
                subprocess.run(["git", "init", "-q"], cwd=root, check=True)
            except OSError:
                self.skipTest("there is no git")
            self.assertEqual(["a.md"], sorted(writing.read_tree(root)))

    def test_public_headers(self):
        texts = {
            "kernels/gas/a.hpp": "", "kernels/gas/b.hpp": "", "kernels/gas/c.hpp": "", "kernels/reference/gas/d.hpp": "",
            "miniapps/gas/a.cpp": '#include "kernels/gas/a.hpp"\n#include "kernels/reference/gas/d.hpp"\n',
            "kernels/flow/b.hpp": '#include "kernels/gas/b.hpp"\n',
            "kernels/gas/c.cpp": '#include "kernels/gas/c.hpp"\n',
        }
        self.assertEqual(["kernels/gas/a.hpp", "kernels/gas/b.hpp"], writing.public_headers(texts))

    def test_typed_solvers_refer_to_functions_of_their_facade(self):
        facade = "class Solver {\n public:\n  /// Time, s. Does not throw.\n  virtual double time() = 0;\n};\n"
        solver = "/// Solver. Functions that `Solver` declares are documented in `Solver`.\nclass Typed {\n public:\n%s};\n"
        path = "kernels/gas/gas_solver.hpp"
        self.assertIn(path, writing.public_headers({path: ""}))
        self.assertEqual([], writing.missing_contracts(path, solver % "  double time();\n", facade))
        for text in (solver % "  double step();\n", (solver % "  double time();\n").replace("documented", "declared")):
            self.assertEqual(1, len(writing.missing_contracts(path, text, facade)), text)

    def contracts(self, text):
        return writing.missing_contracts("kernels/gas/a.hpp", text)

    def test_contracts_that_are_missing(self):
        for text, word in (
            ("double speed(double x);\n", "no doc comment"),
            ("/// Speed of sound. Does not throw.\ndouble speed(double rho);\n", "no unit"),
            ("/// Mean over the cells, a count of a vertex's rows (n,3). Does not throw.\ndouble mean(double rho);\n", "no unit"),
            ("/// Speed of sound, m/s.\ndouble speed(double rho);\n", "whether it throws"),
            ("class Solver {\n public:\n  /// Number of steps.\n  virtual int steps() const = 0;\n};\n", "whether it throws"),
            ("/// Steps, s.\ntemplate <class S, class F = None>\nclass Solver {\n public:\n  /// Advances to t.\n"
             "  void advance(double t);\n};\n", "throws"),
            ("/// Applies f.\ntemplate <class F>\nvoid apply(const F& f) {\n  f();\n}\n", "whether it throws"),
        ):
            found = self.contracts("#pragma once\nnamespace drogue::gas {\n" + text + "}\n")
            self.assertEqual(1, len(found), found)
            self.assertIn(word, found[0])

    def test_contracts_that_suffice(self):
        for text in (
            "/// Speed of sound, m/s. Does not throw.\ndouble speed(double rho);\n",
            "/// Speed of sound, m/s.\nKOKKOS_INLINE_FUNCTION double speed(double rho) { return rho; }\n",
            "/// Norm, in the unit of v. Does not throw.\ndouble norm(const double* v);\n",
            "/// Rows of the vertices. Does not throw.\nvoid sort(std::span<const int> vertices);\n",
            "/// Steps. Members do not throw.\nclass Solver {\n public:\n  /// Number of steps.\n  int steps() const;\n"
            " private:\n  void hidden(double x);\n};\n",
            "/// Reads and writes positions, m. Throws std::invalid_argument.\nvoid read(double* x);\nvoid write(double x);\n",
            "struct Cell {\n  double rho = f(1.0);  ///< kg/m^3\n  ~Cell();\n  Cell() = default;\n};\n",
            "/// Two triangles of the mesh. Does not throw.\nstd::array<int, 2> triangles();\n",
            "/// Steps. Does not throw.\nclass Solver {\n  struct Steps;\n};\nstruct Solver::Steps {\n  void begin(double x);\n};\n"
            "template <class T>\nvoid Solver<T>::advance(double x) {\n  f(x);\n}\n",
            "/// Solver. Does not throw.\nclass A {\n  A(int k);\n};\ninline A::A(int k)\n    : _a{k},\n      _b(k),\n      _c(k) {}\n",
            "/// Largest of both.\nconstexpr int largest(int a, int b) {\n  if (a < b) { return b; }\n  return a;\n}\n",
        ):
            self.assertEqual([], self.contracts("#pragma once\nnamespace drogue::gas {\n" + text + "}\n"), text)


if __name__ == "__main__":
    unittest.main()
