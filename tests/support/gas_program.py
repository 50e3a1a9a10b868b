"""Runs drogue-gas for tests of its command line."""

import functools
import json
import os
import pathlib
import pty
import re
import subprocess
import tempfile
import unittest

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


class GasTest(unittest.TestCase):
    """Test case whose programs run in an empty temporary folder."""

    program = PROGRAM

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def start(self, scene, *words, sets=(), **settings):
        return run(scene, *words, sets=sets, cwd=self.folder, program=self.program, **settings)

    def expect(self, code, scene, *words, sets=(), **settings):
        """Runs in the folder, asserts the exit code and that a failure prints one line; returns the process."""
        process = self.start(scene, *words, sets=sets, **settings)
        self.assertEqual(code, process.returncode, f"{process.args}\n{process.stderr}")
        self.assertEqual(0 if code == 0 else 1, len(process.stderr.splitlines()), process.stderr)
        return process

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
