"""examples/perf-regression.yml: the steps of the workflow, run by bash beside two trees whose builds are imitated."""

import json
import os
import pathlib
import re
import subprocess
import textwrap

import perf_program

SOURCE = pathlib.Path(os.environ["DROGUE_SOURCE"])
WORKFLOW = (SOURCE / "examples/perf-regression.yml").read_text(encoding="utf-8")
# Measures as a tree whose steps take so long; all else is done by the program of this build.
PERF = f"""#!/bin/sh
case "$1" in
  run) sed "s/SCALE/$(cat "${{0%/build/*}}/scale")/g" template >"$4" && [ "$2 $3" = "--quick --out" ] ;;
  report) mkdir -p "$2" && echo page >"$2/report.html" ;;
  *) exec {perf_program.PROGRAM} "$@" ;;
esac
"""


def steps():
    """Commands of the steps that have some, by name."""
    found = {}
    for part in re.split(r"(?m)^      - ", WORKFLOW)[1:]:
        name = re.match(r"name: (.*)", part)
        block = re.search(r"(?m)^        run: \|\n((?:          .*\n|\n)+)", part) or re.search(r"(?m)^        run: (.*\n)", part)
        if name and block:
            found[name[1]] = textwrap.dedent(block[1])
    return found


class Workflow(perf_program.PerfTest):
    def setUp(self):
        super().setUp()
        provenance = {"cpu": "A", "gpu": "", "threads": 2, "flags": "-O3", "git": "1", "date": "2026-11-20T12:00:00Z"}
        # The samples of a run spread by one per cent.
        record = {"schema": "drogue.perf/1", "case": "gas-step/serial/1024", "unit": "s per step", "bound": "", "median": 1.0,
                  "interval": [1.0, 1.0], "samples": "SAMPLES", "error": 1e-3, "check": "passed",
                  "facts": {"backend": "serial", "cells": 1024}, "provenance": provenance}
        samples = [f"SCALE0{7 * i % 10}e-3" for i in range(30)]
        line = json.dumps(record).replace('"SAMPLES"', f"[{', '.join(samples)}]")
        (self.folder / "template").write_text(line + "\n", encoding="utf-8")

    def tree(self, side, scale):
        """A tree whose scripts note that they ran, and whose program needs `scale` ms for a step."""
        for name, text in (("scripts/setup.sh", "#!/bin/sh\necho setup $0 >>log\n"),
                           ("scripts/build.sh", '#!/bin/sh\necho "build $*" >>log\n'), ("build/host/bin/drogue-perf", PERF)):
            file = self.folder / side / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
            file.chmod(0o755)
        (self.folder / side / "scale").write_text(scale, encoding="utf-8")

    def run_steps(self, old, new):
        """Exit codes of the steps by name."""
        self.tree("old", old)
        self.tree("new", new)
        return {name: subprocess.run(["bash", "-e", "-c", text], cwd=self.folder, capture_output=True, text=True, check=False)
                for name, text in steps().items()}

    def test_equal_trees_pass(self):
        done = self.run_steps("1.0", "1.0")
        self.assertEqual(["Build both", "Measure in turns", "Compare", "Page"], list(done))
        for name, process in done.items():
            self.assertEqual(0, process.returncode, name + process.stderr)
        self.assertEqual(["setup new/scripts/setup.sh", *["build host --target drogue-perf"] * 2],
                         (self.folder / "log").read_text(encoding="utf-8").splitlines())
        self.assertEqual(3, len((self.folder / "new.jsonl").read_text(encoding="utf-8").splitlines()))
        self.assertTrue((self.folder / "report/report.html").exists())

    def test_slower_tree_fails_with_an_annotation(self):
        done = self.run_steps("1.0", "1.3")
        self.assertEqual(5, done["Compare"].returncode, done["Compare"].stderr)
        self.assertIn("::error title=gas-step/serial/1024::", done["Compare"].stdout)

    def test_scripts_and_options_exist(self):
        for script in set(re.findall(r"(scripts/[\w.]+)", WORKFLOW)):
            self.assertTrue((SOURCE / script).exists(), script)
        for command in ("run", "compare", "report"):
            words = self.expect(0, command, "--help").stdout
            for line in re.findall(rf"drogue-perf {command} (.*)", WORKFLOW):
                for option in re.findall(r"--[\w-]+", line):
                    self.assertIn(option, words, command)
