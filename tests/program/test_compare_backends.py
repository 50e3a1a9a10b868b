# ctest-label: no-sanitizer
"""scripts/compare_backends.py on a small program whose histories depend on scene and backend."""

import json
import os
import pathlib
import subprocess
import sys

from folder_test import FolderTest

SCRIPT = pathlib.Path(os.environ["DROGUE_SOURCE"]) / "scripts" / "compare_backends.py"
# One scene with equal histories, one whose history names the backend, one that fails on OpenMP without a result, and one that
# takes minutes.
PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
if "--list-scenes" in sys.argv:
    print("equal  A scene.\\ndiffers  A scene.\\nfails  A scene.\\nequal-full  A scene.")
    sys.exit(0)
scene, backend = sys.argv[1], sys.argv[sys.argv.index("--backend") + 1]
folder = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
folder.mkdir(parents=True, exist_ok=True)
if scene == "fails" and backend == "openmp":
    print("drogue-springs: no such device", file=sys.stderr)
    sys.exit(77)
(folder / "history.csv").write_text(backend if scene == "differs" else "1,2")
(folder / "result.json").write_text(json.dumps({"git": "abc"}))
"""


class Backends(FolderTest):
    def setUp(self):
        super().setUp()
        program = self.folder / "drogue-springs"
        program.write_text(PROGRAM)
        program.chmod(0o755)

    def compare(self, *words, backends="serial,openmp"):
        """Exit code and printed lines of a comparison, of which a rejected one writes its last line to stderr."""
        command = [sys.executable, "-B", SCRIPT, "springs", "--bin", self.folder, "--work", self.folder / "work",
                   "--backends", backends, *words]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines() or done.stderr.splitlines()[-1:]

    def test_names_scenes_that_differ_or_fail(self):
        code, lines = self.compare("--jobs", "2")
        self.assertEqual((1, "1 of 3 scenes have the same bits on serial, openmp"), (code, lines.pop()))
        self.assertEqual(
            ["differs: other bits than on serial: openmp (1)", "equal: the same bits",
             "fails: exit codes serial 0, openmp 77: drogue-springs: no such device"], sorted(lines))

    def test_counts_no_scenes_that_are_left_out(self):
        lines = ["equal: the same bits", "1 of 1 scenes have the same bits on serial, openmp"]
        self.assertEqual((0, lines), self.compare("--skip", "differs|fails"))
        self.assertEqual((0, lines), self.compare("--only", "^equal"))

    def test_writes_rows_with_the_commit(self):
        file = self.folder / "rows.json"
        self.compare("--to", file)
        record = json.loads(file.read_text())
        self.assertEqual(("abc", ["serial", "openmp"]), (record["git"], record["backends"]))
        rows = {row["scene"]: row["identical"] for row in record["exact"]}
        self.assertEqual({"equal": True, "differs": False, "fails": False}, rows)

    def test_rejects_what_compares_nothing(self):
        for words, backends, reason in (
            (("--only", "nothing"), "serial,openmp", "nothing was compared"),
            (("--only", "["), "serial,openmp", "'[' is no regular expression"),
            (("--jobs", "0"), "serial,openmp", "'0' is no number of scenes"),
            (("--bin", "nowhere"), "serial,openmp", "there is no program nowhere/drogue-springs"),
            ((), "serial", "'serial' is no list of two or more different backends"),
            ((), "serial,serial", "'serial,serial' is no list"),
        ):
            with self.subTest(words=words, backends=backends):
                code, lines = self.compare(*words, backends=backends)
                self.assertEqual((2, True), (code, reason in lines[-1]), lines)
