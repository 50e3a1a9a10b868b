"""The recipe of docs/perf.md for `git bisect run`, on a history whose build makes a program that writes recorded times."""

import os
import re
import shutil
import subprocess
from pathlib import Path

SOURCE = Path(os.environ["DROGUE_SOURCE"])
import perf_program

# The build of the history: a program whose times and error are those of the file `speed` of the commit.
BUILD = r"""#!/bin/sh
read time error spread < speed
[ "$time" = broken ] && exit 1
mkdir -p build/host/bin
cat > build/host/bin/drogue-perf <<END
#!/usr/bin/env python3
import json, os, sys
if sys.argv[1] == "compare":
    os.execv("%s", sys.argv)
samples = [$time * (1 + ${spread:-0.01} * (7 * i %% 3)) for i in range(30)]
record = dict(schema="drogue.perf/1", case="gas-step/serial/8192", unit="s per step", samples=samples, error=$error, check="passed")
assert sys.argv[sys.argv.index("--filter") + 1] == "^gas-step/serial/8192$"
open(sys.argv[sys.argv.index("--out") + 1], "w").write(json.dumps(record) + "\n")
END
chmod +x build/host/bin/drogue-perf
""" % perf_program.PROGRAM


class Bisect(perf_program.PerfTest):
    def git(self, *words):
        return subprocess.run(["git", "-C", self.folder / "drogue", *words], check=True, capture_output=True, text=True).stdout.strip()

    def found(self, *speed):
        """Output of the recipe for a history with one commit per entry of `speed`, a time, an error and a spread of samples; the first is v0.1.0."""
        tree = self.folder / "drogue"
        (tree / "scripts").mkdir(parents=True)
        self.git("init", "--quiet")
        self.git("config", "user.name", "A")
        self.git("config", "user.email", "a@example.org")
        (tree / "scripts/build.sh").write_text(BUILD, encoding="utf-8")
        (tree / "scripts/build.sh").chmod(0o755)
        for name in ("compare_builds.py", "recording.py"):
            shutil.copy(SOURCE / "scripts" / name, tree / "scripts")
        (tree / ".gitignore").write_text("build/\n__pycache__/\n", encoding="utf-8")
        for number, line in enumerate(speed):
            (tree / "speed").write_text(f"{line}\n", encoding="utf-8")
            (tree / "number").write_text(str(number), encoding="utf-8")
            self.git("add", "-A")
            self.git("commit", "--quiet", "-m", f"change {number}")
        self.git("tag", "v0.1.0", f"HEAD~{len(speed) - 1}")
        page = (SOURCE / "docs/perf.md").read_text(encoding="utf-8")
        recipe = re.search(r"^### The guilty commit\n.*?^```\n(.*?)^```$", page, re.M | re.S)[1]
        done = subprocess.run(["sh", "-c", recipe], cwd=tree, capture_output=True, text=True, check=False)
        return done.stdout + done.stderr

    def test_finds_the_commit_that_made_a_case_slow(self):
        text = self.found(*["1e-3 0.5"] * 3, *["1.3e-3 0.5"] * 3)
        self.assertIn(f"{self.git('rev-parse', 'HEAD~2')} is the first bad commit", text)

    def test_finds_the_commit_that_changed_an_error(self):
        text = self.found(*["1e-3 0.5"] * 2, *["1e-3 0.6"] * 2)
        self.assertIn(f"{self.git('rev-parse', 'HEAD~1')} is the first bad commit", text)

    def test_skips_commits_that_do_not_build(self):
        text = self.found("1e-3 0.5", "1e-3 0.5", "broken 0", "1e-3 0.5", "2e-3 0.5")
        self.assertIn(f"{self.git('rev-parse', 'HEAD')} is the first bad commit", text)

    def test_lists_suspects_if_skipped_commits_hide_the_first(self):
        text = self.found("1e-3 0.5", "broken 0", "2e-3 0.5")
        self.assertIn("only 'skip'ped commits left", text)
        for commit in ("HEAD", "HEAD~1"):
            self.assertIn(self.git("rev-parse", commit), text)

    def test_skips_commits_in_doubt(self):
        text = self.found("1e-3 0.5", "1e-3 0.5 0.5", "3e-3 0.5")
        self.assertIn("AMBIGUOUS", text)
        self.assertIn("only 'skip'ped commits left", text)
