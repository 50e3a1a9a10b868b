# ctest-label: no-sanitizer
"""scripts/compare_builds.py on small programs that write given histories."""

import os
import pathlib
import subprocess
import sys

from folder_test import FolderTest

SCRIPT = pathlib.Path(os.environ["DROGUE_SOURCE"]) / "scripts" / "compare_builds.py"
# Writes a history unless its contents are None, and ends with a code.
SCENE_PROGRAM = """#!/usr/bin/env python3
import pathlib, sys
if "--list-scenes" in sys.argv:
    print({scenes!r})
    sys.exit(0)
history, code = {history!r}, {code}
folder = pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
folder.mkdir(parents=True, exist_ok=True)
if history is not None:
    (folder / "history.csv").write_text(history)
sys.exit(code)
"""
# Appends its build and arguments to a log; `run` writes a record, `compare` prints a verdict and ends with a code.
PERF_PROGRAM = """#!/usr/bin/env python3
import pathlib, sys
with open({log!r}, "a") as log:
    log.write({build!r} + " " + " ".join(sys.argv[1:4]) + "\\n")
if sys.argv[1] == "run":
    pathlib.Path(sys.argv[sys.argv.index("--out") + 1]).write_text("record of {build}\\n")
    sys.exit(0)
print("verdict")
sys.exit(5)
"""


class Builds(FolderTest):
    def program(self, build, name, text):
        file = self.folder / build / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        file.chmod(0o755)

    def scenes(self, build, history, code=0):
        """A build whose drogue-gas has one scene, and whose other programs have none."""
        for name in ("drogue-gas", "drogue-springs", "drogue-parachute"):
            scenes = "sod" if name == "drogue-gas" else ""
            self.program(build, name, SCENE_PROGRAM.format(scenes=scenes, history=history, code=code))

    def compare(self, *words):
        command = [sys.executable, "-B", SCRIPT, self.folder / "old", self.folder / "new", *words]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def expect_bits(self, code, words):
        done = self.compare("--only", "drogue-gas")
        self.assertEqual((code, True), (done.returncode, words in done.stdout), done.stdout + done.stderr)

    def test_equal_histories_are_the_same_bits(self):
        self.scenes("old", "1,2")
        self.scenes("new", "1,2")
        self.expect_bits(0, "sod: the same bits")

    def test_unequal_histories_differ(self):
        self.scenes("old", "1,2")
        self.scenes("new", "1,3")
        self.expect_bits(1, "sod: different: history.csv")

    def test_runs_that_fail_alike_are_not_equal(self):
        self.scenes("old", None, 77)
        self.scenes("new", None, 77)
        self.expect_bits(1, "sod: different: exit code 77")

    def test_runs_without_results_are_not_equal(self):
        self.scenes("old", None)
        self.scenes("new", None)
        self.expect_bits(1, "neither fields nor history")

    def test_history_of_one_build_alone_differs(self):
        self.scenes("old", "1,2")
        self.scenes("new", None)
        self.expect_bits(1, "history.csv of one run alone")

    def test_comparing_nothing_is_an_error(self):
        self.scenes("old", "1,2")
        self.scenes("new", "1,2")
        self.assertEqual(2, self.compare("--only", "no-such-scene").returncode)

    def test_leaves_out_programs_of_neither_build(self):
        self.program("old", "drogue-gas", SCENE_PROGRAM.format(scenes="sod", history="1,2", code=0))
        self.program("new", "drogue-gas", SCENE_PROGRAM.format(scenes="sod", history="1,2", code=0))
        self.expect_bits(0, "sod: the same bits")

    def test_rejects_a_program_of_one_build_alone(self):
        self.program("new", "drogue-gas", SCENE_PROGRAM.format(scenes="sod", history="1,2", code=0))
        done = self.compare()
        self.assertEqual((1, True), (done.returncode, "does not exist" in done.stderr), done.stderr)

    def test_speed_alternates_builds_and_keeps_their_records(self):
        log, kept = self.folder / "log", self.folder / "kept"
        for build in ("old", "new"):
            self.program(build, "drogue-perf", PERF_PROGRAM.format(log=str(log), build=build))
        done = self.compare("--speed", "gas", "--rounds", "2", "--quick", "--keep", kept)
        self.assertEqual((5, "verdict\n"), (done.returncode, done.stdout), done.stderr)
        runs = [f"{build} run --filter gas" for build in ("old", "new", "new", "old")]
        self.assertEqual([*runs, f"new compare {kept / 'old.jsonl'} {kept / 'new.jsonl'}"], log.read_text().splitlines())
        self.assertEqual("record of old\n" * 2, (kept / "old.jsonl").read_text())
        self.assertEqual("record of new\n" * 2, (kept / "new.jsonl").read_text())
        self.assertEqual("verdict\n", (kept / "compare.txt").read_text())
