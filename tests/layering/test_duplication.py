"""No two mini-apps hold the same twelve lines: what they share belongs to miniapps/framework or common."""

import os
import unittest

import duplication
import layers

TEXTS = dict(layers.source_files(layers.repository(os.environ)))


class Duplication(unittest.TestCase):
    def test_mini_apps_share_no_block_of_lines(self):
        self.assertGreaterEqual(len({duplication.app_of(path) for path in TEXTS} - {None}), 3)
        self.assertEqual([], duplication.copies(TEXTS))


class FindsCopies(unittest.TestCase):
    def setUp(self):
        self.block = "".join(f"  value_{k} = f({k});\n" for k in range(duplication.LENGTH))

    def found(self, first, second, *, app="springs"):
        return duplication.copies({"miniapps/gas/a.cpp": first, f"miniapps/{app}/b.cpp": second})

    def test_copy_in_another_mini_app(self):
        found = self.found("int a;\n" + self.block, "int b;\nint c;\n" + self.block)
        self.assertEqual(["miniapps/springs/b.cpp:3 repeats miniapps/gas/a.cpp:2"], found)

    def test_copy_with_other_indentation_blank_lines_and_braces(self):
        changed = self.block.replace("  value", "      value").replace("value_5", "\n{\n// note\nvalue_5")
        self.assertEqual(1, len(self.found(self.block, changed)))

    def test_shorter_copy_and_copy_in_the_same_mini_app_pass(self):
        self.assertEqual([], self.found(self.block, self.block.replace("value_0", "other")))
        self.assertEqual([], self.found(self.block, self.block, app="gas"))

    def test_framework_is_no_mini_app(self):
        self.assertEqual([], self.found(self.block, self.block, app="framework"))

    def test_includes_and_declarations_of_an_interface_pass(self):
        includes = "".join(f'#include "common/x{k}.hpp"\n' for k in range(20))
        overrides = "".join(f"  void f{k}() override;\n" for k in range(20))
        self.assertEqual([], self.found(includes + overrides, includes + overrides))
