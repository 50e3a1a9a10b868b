"""Runs the commands of README.md, and those of docs/start.md with their scene, in their order and in one folder each."""

import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

BIN = pathlib.Path(os.environ["DROGUE_BIN"])
SOURCE = pathlib.Path(os.environ["DROGUE_SOURCE"])


def shown_commands():
    """Lines in code blocks of README.md that start a built program."""
    blocks = re.findall(r"^```\n(.*?)^```", (SOURCE / "README.md").read_text(), re.MULTILINE | re.DOTALL)
    return [line.split() for block in blocks for line in block.splitlines() if line.startswith("build/host/bin/")]


class Readme(unittest.TestCase):
    def test_shown_commands_work(self):
        commands = shown_commands()
        self.assertGreaterEqual(len(commands), 5)
        with tempfile.TemporaryDirectory() as folder:
            for program, *arguments in commands:
                built = BIN / pathlib.Path(program).name
                done = subprocess.run([built, *arguments], cwd=folder, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, f"{program} {' '.join(arguments)}\n{done.stdout}{done.stderr}")

    def test_shown_scripts_exist(self):
        for script in re.findall(r"^(scripts/\S+)", (SOURCE / "README.md").read_text(), re.MULTILINE):
            self.assertTrue(os.access(SOURCE / script, os.X_OK), script)


class Start(unittest.TestCase):
    TEXT = (SOURCE / "docs/start.md").read_text(encoding="utf-8")

    @staticmethod
    def masked(line):
        """The line without what differs between machines: numbers and the backend."""
        return re.sub(r" on \w+:", " on BACKEND:", re.sub(r"\d[\d.]*(e[+-]?\d+)?", "N", line.strip()))

    def run_program(self, code, command, folder):
        program, *arguments = shlex.split(command)
        done = subprocess.run([BIN / pathlib.Path(program).name, *arguments], cwd=folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, code, f"{command}\n{done.stdout}{done.stderr}")
        return done

    def test_commands_and_the_scene_run_as_printed(self):
        commands, scene, printed = [], None, set()
        with tempfile.TemporaryDirectory() as folder:
            for language, block in re.findall(r"^```(\w*)\n(.*?)^```$", self.TEXT, re.MULTILINE | re.DOTALL):
                if language == "toml":
                    scene = pathlib.Path(folder) / "my-parachute.toml"
                    scene.write_text(block, encoding="utf-8")
                elif language == "text":
                    self.assertEqual([], [line for line in block.splitlines() if self.masked(line) not in printed])
                else:
                    for command in (line for line in block.splitlines() if line.startswith("build/host/bin/")):
                        commands.append(command)
                        printed.update(map(self.masked, self.run_program(0, command, folder).stdout.splitlines()))
            self.assertGreaterEqual(len(commands), 6)
            misspelt = scene.read_text(encoding="utf-8").replace("from = ", "frm = ")
            scene.write_text(misspelt, encoding="utf-8")
            sentence = self.run_program(3, "drogue-parachute my-parachute.toml --check", folder).stderr.strip()
            self.assertIn(f"`{sentence}`", self.TEXT)

    def test_builds_what_it_runs(self):
        scripts = re.findall(r"^(scripts/\S+)(.*)", self.TEXT, re.MULTILINE)
        self.assertEqual([], [script for script, _ in scripts if not os.access(SOURCE / script, os.X_OK)])
        built = set(re.findall(r"--target (\S+)", "".join(options for _, options in scripts)))
        self.assertEqual(built | {"drogue-plot"}, set(re.findall(r"^build/host/bin/(\S+)", self.TEXT, re.MULTILINE)))

    def test_takes_ten_minutes_to_read(self):
        self.assertLessEqual(len(self.TEXT.split()), 1500)
