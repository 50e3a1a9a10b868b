# ctest-label: no-sanitizer
"""scripts/compare_backends.py on a small program whose histories depend on scene and backend."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(os.environ["DROGUE_SOURCE"]) / "scripts" / "compare_backends.py"
# One scene with equal histories, one whose history names the backend, one that fails on OpenMP, and one that takes minutes.
PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
if "--list-scenes" in sys.argv:
    print("equal  A scene.\\ndiffers  A scene.\\nfails  A scene.\\nequal-full  A scene.")
    sys.exit(0)
scene, backend = sys.argv[1], sys.argv[sys.argv.index("--backend") + 1]
folder = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
folder.mkdir(parents=True, exist_ok=True)
(folder / "history.csv").write_text(backend if scene == "differs" else "1,2")
(folder / "result.json").write_text(json.dumps({"git": "abc"}))
sys.exit(4 if scene == "fails" and backend == "openmp" else 0)
"""


class Backends(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        program = self.folder / "drogue-springs"
        program.write_text(PROGRAM)
        program.chmod(0o755)

    def compare(self, *words):
        """Exit code and printed lines of a comparison."""
        command = [sys.executable, "-B", SCRIPT, "springs", "--bin", self.folder, "--work", self.folder / "work",
                   "--backends", "serial,openmp", *words]  # fmt: skip
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual("", done.stderr)
        return done.returncode, done.stdout.splitlines()

    def test_names_scenes_that_differ_or_fail(self):
        self.assertEqual(
            (1, ["differs: other bits than on serial: openmp (1)", "fails: exit codes serial 0, openmp 4",
                 "1 of 3 scenes have the same bits on serial, openmp"]),
            self.compare("--jobs", "2"))  # fmt: skip

    def test_scenes_left_out_do_not_count(self):
        lines = ["1 of 1 scenes have the same bits on serial, openmp"]
        self.assertEqual((0, lines), self.compare("--skip", "differs|fails"))
        self.assertEqual((0, lines), self.compare("--only", "^equal"))

    def test_rows_are_written_with_the_commit(self):
        file = self.folder / "rows.json"
        self.compare("--only", "equal|differs", "--to", file)
        record = json.loads(file.read_text())
        self.assertEqual(("abc", ["serial", "openmp"]), (record["git"], record["backends"]))
        self.assertEqual([True, False], [row["identical"] for row in record["exact"]])

    def test_a_comparison_without_scenes_is_an_error(self):
        code, lines = self.compare("--only", "nothing")
        self.assertEqual((2, ["no scene was compared"]), (code, lines))


if __name__ == "__main__":
    unittest.main()
