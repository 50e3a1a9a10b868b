"""Runs drogue-perf for tests of its interface."""

import json
import os
import pathlib
import subprocess
import unittest

from folder_test import FolderTest

PROGRAM = pathlib.Path(os.environ["DROGUE_BIN"]) / "drogue-perf"
CACHE = (pathlib.Path(os.environ["DROGUE_BUILD"]) / "CMakeCache.txt").read_text(encoding="utf-8")


@unittest.skipIf("DROGUE_SANITIZE:BOOL=ON" in CACHE, "builds with sanitizers are not measured")
class PerfTest(FolderTest):
    """Test case whose programs run in an empty temporary folder."""

    def expect(self, code, *words, environment=None, notices=0):
        """Runs in the folder, asserts the exit code and that a failure prints one line, a success `notices`; returns the process."""
        process = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True, timeout=600,
                                 check=False, env={**os.environ, "OMP_WAIT_POLICY": "passive", **(environment or {})})
        self.assertEqual(code, process.returncode, f"{process.args}\n{process.stdout}{process.stderr}")
        self.assertEqual(notices if code == 0 else 1, len(process.stderr.splitlines()), process.stderr)
        return process

    def recorded(self, *words, code=0, **settings):
        """Standard output and records of a command that writes some."""
        text = self.expect(code, *words, "--out", "rows.jsonl", **settings).stdout
        return text, self.records("rows.jsonl")

    def records(self, name):
        return [json.loads(line) for line in (self.folder / name).read_text(encoding="utf-8").splitlines()]
