"""drogue-plot as a process: signals, ranks of a launcher, lost output, and the version."""

import os
import signal
import subprocess
import sys
import time

import packages  # before modules that need the packages  isort: skip
from folder_test import FolderTest
import synthetic
from PIL import Image
from plot import style
from plot.failure import Failure

_LAUNCHERS = ("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE", "PMIX_RANK", "SLURM_NTASKS")
_INTERRUPTED = r"\Adrogue-plot: interrupted by a signal; .*\.\n\Z"


class ProgramTest(FolderTest):
    def start(self, *words, stdout=subprocess.PIPE, environment=None, **settings):
        """Starts the interpreter with `words`, as users do: with a buffered standard output."""
        absent = ("PYTHONUNBUFFERED", *_LAUNCHERS)
        own = {name: value for name, value in os.environ.items() if name not in absent}
        own |= {"PYTHONPATH": str(packages.SOURCE / "scripts")} | (environment or {})
        return subprocess.Popen([sys.executable, *map(str, words)], stdout=stdout, stderr=subprocess.PIPE, text=True,
                                env=own, **settings)

    def plot(self, *words, **settings):
        """Exit code, standard output and standard error."""
        process = self.start("-m", "plot", *words, **settings)
        out, err = process.communicate(timeout=300)
        return process.returncode, out, err


class Signals(ProgramTest):
    def test_signal_ends_with_one_sentence_and_leaves_whole_pictures(self):
        run = synthetic.write_sod(self.folder / "sod", cells=20, snapshots=100)
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                process = self.start("-m", "plot", run, "--out", self.folder / number.name)
                first = process.stdout.readline()
                process.send_signal(number)
                more, err = process.communicate(timeout=300)
                self.assertEqual(process.returncode, 130, err)
                self.assertRegex(err, _INTERRUPTED)
                files = (first + more).split()
                self.assertEqual(sorted(map(str, (self.folder / number.name).iterdir())), sorted(files))
                for file in files:
                    with Image.open(file) as image:
                        image.load()

    def test_signal_removes_the_unfinished_file(self):
        file = self.folder / "fields.png"
        file.write_text("former")
        self.interrupted(
            "from pathlib import Path\n"
            "from plot.style import write_atomically\n"
            "def write_half(temporary):\n    temporary.write_text('half')\n    end()\n"
            f"def body():\n    write_atomically(Path({str(file)!r}), write_half)\n"
        )
        self.assertEqual([file], list(self.folder.iterdir()))
        self.assertEqual("former", file.read_text())

    def test_signal_ends_the_encoder_of_movies(self):
        run = synthetic.write_sod(self.folder / "sod", cells=20, snapshots=2)
        encoder, started = self.folder / "ffmpeg", self.folder / "started"
        encoder.write_text(f'#!/bin/sh\ntouch {started}\nsleep 1\nfor file; do :; done\necho half >"$file"\n')
        encoder.chmod(0o755)
        out = self.folder / "out"
        process = self.start("-m", "plot", run, "--out", out, "--movie", "mp4",
                             environment={"IMAGEIO_FFMPEG_EXE": str(encoder)})
        while not started.exists() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        err = process.communicate(timeout=300)[1]
        self.assertEqual(process.returncode, 130, err)
        time.sleep(1.5)
        self.assertEqual(["fields.png"], [file.name for file in out.iterdir()])

    def test_signal_ends_the_program_where_python_loses_exceptions(self):
        self.interrupted("class Item:\n    __del__ = lambda self: end()\ndef body():\n    Item()\n    time.sleep(60)\n")
        self.interrupted(
            "def body():\n    try:\n        end()\n    except BaseException:\n        raise ImportError('no')\n"
        )

    def interrupted(self, body):
        """Runs the code of a function `body`, in which end() sends a signal to its own process."""
        prelude = (
            "import os, signal, sys, time\n"
            "from plot.program import run_program\n"
            "def end():\n    os.kill(os.getpid(), signal.SIGINT)\n    time.sleep(60)\n"
        )
        process = self.start("-c", f"{prelude}{body}sys.exit(run_program(body))")
        err = process.communicate(timeout=300)[1]
        self.assertEqual(process.returncode, 130, err)
        self.assertRegex(err, _INTERRUPTED)


class Writing(ProgramTest):
    def test_failure_leaves_no_unfinished_file(self):
        def write_half(temporary):
            temporary.write_text("half")
            raise Failure(6, "ffmpeg could not write it.")

        with self.assertRaises(Failure):
            style.write_atomically(self.folder / "fields.mp4", write_half)
        self.assertEqual([], list(self.folder.iterdir()))


class SeveralRanks(ProgramTest):
    def test_rejects_several_ranks(self):
        run = synthetic.write_sod(self.folder / "sod", cells=20, snapshots=1)
        before = sorted(run.iterdir())
        for environment in ({"OMPI_COMM_WORLD_SIZE": "2", "OMPI_COMM_WORLD_RANK": "0"}, {"OMPI_COMM_WORLD_SIZE": "2"},
                            {"PMI_SIZE": "2", "PMI_RANK": "0"}, {"SLURM_NTASKS": "2", "PMIX_RANK": "0"}):
            with self.subTest(environment=environment):
                code, out, err = self.plot(run, environment=environment)
                self.assertEqual((code, out, err.count("\n")), (2, "", 1), err)
                self.assertIn("with one rank, not 2", err)
        second = {"OMPI_COMM_WORLD_SIZE": "2", "OMPI_COMM_WORLD_RANK": "1"}
        self.assertEqual((2, "", ""), self.plot(run, environment=second))
        self.assertEqual((0, "", ""), self.plot("--help", environment=second))
        self.assertEqual(before, sorted(run.iterdir()))

    def test_accepts_one_rank(self):
        synthetic.write_history(self.folder / "history.csv")
        for environment in ({"OMPI_COMM_WORLD_SIZE": "1", "OMPI_COMM_WORLD_RANK": "0"}, {"SLURM_NTASKS": "64"},
                            {"OMPI_COMM_WORLD_SIZE": "many"}):
            with self.subTest(environment=environment):
                code, out, err = self.plot(self.folder, environment=environment)
                self.assertEqual((code, out, err), (0, f"{self.folder / 'history.png'}\n", ""))


class Output(ProgramTest):
    def test_reports_lost_output(self):
        synthetic.write_history(self.folder / "history.csv")
        lost = (6, None, "drogue-plot: cannot write to standard output.\n")
        for words in (["--help"], ["--version"], [self.folder]):
            with self.subTest(words), open("/dev/full", "w") as full:
                self.assertEqual(lost, self.plot(*words, stdout=full))
                self.assertEqual(lost, self.plot(*words, stdout=None, preexec_fn=lambda: os.close(1)))

    def test_version_names_the_commit_like_the_compiled_programs(self):
        git = ["git", "-C", packages.SOURCE, "rev-parse", "--short=12", "HEAD"]
        commit = subprocess.run(git, capture_output=True, text=True, check=False).stdout.strip() or "unknown"
        code, out, err = self.plot("--version")
        self.assertEqual((code, err), (0, ""))
        self.assertIn(f"(git {commit})\n", out)
