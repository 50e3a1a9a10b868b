"""Runs the commands of README.md in their order and in one folder."""

import os
import pathlib
import re
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

    def test_links_have_targets(self):
        for page in [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]:
            for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
                self.assertTrue((page.parent / target).exists(), f"{page.name}: {target}")


if __name__ == "__main__":
    unittest.main()
