"""Markers of labels belong to tests, and cmake/test_properties.cmake gives their tests the labels."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import labels
import layers

ROOT = layers.repository(os.environ)


def test_sources():
    for path in sorted((ROOT / "tests").rglob("*")):
        if path.suffix == ".cpp" or path.match("test_*.py"):
            yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")


class Repository(unittest.TestCase):
    def test_markers_belong_to_tests(self):
        self.assertEqual([], [line for path, text in test_sources() for line in labels.misplaced(path, text)])

    def test_every_label_is_used(self):
        text = "".join(text for _, text in test_sources())
        for label in labels.LABELS:
            self.assertIn(f"ctest-label: {label}\n", text)


class EachRuleCatchesItsBreach(unittest.TestCase):
    HEAD = "// ctest-label: exact\n#include <a>\n"
    CASE = "// ctest-label: exact no-sanitizer\nTEST(A, B) {}\n"

    def test_markers_that_belong_to_tests(self):
        for text in (self.HEAD + "TEST(A, B) {}\n", "#include <a>\n" + self.CASE, "#include <a>\n" + self.CASE.replace("TEST(", "TEST_P(")):
            self.assertEqual([], labels.misplaced("a.cpp", text), text)
        self.assertEqual([], labels.misplaced("test_a.py", '# ctest-label: no-sanitizer\n"""Text."""\n'))

    def test_markers_that_belong_to_none(self):
        for path, text, word in (
            ("a.cpp", self.HEAD, "the source has none"),
            ("a.cpp", "#include <a>\n// ctest-label: exact\n\nTEST(A, B) {}\n", "belongs to no test"),
            ("a.cpp", "#include <a>\n// ctest-label: exact\nint a;\nTEST(A, B) {}\n", "belongs to no test"),
            ("a.cpp", "#include <a>\nTEST(A, B) {}\n// ctest-label: exact", "belongs to no test"),
            ("a.cpp", "#include <a>\n" + self.CASE.replace("exact", "precise"), "not one of"),
            ("a.cpp", "#include <a>\n" + self.CASE.replace("label:", "label"), "form"),
            ("a.cpp", "#include <a>\n  " + self.CASE, "form"),
            ("test_a.py", '"""Text."""\n# ctest-label: no-sanitizer\n', "belongs to no test"),
        ):
            found = labels.misplaced(path, text)
            self.assertEqual(1, len(found), text)
            self.assertIn(word, found[0])


class PropertiesOfTests(unittest.TestCase):
    TESTS = ("unit.First.Runs", "unit.First.Runs2", "unit.All/First.Counts/3", "unit.Second.Runs", "unit.Typed.Runs<double>")

    def show(self, *sources):
        """The process of ctest that lists the properties of TESTS, whose cases stand in `sources`."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        folder = Path(folder.name)
        names = [f"{number}.cpp" for number in range(len(sources))]
        for name, text in zip(names, sources):
            (folder / name).write_text(text, encoding="utf-8")
        (folder / "CTestTestfile.cmake").write_text(
            "".join(f'add_test("{name}" true)\n' for name in self.TESTS)
            + f'include("{ROOT}/cmake/test_properties.cmake")\n'
            + f'drogue_test_properties("unit." "unit" "A=1;B=2" TESTS "{";".join(self.TESTS)}" '
            + f'SOURCES "{";".join(str(folder / name) for name in names)}")\n', encoding="utf-8")
        return subprocess.run(["ctest", "--show-only=json-v1"], cwd=folder, capture_output=True, text=True)

    def properties(self, *sources):
        result = self.show(*sources)
        self.assertEqual(0, result.returncode, result.stderr)
        return {test["name"]: {entry["name"]: entry["value"] for entry in test["properties"]}
                for test in json.loads(result.stdout)["tests"]}

    def test_labels_of_cases_and_of_sources(self):
        case = '#include <a>\n// ctest-label: exact\nTEST(First, Runs) { f("[;"); }\nTEST(First, Runs2) {}\n'
        found = self.properties(
            case + "// ctest-label: exact no-sanitizer\nTEST_P(First,\n       Counts) {}\n// ctest-label: exact\nTYPED_TEST(Typed, Runs) {}\n",
            "// A comment.\n// ctest-label: no-sanitizer\n#include <a>\nTEST_F(Second, Runs) {}\n")
        self.assertEqual(
            [["exact", "unit"], ["unit"], ["exact", "no-sanitizer", "unit"], ["no-sanitizer", "unit"], ["exact", "unit"]],
            [sorted(found[name]["LABELS"]) for name in self.TESTS])
        self.assertEqual({("A=1", "B=2")}, {tuple(entry["ENVIRONMENT"]) for entry in found.values()})

    def test_marker_of_no_test_of_the_program_is_an_error(self):
        result = self.show("#include <a>\n// ctest-label: exact\nTEST(First, Run) {}\n")
        self.assertNotEqual(0, result.returncode)
        self.assertIn("the program has no such test", " ".join(result.stderr.split()))
