"""docs/architecture.md names every folder of the layers, and none that does not exist."""

import os
import unittest

import folders
import layers

ROOT = layers.repository(os.environ)
PAGE = ROOT / "docs/architecture.md"


class Repository(unittest.TestCase):
    maxDiff = None

    def test_page_names_the_folders_that_exist(self):
        files = [path.relative_to(ROOT).as_posix() for area in folders.AREAS for path in (ROOT / area).rglob("*") if path.is_file()]
        self.assertEqual(sorted(folders.existing(files)), sorted(folders.named(PAGE.read_text(encoding="utf-8"))))


class ReadsTheTable(unittest.TestCase):
    TABLE = ("# Architecture\n\n## Folders\n| folder | content |\n|---|---|\n| **`common/`** | host |\n| `common/csv` | `a.csv` |\n"
             "| `kernels/gas` | Euler; rooms `flux` (WENO, `x`), `tile` |\n| `miniapps/gas`, `springs` | programs |\n"
             "| **`perf/`** | rooms `tables` |\n| `scripts/plot` | pictures |\n\n## Layers\n| `kernels/other` | |\n")

    def test_names_of_folders_and_rooms(self):
        self.assertEqual({"common/csv", "kernels/gas", "kernels/gas/flux", "kernels/gas/tile", "miniapps/gas", "miniapps/springs",
                          "perf/tables"}, folders.named(self.TABLE))

    def test_folders_that_hold_files(self):
        files = ("common/csv/a.hpp", "kernels/gas/instances/a.cpp", "kernels/gas/flux/b.hpp", "perf/main.cpp", "scripts/a.py",
                 "scripts/plot/gas/a.py", "miniapps/gas/scenes/a.toml", "tests/unit/a.cpp", "kernels/mesh/__pycache__/a.pyc")
        self.assertEqual({"common/csv", "kernels/gas", "kernels/gas/flux", "scripts/plot/gas", "miniapps/gas"},
                         folders.existing(files))
