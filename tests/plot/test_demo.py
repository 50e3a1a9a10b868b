"""The demo with a stub mini-app: printed table, page and exit code."""

import os
import re
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import packages  # before modules that need the packages  isort: skip
from folder_test import FolderTest
from plot.demo.__main__ import BATCH, SHOWN
from plot.demo.page import pictures_by_role


class Demo(FolderTest):
    def setUp(self):
        super().setUp()
        fake = Path(__file__).with_name("fake_app.py")
        program = self.folder / "bin" / "drogue-gas"
        program.parent.mkdir()
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{fake}" "$@"\n')
        program.chmod(0o755)

    def _demo(self, *words, failure=""):
        environment = os.environ | {"PYTHONPATH": str(packages.SOURCE / "scripts"), "FAKE_FAILURE": failure}
        command = [
            sys.executable, "-m", "plot.demo", "--bin", self.folder / "bin", "--out", self.folder / "out", *words,
        ]
        return subprocess.run(command, capture_output=True, text=True, env=environment, check=False)

    def test_shows_shipped_scenes_of_every_program(self):
        shipped = {file.stem: file.parts[-3] for file in (packages.SOURCE / "miniapps").glob("*/scenes/*.toml")}
        self.assertEqual({"gas", "springs", "parachute"}, {shipped[name] for name in SHOWN if name != BATCH})
        self.assertIn(BATCH, SHOWN)

    def test_runs_a_selection_unless_all_are_asked_for(self):
        for words, names in (((), ["sod"]), (("lax", "sod"), ["lax", "sod"])):
            done = self._demo(*words)
            self.assertEqual([line.split()[0] for line in done.stdout.split("\n\n")[0].splitlines()[1:]], names)

    def test_prints_table_and_writes_page_of_passed_scenes(self):
        done = self._demo("--all")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = [re.split(r"\s{2,}", line) for line in done.stdout.splitlines()[:3]]
        self.assertEqual(rows[0], ["scene", "backend", "steps", "error", "tolerance", "time"])
        self.assertEqual(rows[1], ["sod", "openmp", "1234", "l1 density 0.0052", "0.0065", "12.3 ms"])
        self.assertEqual(rows[2][0], "lax")
        page = (self.folder / "out/index.html").read_text()
        self.assertIn("2 of 2 scenes verified", page)
        self.assertEqual(page.count("data:image/png"), 4)
        self.assertEqual(page.count("data:image/gif"), 2)
        self.assertNotIn("sod-full", page)
        self.assertEqual(re.findall(r"(?:src|href)=\"(?!data:|#)[^\"]*", page), [], "the page refers to another file")

    def test_reports_failed_scene_in_message_table_and_page(self):
        done = self._demo("lax", failure="lax")
        self.assertEqual(done.returncode, 5)
        self.assertEqual(done.stderr, "demo: drogue-gas lax failed: l1_density is 0.013, above its tolerance 0.0065.\n")
        self.assertRegex(done.stdout, r"lax .*FAILED")
        page = (self.folder / "out/index.html").read_text()
        self.assertIn("0 of 1 scenes verified", page)
        self.assertIn("above its tolerance 0.0065", page)

    def test_history_stands_for_missing_fields(self):
        names = ("fields.png", "fields.gif", "spectrum.png", "history.png", "profiles.png")
        files = [Path(name) for name in names]
        roles = pictures_by_role(SimpleNamespace(pictures=files))
        self.assertEqual({"still": files[0], "movie": files[1], "map": files[2], "profiles": files[4]}, roles)
        for name in ("canopies.png", "forces.png"):
            self.assertEqual({"forces": Path(name)}, pictures_by_role(SimpleNamespace(pictures=[Path(name)])))
        self.assertEqual({"still": files[3]}, pictures_by_role(SimpleNamespace(pictures=files[3:4])))

    def test_rejects_unknown_scene_with_list_of_scenes(self):
        done = self._demo("sood")
        self.assertEqual(done.returncode, 2)
        self.assertIn("sod, lax", done.stderr)
