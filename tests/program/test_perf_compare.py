"""drogue-perf compare: verdict words, exit codes, annotations and refusals, on records made here."""

import json
import os
import re
import subprocess

import perf_program

WORDS = {"SAME", "FASTER", "SLOWER", "AMBIGUOUS", "NOT-COMPARABLE", "ERROR-CHANGED"}
CASES = ["gas-step/serial/1024", "gas-step/serial/8192", "options/serial/16/64x16"]


def record(case, scale=1.0, **changes):
    """Record with 30 samples that spread by two per cent, and a median that is wrong on purpose."""
    samples = [scale * 1e-4 * (1.0 + 0.01 * (7 * i % 3)) for i in range(30)]
    provenance = {"cpu": "A", "gpu": "", "threads": 2, "flags": "-O3", "git": "1", "date": "2026-11-20T12:00:00Z"}
    made = {"schema": "drogue.perf/1", "case": case, "unit": "s per step", "bound": "", "samples": samples,
            "median": 1.0, "interval": [1.0, 1.0], "error": 1e-3, "check": "passed",
            "facts": {"backend": "serial", "cells": 1024}, "provenance": provenance}
    return made | changes


class Compare(perf_program.PerfTest):
    def write(self, name, records):
        (self.folder / name).write_text("".join(json.dumps(line) + "\n" for line in records), encoding="utf-8")

    def verdicts(self, text):
        """Verdicts by case; asserts that each line holds at most one verdict word."""
        found = {}
        for line in text.splitlines():
            words = [word for word in re.findall(r"[A-Z][A-Z-]+", line) if word in WORDS]
            self.assertLessEqual(len(words), 1, line)
            if words:
                found[line.split()[0]] = words[0]
        return found

    def compare(self, code, new, *words):
        self.write("old.jsonl", [record(case) for case in CASES])
        self.write("new.jsonl", new)
        return self.expect(code, "compare", "old.jsonl", "new.jsonl", *words)

    def test_prints_a_verdict_per_case(self):
        new = [record(CASES[0], 1.3), record(CASES[1], error=2e-3), record(CASES[2], 0.7), record("new")]
        text = self.compare(0, new).stdout
        self.assertEqual(dict(zip([*CASES, "new"], ["SLOWER", "ERROR-CHANGED", "FASTER", "NOT-COMPARABLE"])),
                         self.verdicts(text))
        self.assertRegex(text, r"(?m)^gas-step/serial/1024 +SLOWER +1\.300 times as long  \[1\.\d+ \.\. 1\.\d+\]"
                               r"  0\.000101 -> 0\.0001313 s per step$")
        self.assertIn("\n4 cases: 0 unchanged, 1 take longer, 1 take less time, 0 undecided, 1 with another error, "
                      "1 not compared (0 vanished, 1 new); 0.954 times as long in the geometric mean of 2\n", text)

    def test_files_of_one_build_have_no_changes(self):
        self.assertEqual({"SAME"}, set(self.verdicts(self.compare(0, [record(case) for case in CASES],
                                                                  "--fail-on", "slower,error").stdout).values()))

    def test_says_that_no_case_could_be_compared(self):
        process = self.compare(0, [record("new")])
        self.assertEqual({"NOT-COMPARABLE"}, set(self.verdicts(process.stdout).values()))
        self.assertTrue(process.stdout.endswith("\nno case could be compared\n"), process.stdout)

    def test_gate_fails_without_a_comparable_case(self):
        other = record(CASES[0])
        other["provenance"] = other["provenance"] | {"cpu": "B"}
        for new, reason in (([record("new")], "new: only in the new records"),
                            ([other], f"{CASES[0]}: other processor: 'A', now 'B'"),
                            ([record(CASES[0], samples=[], median=None, interval=None)], f"{CASES[0]}: a record without samples")):
            for words in ("slower", "error", "slower,error"):
                with self.subTest(reason=reason, words=words):
                    process = self.compare(2, new, "--fail-on", words)
                    self.assertEqual({"NOT-COMPARABLE"}, set(self.verdicts(process.stdout).values()))
                    self.assertIn("no case could be compared, so that --fail-on has nothing to pass; the first, " + reason,
                                  process.stderr)
        self.compare(0, [record("new"), record(CASES[1])], "--fail-on", "slower,error", "--allow-missing")

    def test_gate_fails_where_a_case_vanished(self):
        new = [record("new"), record(CASES[1])]
        self.compare(0, new)
        for words in ("slower", "error", "missing", "slower,error"):
            with self.subTest(words):
                process = self.compare(5, new, "--github", "--fail-on", words)
                for case in (CASES[0], CASES[2]):
                    self.assertIn(f"{case}: only in the old records", process.stderr)
                    self.assertIn(f"::error title={case}::only in the old records", process.stdout)
                self.assertIn("--allow-missing", process.stderr)
                self.assertNotIn("new: only", process.stderr)
                self.assertFalse(WORDS & set(re.findall(r"[A-Z-]+", process.stderr)))
        for words in ("slower", "error", "slower,error"):
            self.compare(0, new, "--fail-on", words, "--allow-missing")
        slow = [record(case, 1.3) for case in CASES]
        self.compare(0, slow, "--fail-on", "missing")
        self.assertIn("contradicts", self.compare(2, new, "--fail-on", "missing", "--allow-missing").stderr)

    def test_gate_fails_where_a_case_cannot_be_compared(self):
        """Its times, three times as long here, would pass unseen as long as one other case compares."""
        other = record(CASES[0], 3.0)
        changes = {
            "a record without samples": {"samples": [], "median": None, "interval": None},
            "other cells: 1024, now 1025": {"facts": other["facts"] | {"cells": 1025}},
            "other compiler flags: '-O3', now '-O2'": {"provenance": other["provenance"] | {"flags": "-O2"}},
            "other number of threads: 2, now 1": {"provenance": other["provenance"] | {"threads": 1}},
            "other unit: 's per step', now 's'": {"unit": "s"},
            "other caches: warm, now cold": {"instrument": {"caches": "cold"}},
        }
        for reason, change in changes.items():
            new = [other | change, record(CASES[1]), record(CASES[2])]
            with self.subTest(reason):
                self.assertEqual("NOT-COMPARABLE", self.verdicts(self.compare(0, new).stdout)[CASES[0]])
                for words in ("slower", "error", "missing", "slower,error,missing"):
                    process = self.compare(5, new, "--github", "--fail-on", words)
                    self.assertIn(f"{CASES[0]}: {reason}; --allow-missing lets it pass", process.stderr)
                    self.assertIn(f"::error title={CASES[0]}::", process.stdout)
                self.compare(0, new, "--fail-on", "slower,error", "--allow-missing")
        computed = record("computed", samples=[], median=None, interval=None)
        self.write("old.jsonl", [record(CASES[1]), computed])
        self.expect(0, "compare", "old.jsonl", "old.jsonl", "--fail-on", "slower,error,missing")
        self.write("new.jsonl", [record(CASES[1]), computed | {"error": 2e-3}])
        self.expect(5, "compare", "old.jsonl", "new.jsonl", "--fail-on", "error")

    def test_says_that_both_are_of_one_commit(self):
        line = "\nboth are of one commit: what differs is the machine, its load or the flags\n"
        self.assertIn(line, self.compare(0, [record(CASES[0], 1.3)]).stdout)
        for commit in ("2", "", "unknown", "1-dirty"):
            records = [record(CASES[0])]
            records[0]["provenance"] = records[0]["provenance"] | {"git": commit}
            self.assertNotIn(line, self.compare(0, records).stdout)
            if commit != "2":
                self.write("old.jsonl", records)
                self.assertNotIn(line, self.expect(0, "compare", "old.jsonl", "new.jsonl").stdout)

    def test_errors_stand_after_the_verdicts_in_one_pipe(self):
        self.write("old.jsonl", [record(f"case {number}") for number in range(200)])
        self.write("new.jsonl", [record(f"case {number}", 1.3) for number in range(200)])
        words = [perf_program.PROGRAM, "compare", "old.jsonl", "new.jsonl", "--fail-on", "slower"]
        text = subprocess.run(words, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False).stdout
        self.assertRegex(text, r"geometric mean of 200\ndrogue-perf: case 0: takes [^\n]*\n\Z")

    def test_gate_fails_where_the_samples_are_too_few(self):
        for count in (1, 3):
            samples = [1e-4] * count
            few = [record(case, samples=samples) for case in CASES]
            for old, new in ((few, few), (None, few), (few, [record(case) for case in CASES])):
                self.write("old.jsonl", old or [record(case) for case in CASES])
                self.write("new.jsonl", new)
                process = self.expect(0, "compare", "old.jsonl", "new.jsonl")
                if count == 1 or old == new:
                    self.assertEqual({"AMBIGUOUS"}, set(self.verdicts(process.stdout).values()))
                    self.assertIn("\n3 cases: 0 unchanged, 0 take longer, 0 take less time, 3 undecided,", process.stdout)
                    process = self.expect(5, "compare", "old.jsonl", "new.jsonl", "--fail-on", "slower", "--github")
                    self.assertIn(f"{CASES[0]}: too few samples", process.stderr)
                    self.assertIn(f"::error title={CASES[0]}::too few samples", process.stdout)
                # Errors need no samples.
                self.expect(0, "compare", "old.jsonl", "new.jsonl", "--fail-on", "error")

    def test_shipped_records_of_equal_builds_do_not_differ(self):
        folder = os.environ["DROGUE_SOURCE"] + "/docs/evidence/quick/"
        text = self.expect(0, "compare", folder + "first.jsonl", folder + "second.jsonl", "--fail-on", "slower,error").stdout
        found = self.verdicts(text)
        self.assertEqual(59, len(found))
        self.assertLessEqual(set(found.values()), {"SAME", "AMBIGUOUS"})

    def test_exit_code_is_5_for_a_named_verdict_alone(self):
        slow, wrong = [record(CASES[0], 1.3)], [record(CASES[0], error=2e-3)]
        for code, new, words in ((0, slow, []), (5, slow, ["--fail-on", "slower"]), (0, slow, ["--fail-on", "error"]),
                                 (5, wrong, ["--fail-on", "error"]), (0, wrong, ["--fail-on", "slower"]),
                                 (5, slow, ["--fail-on", "slower", "--fail-on", "error"]),
                                 (0, [record(CASES[0], 0.7)], ["--fail-on", "slower,error"])):
            with self.subTest(words=words, code=code):
                process = self.compare(code, new, *words, "--allow-missing")
                self.assertEqual(code == 5, CASES[0] in process.stderr)
                self.assertFalse(WORDS & set(re.findall(r"[A-Z-]+", process.stderr)))

    def test_annotates_changes_on_github(self):
        text = self.compare(5, [record(CASES[0], 1.3), record(CASES[1], 0.7), record(CASES[2], error=1.0)],
                            "--github", "--fail-on", "slower").stdout
        self.verdicts(text)
        lines = [line for line in text.splitlines() if line.startswith("::")]
        self.assertEqual([("error", CASES[0]), ("notice", CASES[1]), ("warning", CASES[2])],
                         [re.match(r"::(\w+) title=([^:]+)::", line).groups() for line in lines])

    def test_baseline_of_the_machine_is_taken_from_a_folder(self):
        (self.folder / "baselines").mkdir()
        other = record(CASES[0])
        other["provenance"] = other["provenance"] | {"cpu": "B"}
        self.write("baselines/b.jsonl", [other])
        new = record(CASES[0], 1.3)
        new["provenance"] = new["provenance"] | {"date": "2026-11-25T12:00:00Z", "git": "2"}
        self.write("new.jsonl", [new])
        message = self.expect(2, "compare", "baselines", "new.jsonl").stderr
        self.assertIn("'baselines' has no baseline of the machine 'A' with 2 threads", message)
        self.write("baselines/a.jsonl", [record(CASES[0])])
        text = self.expect(0, "compare", "baselines", "new.jsonl").stdout
        self.assertIn("old: commit 1, date 2026-11-20T12:00:00Z\nnew: commit 2, date 2026-11-25T12:00:00Z; 5.0 days later\n",
                      text)
        self.assertEqual({CASES[0]: "SLOWER"}, self.verdicts(text))
        self.write("baselines/c.jsonl", [record(CASES[0])])
        self.assertIn("several baselines", self.expect(2, "compare", "baselines", "new.jsonl").stderr)

    def test_broken_baselines_are_named_and_left_out(self):
        (self.folder / "baselines").mkdir()
        self.write("new.jsonl", [record(CASES[0], 1.3)])
        (self.folder / "baselines/a.jsonl").write_text('{"schema":')
        self.assertIn("baselines/a.jsonl:1: the line ends within a record",
                      self.expect(2, "compare", "baselines", "new.jsonl").stderr)
        self.write("baselines/b.jsonl", [record(CASES[0])])
        done = self.expect(3, "compare", "baselines", "new.jsonl")
        self.assertEqual({CASES[0]: "SLOWER"}, self.verdicts(done.stdout))
        self.assertIn("left out: baselines/a.jsonl:1: the line ends within a record", done.stdout)
        self.assertIn("baselines/a.jsonl:1: the line ends within a record", done.stderr)
        self.assertIn(CASES[0], self.expect(5, "compare", "baselines", "new.jsonl", "--fail-on", "slower").stderr)

    def test_advises_to_measure_an_old_baseline_again(self):
        new = record(CASES[0])
        for date, advised in (("2026-12-19T12:00:00Z", False), ("2026-12-21T12:00:00Z", True)):
            new["provenance"] = new["provenance"] | {"date": date}
            text = self.compare(0, [new]).stdout
            self.assertEqual(advised, "days later; measure the old commit again before a verdict matters\n" in text, text)

    def test_run_records_the_baseline_of_this_machine(self):
        (self.folder / "baselines").mkdir()
        words = "run", "--quick", "--filter", "^gas-step/dense-loop/1024$", "--baseline"
        self.assertIn("there is no folder 'nowhere'", self.expect(2, *words, "nowhere").stderr)
        self.assertIn("excludes", self.expect(2, *words, "baselines", "--out", "x.jsonl").stderr)
        name = self.expect(0, *words, "baselines").stdout.splitlines()[-1].removeprefix("baseline: ")
        self.assertEqual([name], [f"baselines/{file.name}" for file in (self.folder / "baselines").iterdir()])
        first, = self.records(name)
        text = self.expect(0, *words, "baselines").stdout
        self.assertTrue(text.startswith(f"{name} replaces that of commit {first['provenance']['git']}, date "), text)
        second, = self.records(name)
        self.assertNotEqual(first["samples"], second["samples"])
        self.assertEqual({first["case"]: "SAME"}, self.verdicts(self.expect(0, "compare", "baselines", name).stdout))

    def test_filtered_run_keeps_the_other_cases_of_the_baseline(self):
        (self.folder / "baselines").mkdir()
        words = "run", "--quick", "--baseline", "baselines", "--filter"
        name = self.expect(0, *words, "^gas-step/dense-loop/1024$").stdout.splitlines()[-1].removeprefix("baseline: ")
        measured, = self.records(name)
        old = measured | {"case": "gas-step/dense-loop/1"}
        old["provenance"] = old["provenance"] | {"git": "old", "date": "2026-01-01T12:00:00Z"}
        self.write(name, [old, measured])
        text = self.expect(0, *words, "^gas-step/dense-loop/1024$").stdout
        self.assertIn(f"{name}: replaces 1 record of commit {measured['provenance']['git']}, date ", text)
        self.assertIn(f"{name}: keeps 1 record of other cases, of commit old, date 2026-01-01T12:00:00Z; ", text)
        kept, new = self.records(name)
        self.assertEqual(old, kept)
        self.assertEqual(measured["case"], new["case"])
        self.assertNotEqual(measured["samples"], new["samples"])
        self.assertIn("old: commit old, date 2026-01-01T12:00:00Z, to commit ",
                      self.expect(0, "compare", "baselines", name).stdout)

    def test_filter_selects_cases(self):
        new = [record(case, 1.3) for case in CASES]
        self.assertEqual({CASES[2]: "SLOWER"}, self.verdicts(self.compare(0, new, "--filter", "^options").stdout))
        self.assertIn("no case of the records matches 'nothing'", self.compare(2, new, "--filter", "nothing").stderr)

    def test_refuses_what_is_no_file_of_records(self):
        good = json.dumps(record(CASES[0]))
        for code, content, hint in (
            (3, good[:200], "new.jsonl:1: the line ends within a record"),
            (3, good + "\n" + good.replace("perf/1", "perf/2"), 'new.jsonl:2: the schema is "drogue.perf/2"'),
            (3, '{"time": 1}\n', "new.jsonl:1: no record of drogue-perf"),
            (3, "", "new.jsonl: the file holds no records"),
            (3, json.dumps(record("a\nSLOWER b")), "new.jsonl:1: 'case' holds a control character"),
            (3, json.dumps(record(CASES[0], samples=[float("nan")])), "new.jsonl:1: NaN at column"),
            (3, json.dumps(record(CASES[0], median=None)), f"new.jsonl:1: 'median' of {CASES[0]} is no number beside its samples"),
            (3, json.dumps(record(CASES[0], interval=None)), f"new.jsonl:1: 'interval' of {CASES[0]} is not two numbers"),
            (3, json.dumps(record(CASES[0], samples=[None])), f"new.jsonl:1: samples[0] of {CASES[0]} is no positive"),
            (2, None, "there is no file 'new.jsonl'"),
        ):
            with self.subTest(hint):
                self.write("old.jsonl", [record(CASES[0])])
                (self.folder / "new.jsonl").unlink(missing_ok=True)
                if content is not None:
                    (self.folder / "new.jsonl").write_text(content, encoding="utf-8")
                process = self.expect(code, "compare", "old.jsonl", "new.jsonl")
                self.assertIn(hint, process.stderr)
                self.assertEqual("", process.stdout)

    def test_refuses_unknown_verdicts_and_missing_arguments(self):
        self.assertIn("slower", self.compare(2, [record(CASES[0])], "--fail-on", "slow").stderr)
        self.assertIn("NEW", self.expect(2, "compare", "old.jsonl").stderr)
