"""Runs drogue-gas for tests of its command line."""

import csv
import functools
import json
import os
import pathlib
import pty
import re
import shutil
import subprocess
import time
import unittest

from folder_test import FolderTest
from hdf5_file import Hdf5File

BIN = pathlib.Path(os.environ["DROGUE_BIN"])
SOURCE = pathlib.Path(os.environ["DROGUE_SOURCE"])
PROGRAM = BIN / "drogue-gas"
SCENES = sorted(path.stem for path in (SOURCE / "miniapps/gas/scenes").glob("*.toml"))

# Passive waiting, because tests share their cores.
ENVIRONMENT = {**os.environ, "OMP_WAIT_POLICY": "passive", "OMP_NUM_THREADS": os.environ.get("OMP_NUM_THREADS", "2")}

@functools.cache
def backends():
    """Backends of this build."""
    text = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout
    return re.search("^backends: (.*)$", text, re.MULTILINE)[1].split()


def threaded():
    """OpenMP if available, otherwise (sanitizer preset) Serial."""
    return "openmp" if "openmp" in backends() else "serial"


needs_openmp = unittest.skipIf(threaded() == "serial", "this build has no OpenMP")

NO_FIELDS = "output.fields=[]"


def arguments(scene, *words, sets=(), program=PROGRAM):
    """Command line of a run; each word of `sets` becomes a --set option."""
    line = [str(program), str(scene), *map(str, words)]
    for assignment in sets:
        line += ["--set", assignment]
    return line


def run(scene, *words, sets=(), cwd=None, timeout=3600, environment=None, program=PROGRAM):
    """Runs the program to its end; stdout and stderr are text."""
    return subprocess.run(arguments(scene, *words, sets=sets, program=program), cwd=cwd, capture_output=True, text=True, errors="replace",
                          timeout=timeout, check=False, env={**ENVIRONMENT, **(environment or {})})


def result(directory):
    return json.loads((pathlib.Path(directory) / "result.json").read_text(encoding="utf-8"))


def fields(directory, name="fields.h5"):
    return Hdf5File(PROGRAM, pathlib.Path(directory) / name)


def final_values(directory, field="rho"):
    """Cell centres, m, and one field of the last output."""
    file = fields(directory)
    return file.values("/mesh/x"), file.values(f"/steps/{file.children('/steps')[-1]}/{field}")


class GasTest(FolderTest):
    """Test case whose programs run in an empty temporary folder."""

    program = PROGRAM

    def write(self, text, name="scene.toml"):
        file = self.folder / name
        file.write_text(text, encoding="utf-8")
        return file

    def start(self, scene, *words, sets=(), **settings):
        return run(scene, *words, sets=sets, cwd=self.folder, program=self.program, **settings)

    def expect(self, code, scene, *words, sets=(), **settings):
        """Runs in the folder, asserts the exit code and that a failure prints one line; returns the process."""
        process = self.start(scene, *words, sets=sets, **settings)
        self.assertEqual(code, process.returncode, f"{process.args}\n{process.stderr}")
        self.assertEqual(0 if code == 0 else 1, len(process.stderr.splitlines()), process.stderr)
        return process

    def study(self, scene, lists, *words, sets=()):
        """A study by a copy of the program, beside which no drogue-plot lies: a picture that is not made is no failure."""
        return run(scene, "--study", lists, *words, sets=sets, cwd=self.folder, program=shutil.copy(self.program, self.folder))

    def assert_lists(self, scenes):
        """Asserts that the program lists these scenes, each with a sentence, and those of GPUs with a mark."""
        lines = self.expect(0, "--list-scenes").stdout.splitlines()
        self.assertEqual(scenes, [line.split()[0] for line in lines])
        for line in lines:
            self.assertRegex(line, r"^\S+  +\S.*\.( \[gpu\])?$")

    def resolved(self, scene, *words, sets=()):
        """Text of a printed scene, which must resolve to itself."""
        printed = self.expect(0, scene, "--print-scene", *words, sets=sets).stdout
        self.assertEqual(printed, self.expect(0, self.write(printed, "printed.toml"), "--print-scene").stdout)
        return printed

    def assert_all_pass(self, backend, scenes, checks=1, also=lambda reported: None):
        """Asserts that shipped scenes, unchanged, meet their tolerances in at least `checks` checks; `also` gets each result."""
        self.assertGreaterEqual(len(scenes), 7)
        for scene in scenes:
            with self.subTest(scene):
                process = self.start(scene, "--backend", backend)
                self.assertEqual(0, process.returncode, process.stderr)
                reported = self.result(f"out/{scene}")
                self.assertEqual([f"{self.program.name}: {warning}" for warning in reported.get("warnings", [])], process.stderr.splitlines())
                self.assertEqual(("ok", backend, scene), (reported["status"], reported["backend"], reported["scene"]))
                self.assertGreaterEqual(len(reported["checks"]), checks)
                also(reported)

    def assert_within(self, reported):
        """Asserts that the value of each check is at most its tolerance."""
        self.assertTrue(all(check["passed"] and check["value"] <= check["tolerance"] for check in reported["checks"]))

    def terminal(self, scene, *words, sets=()):
        """Output of a run on a terminal, which must end with exit code 0."""
        master, slave = pty.openpty()
        process = subprocess.Popen(arguments(scene, *words, sets=sets, program=self.program), cwd=self.folder, env=ENVIRONMENT,
                                   stdout=slave, stderr=slave)
        os.close(slave)
        shown = b""
        while True:
            try:
                part = os.read(master, 4096)
            except OSError:  # Linux reports the closed terminal as an error
                break
            if not part:
                break
            shown += part
        os.close(master)
        self.assertEqual(0, process.wait(), shown)
        return shown.decode()

    def result(self, directory):
        return result(self.folder / directory)

    def fields(self, directory):
        return fields(self.folder / directory)

    def history(self, directory):
        """Columns of history.csv by name without units."""
        with (self.folder / directory / "history.csv").open(encoding="utf-8", newline="") as file:
            header, *rows = csv.reader(file)
        return {name.split(" [")[0]: [float(row[k]) for row in rows] for k, name in enumerate(header)}

    def begin(self, scene, *words, sets=()):
        """Starts a run in the folder `part`; returns once it handles signals and has a restart file."""
        line = arguments(scene, "--quiet", "--out", "part", *words, sets=sets, program=self.program)
        process = subprocess.Popen(line, cwd=self.folder, env=ENVIRONMENT, stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        awaited = [self.folder / "part/.lock", self.folder / "part/restart.h5"]
        while process.poll() is None and not all(file.exists() for file in awaited):
            time.sleep(0.001)
        return process

    def assert_same_runs(self):
        """Asserts that the runs in the folders `whole` and `part` have the same files and results bit for bit."""
        whole, part = self.fields("whole"), self.fields("part")
        self.assertEqual(whole.attributes, part.attributes)
        self.assertEqual(whole.datasets.keys(), part.datasets.keys())
        self.assertEqual([], [path for path in whole.datasets if whole.datasets[path] != part.datasets[path]])
        for name in ("history.csv", "fields.xdmf", "scene.toml"):
            self.assertEqual((self.folder / "whole" / name).read_text(), (self.folder / "part" / name).read_text(), name)
        one, other = self.result("whole"), self.result("part")
        for key in ("steps", "time", "dt_min", "dt_max", "errors", "checks", "limiter", "status"):
            self.assertEqual(one.get(key), other.get(key), key)
