"""drogue-perf report: page, CSV and JSON of a folder of records, and refusals."""

import csv
import json
import os
import re
import shutil
import subprocess

import perf_program

RECORDS = os.environ["DROGUE_SOURCE"] + "/docs/evidence/planted"
PLOT = perf_program.PROGRAM.with_name("drogue-plot")


class Report(perf_program.PerfTest):
    def require_packages(self):
        if subprocess.run([PLOT, "--version"], capture_output=True, check=False).returncode != 0:
            self.skipTest("drogue-plot has no Python packages")

    def test_writes_page_and_exports(self):
        self.require_packages()
        text = self.expect(0, "report", RECORDS, "--out", "made").stdout
        self.assertEqual(["made/report.html", "made/records.csv", "made/reframe.json"], text.splitlines())
        with (self.folder / "made/records.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(24, len(rows))
        self.assertEqual({"30"}, {row["samples"] for row in rows})
        cases = json.loads((self.folder / "made/reframe.json").read_text(encoding="utf-8"))["runs"][0]["testcases"]
        self.assertEqual([row["case"] for row in rows], [case["name"] for case in cases])
        page = (self.folder / "made/report.html").read_text(encoding="utf-8")
        self.assertTrue(all(row["case"] in page for row in rows))

    def test_page_shows_verdicts_against_a_baseline(self):
        self.require_packages()
        shutil.copy(RECORDS + "/new.jsonl", self.folder / "new.jsonl")
        words = "report", ".", "--baseline", RECORDS + "/old.jsonl", "--out", "made"
        self.assertIn("made/verdicts.json", self.expect(0, *words).stdout.splitlines())
        verdicts = json.loads((self.folder / "made/verdicts.json").read_text(encoding="utf-8"))
        found = {case["case"]: case["verdict"] for case in verdicts["cases"]}
        text = self.expect(0, "compare", RECORDS + "/old.jsonl", "new.jsonl").stdout
        rows = [line.split() for line in text.splitlines()[2:-1] if not line.startswith("both are of one commit")]
        self.assertEqual({row[0]: row[1] for row in rows}, found)
        self.assertEqual(text.splitlines()[-1], verdicts["summary"])
        page = (self.folder / "made/report.html").read_text(encoding="utf-8")
        self.assertIn('id="verdicts"', page)
        self.assertIn(verdicts["summary"], page)
        slower, = (case for case, verdict in found.items() if verdict == "SLOWER")
        self.assertRegex(page, rf'(?s){slower}</td>\s*<td class="bad">SLOWER')
        self.expect(0, "report", ".", "--out", "made")
        self.assertNotIn('id="verdicts"', (self.folder / "made/report.html").read_text(encoding="utf-8"))
        self.assertFalse((self.folder / "made/verdicts.json").exists())
        self.assertIn("missing", self.expect(2, "report", ".", "--baseline", "missing").stderr)

    def test_refuses_records_with_file_and_line_and_writes_nothing(self):
        self.require_packages()
        with open(RECORDS + "/old.jsonl", encoding="utf-8") as file:
            good = next(line for line in file if '"gas-step/' in line)
        record = json.loads(good)
        facts = record["facts"]
        scaling = record | {"case": "scaling/flow-step/serial/8x8x8/ranks/2/weak",
                            "facts": {"backend": "serial", "cells": 512, "threads": 1}}
        for line, words in (
            (good[: len(good) // 2], "the line ends within a record"),
            ('{"name": "BM_sort", "real_time": 1.5}', "no record of drogue-perf"),
            (good.replace("perf/1", "perf/2"), 'the schema is "drogue.perf/2"'),
            (json.dumps(record | {"samples": [float("nan")]}), "NaN at column"),
            (json.dumps(record | {"samples": ["1e-3"]}), "samples[0] of"),
            (json.dumps(record | {"samples": [1e-200]}), "the samples of"),
            (json.dumps(record | {"facts": "none"}), "'facts' is no JSON object"),
            (json.dumps(record | {"facts": [1]}), "'facts' is no JSON object"),
            (json.dumps(record | {"facts": facts | {"flops": "many"}}), "fact 'flops' of"),
            (json.dumps(record | {"facts": facts | {"flops": [1.0]}}), "fact 'flops' of"),
            (json.dumps(record | {"facts": facts | {"bytes": 1e300}}), "fact 'bytes' of"),
            (json.dumps(record | {"facts": facts | {"launches": 0.5}}), "fact 'launches' of"),
            (json.dumps(record | {"case": "gas-step/serial"}), "is not gas-step/BACKEND/CELLS"),
            (json.dumps(record | {"case": "flow-step/serial/8x8x8/periodic", "facts": {}}), "fact 'backend' of"),
            (json.dumps(scaling), "fact 'ranks' of"),
            (json.dumps(scaling | {"case": "scaling/sort/serial"}), "names no kernel of gas"),
            (json.dumps(record | {"provenance": record["provenance"] | {"threads": "two"}}), "threads of"),
        ):
            with self.subTest(words):
                (self.folder / "a.jsonl").write_text(good + "\n" + line + "\n", encoding="utf-8")
                process = self.expect(3, "report", ".")
                self.assertRegex(process.stderr, r"^(\./)?a\.jsonl:3: .*" + re.escape(words))
                self.assertEqual("", process.stdout)
                self.assertEqual(["a.jsonl"], [file.name for file in self.folder.iterdir()])

    def test_exits_with_6_where_no_page_was_made(self):
        program = self.folder / "bin" / "drogue-perf"
        program.parent.mkdir()
        shutil.copy(perf_program.PROGRAM, program)
        shutil.copy(RECORDS + "/old.jsonl", self.folder / "a.jsonl")
        former = "the page of a former report"
        (self.folder / "report.html").write_text(former, encoding="utf-8")
        for script in (None, "exit 0", "exit 1", "exit 2", "kill -KILL $$"):
            with self.subTest(script):
                if script:
                    program.with_name("drogue-plot").write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
                    program.with_name("drogue-plot").chmod(0o755)
                done = subprocess.run([program, "report", "."], cwd=self.folder, capture_output=True, text=True, check=False)
                self.assertEqual(6, done.returncode, done.stdout + done.stderr)
                self.assertEqual(["./records.csv", "./reframe.json"], done.stdout.splitlines())
                # drogue-plot gives its own reason with code 2.
                said = "" if script == "exit 2" else "drogue-perf: report.html was not made: "
                self.assertTrue(done.stderr.startswith(said) and done.stderr.count("\n") == (script != "exit 2"), done.stderr)
        self.assertEqual(former, (self.folder / "report.html").read_text(encoding="utf-8"))

    def test_executes_no_file_of_the_working_folder(self):
        self.require_packages()
        shutil.copy(RECORDS + "/old.jsonl", self.folder / "a.jsonl")
        for name in ("plot", "csv", "numpy"):
            (self.folder / f"{name}.py").write_text("raise SystemExit(0)\n", encoding="utf-8")
        made = self.expect(0, "report", ".", environment={"MPLBACKEND": "module://matplotlib_inline.backend_inline"}).stdout
        self.assertEqual("report.html", made.splitlines()[0])

    def test_refuses_folders_without_valid_records(self):
        self.assertIn("there is no folder 'missing'", self.expect(2, "report", "missing").stderr)
        self.assertIn("holds no records", self.expect(2, "report", ".").stderr)
        shutil.copy(RECORDS + "/old.jsonl", self.folder / "a.jsonl")
        (self.folder / "b.jsonl").write_text("{", encoding="utf-8")
        process = self.expect(3, "report", ".")
        self.assertRegex(process.stderr, r"^\./b\.jsonl:1: the line ends within a record")
        self.assertEqual(["a.jsonl", "b.jsonl"], sorted(file.name for file in self.folder.iterdir()))
        (self.folder / "b.jsonl").unlink()
        self.assertIn("cannot be made", self.expect(6, "report", ".", "--out", "a.jsonl/x").stderr)
