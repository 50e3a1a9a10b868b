"""drogue-perf bisect on a synthetic history, whose build makes a program that prints recorded times."""

import os
import subprocess
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import gas_program
import perf_program

CASE = "gas-step/serial/1024"

# The build of the history: a program whose times and error are those of the file `speed` of the commit.
BUILD = r"""#!/bin/sh
read time error < speed
[ "$time" = broken ] && exit 1
cat > program <<END
#!/usr/bin/env python3
import json, sys
if sys.argv[1] == "list":
    print("" if "--quick" in sys.argv else "%s")
else:
    samples = [$time * (1 + 0.01 * (7 * i %% 3)) for i in range(30)]
    record = dict(schema="drogue.perf/1", case="%s", unit="s per step", samples=samples, error=$error, check="passed")
    assert sys.argv[sys.argv.index("--filter") + 1] == "^%s$"
    open(sys.argv[sys.argv.index("--out") + 1], "w").write(json.dumps(record))
END
chmod +x program
""" % (CASE, CASE, CASE)


class Bisect(perf_program.PerfTest):
    def git(self, *words):
        return subprocess.run(["git", "-C", self.folder / "history", *words], check=True, capture_output=True,
                              text=True).stdout.strip()

    def commit(self, speed):
        """Makes one commit per entry of `speed`: a time and an error."""
        tree = self.folder / "history"
        tree.mkdir()
        self.git("init", "--quiet")
        self.git("config", "user.name", "A")
        self.git("config", "user.email", "a@example.org")
        (tree / "build.sh").write_text(BUILD, encoding="utf-8")
        (tree / ".gitignore").write_text("program\n", encoding="utf-8")
        for number, line in enumerate(speed):
            (tree / "speed").write_text(line + "\n", encoding="utf-8")
            (tree / "number").write_text(str(number), encoding="utf-8")
            self.git("add", "-A")
            self.git("commit", "--quiet", "-m", f"change {number}")

    def bisect(self, code, good, bad, case=CASE, build="sh build.sh"):
        return self.expect(code, "bisect", case, good, bad, "--repository", "history", "--build", build, "--program",
                           "program")

    def test_finds_the_commit_that_made_a_case_slow(self):
        self.commit(["1e-3 0.5"] * 5 + ["1.3e-3 0.5"] * 4)
        text = self.bisect(0, "HEAD~8", "HEAD").stdout
        self.assertEqual(f"first bad commit: {self.git('log', '-1', '--format=%h %s', 'HEAD~3')}", text.splitlines()[-1])
        self.assertTrue(text.splitlines()[-1].endswith(" change 5"))
        # The user's tree and the list of working trees are as before.
        self.assertEqual("", self.git("status", "--porcelain"))
        self.assertEqual(1, len(self.git("worktree", "list").splitlines()))

    def test_finds_the_commit_that_changed_an_error(self):
        self.commit(["1e-3 0.5"] * 2 + ["1e-3 0.6"] * 2)
        self.assertIn("first bad commit: " + self.git("rev-parse", "--short", "HEAD~1"),
                      self.bisect(0, "HEAD~3", "HEAD").stdout)

    def test_skips_commits_that_do_not_build(self):
        self.commit(["1e-3 0.5", "1e-3 0.5", "broken 0", "1e-3 0.5", "2e-3 0.5"])
        text = self.bisect(0, "HEAD~4", "HEAD").stdout
        self.assertIn("change 4", text.splitlines()[-1])
        self.assertRegex(text, r"(?m)^skip  \w+ change 2  \(does not build\)$")

    def test_lists_suspects_if_skipped_commits_hide_the_first(self):
        self.commit(["1e-3 0.5", "broken 0", "2e-3 0.5"])
        message = self.bisect(5, "HEAD~2", "HEAD").stderr
        self.assertIn("change 1", message)
        self.assertIn("change 2", message)

    def test_reports_that_nothing_changed(self):
        self.commit(["1e-3 0.5", "1.01e-3 0.5", "1e-3 0.5"])
        self.assertIn("shows no change from 'HEAD~2' to 'HEAD'", self.bisect(5, "HEAD~2", "HEAD").stderr)

    def test_refuses_unknown_cases_and_commits(self):
        self.commit(["1e-3 0.5", "2e-3 0.5"])
        self.assertIn("there is no case 'gas-step/serial/8192' at 'HEAD~1'",
                      self.bisect(2, "HEAD~1", "HEAD", "gas-step/serial/8192").stderr)
        self.assertIn("there is no commit 'HEAD~7' in 'history'", self.bisect(2, "HEAD~7", "HEAD").stderr)
        self.assertIn("is no ancestor of BAD", self.bisect(2, "HEAD", "HEAD~1").stderr)
        self.assertIn("does not make 'program' of 'HEAD~1'", self.bisect(6, "HEAD~1", "HEAD", build="true").stderr)
        self.assertIn("is in no git repository", self.expect(2, "bisect", CASE, "a", "b", "--repository", "/").stderr)

    def test_refuses_unknown_cases_before_it_builds(self):
        self.commit(["1e-3 0.5", "2e-3 0.5"])
        for case, words in (("gas-step/serial/1025", f'no case \'gas-step/serial/1025\'; did you mean "{CASE}"?'),
                            ("NOSUCHCASE", "no case 'NOSUCHCASE'; see drogue-perf list"),
                            ("gas-stop/cuda/8192", '"gas-step"')):
            self.assertIn(words, self.bisect(2, "HEAD~1", "HEAD", case, build="false").stderr)
        # Backends that this machine lacks may be those of the built programs.
        if "cuda" not in gas_program.backends():
            self.bisect(6, "HEAD~1", "HEAD", "gas-step/cuda/8192", build="false")


if __name__ == "__main__":
    unittest.main()
