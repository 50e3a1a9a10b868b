"""Markers of labels have their form, and cmake/test_properties.cmake gives their tests the labels."""

import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import layers

ROOT = layers.repository(os.environ)


LABELS = "no-sanitizer|exact|smoke"


class Repository(unittest.TestCase):
    def test_markers_name_labels_and_belong_to_tests(self):
        """A marker that stands neither above the first include or docstring nor in front of a TEST is without effect."""
        used = set()
        for path in sorted((ROOT / "tests").rglob("*")):
            if path.suffix == ".cpp" or path.match("test_*.py"):
                sign, first = ("//", "#include") if path.suffix == ".cpp" else ("#", '"""')
                text = path.read_text(encoding="utf-8")
                for marker in re.finditer(rf"^[ \t]*{sign} ctest-label.*$", text, re.MULTILINE):
                    place = f"{path}: {marker[0]}"
                    self.assertRegex(marker[0], rf"^{sign} ctest-label: ({LABELS})( ({LABELS}))*$", place)
                    case = re.compile(r"(TYPED_)?TEST(_F|_P)?\(").match(text, marker.end() + 1)
                    self.assertTrue(case or marker.start() < text.index(first), f"{place} belongs to no test")
                    used.update(marker[0].split()[2:])
        self.assertEqual(set(LABELS.split("|")), used)


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
