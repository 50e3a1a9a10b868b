# ctest-label: no-sanitizer
"""scripts/lib/drop_runpath.py removes the path of a library and leaves the rest of it as it is."""

import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from folder_test import FolderTest

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
COMPILER = os.environ.get("CC", "cc")


@unittest.skipUnless(shutil.which(COMPILER) and shutil.which("readelf"), "needs a C compiler and readelf")
class DropRunpath(FolderTest):
    def library(self, *options):
        (self.folder / "a.c").write_text("int answer(void) { return 42; }\n", encoding="utf-8")
        path = self.folder / "liba.so"
        subprocess.run([COMPILER, "-shared", "-fPIC", *options, "-o", path, self.folder / "a.c"], check=True)
        return path

    def drop(self, path):
        command = [sys.executable, "-B", SOURCE / "scripts/lib/drop_runpath.py", path]
        return subprocess.run(command, capture_output=True, text=True)

    def entries(self, path):
        return subprocess.run(["readelf", "-d", path], capture_output=True, text=True, check=True).stdout

    def test_removes_the_runpath(self):
        path = self.library("-Wl,--enable-new-dtags,-rpath,/nowhere", "-Wl,-soname,liba.so.1")
        before = self.entries(path)
        self.assertIn("(RUNPATH)", before)
        self.assertEqual(0, self.drop(path).returncode)
        after = self.entries(path)
        self.assertNotIn("(RUNPATH)", after)
        lines = [line for line in before.splitlines() if line.startswith(" 0x") and "(RUNPATH)" not in line]
        self.assertEqual(lines, [line for line in after.splitlines() if line.startswith(" 0x")])
        code = "import ctypes, sys; sys.exit(ctypes.CDLL(sys.argv[1]).answer())"
        self.assertEqual(42, subprocess.run([sys.executable, "-c", code, path]).returncode)

    def test_keeps_other_libraries(self):
        path = self.library("-Wl,--disable-new-dtags,-rpath,/nowhere")
        before = path.read_bytes()
        self.assertEqual(0, self.drop(path).returncode)
        self.assertEqual(before, path.read_bytes())

    def test_rejects_other_files(self):
        path = self.folder / "text"
        path.write_text("no library", encoding="utf-8")
        result = self.drop(path)
        self.assertNotEqual(0, result.returncode)
        self.assertIn("no ELF file", result.stderr)
