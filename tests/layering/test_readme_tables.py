"""The tables of README.md are those of their records, its counts those of the tree, and the generator refuses bad records."""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace

import layers

ROOT = layers.repository(os.environ)
sys.path.insert(0, str(ROOT / "scripts"))
import publish_records  # noqa: E402
from plot.evidence.perf_record import SCHEMA  # noqa: E402
from tables import benchmark, forms, readme, results, transfers  # noqa: E402

README = (ROOT / "README.md").read_text(encoding="utf-8")


def data_rows(file):
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if line.strip() and not line.startswith("#")]
    return len(list(csv.DictReader(lines)))


def scenes(name):
    return {run["scene"] for run in json.loads((ROOT / "docs/evidence" / name).read_text(encoding="utf-8"))["runs"]}


class Repository(unittest.TestCase):
    def test_tables_of_all_pages_equal_their_records(self):
        words = [sys.executable, "-B", ROOT / "scripts/publish_records.py", "--tables", "--check"]
        process = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual(0, process.returncode, process.stderr)

    def test_every_rung_of_a_record_passed_its_check(self):
        for file in (ROOT / "docs/evidence/ladders").glob("*.jsonl"):
            self.assertNotIn('"check":"failed"', file.read_text(encoding="utf-8"), file.name)

    def test_every_table_of_numbers_has_marks(self):
        outside = readme.MARK.sub("", README)
        self.assertNotRegex(outside, r"\n\|(?:---:\|){2,}\n")

    def test_numbers_of_other_programs_stand_in_the_notebook(self):
        notebook = (ROOT / "docs/options-notebook.md").read_text(encoding="utf-8")
        stated = re.search(r"took (\S+ to \S+) ms for one option and (\S+) ms for 4096", " ".join(README.split()))
        for words in stated.groups():
            self.assertIn(f"| {words} |", notebook)

    def test_counts_are_those_of_the_tree(self):
        for words, count in (
            (r"(\d+) scenes of gas, each", len(scenes("gas-h100.json") & scenes("gas-xeon-2.json"))),
            (r"(\d+) scenes of cloth and strings", len(scenes("springs-h100.json") & scenes("springs-xeon-2.json"))),
            (r"(\d+) small scenes of flows", len(json.loads((ROOT / "docs/evidence/parachute-exact-h200.json").read_text())["exact"])),
            (r"(\d+) hard cases of options", data_rows(ROOT / "tests/hard/options.csv")),
            (r"(\d+) hard-case runs of gas", data_rows(ROOT / "tests/hard/tolerances.csv")),
        ):
            self.assertEqual([str(count)], re.findall(words, README), words)


class Generator(unittest.TestCase):
    """Changed copies of the records."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.evidence = Path(folder.name)
        (self.evidence / "alone").mkdir()
        for name in ("gas-solution-h100", "springs-solution-h200", "springs-solution-epyc", "options-epyc", "flow-h200",
                     "parachute-solution-h200", "flight-h200"):
            shutil.copy(forms.EVIDENCE / f"{name}.jsonl", self.evidence)
        shutil.copy(forms.EVIDENCE / "alone/options-h200.jsonl", self.evidence / "alone")

    def change(self, case, **values):
        """Appends a later record of a case of flow."""
        file = self.evidence / "flow-h200.jsonl"
        record, = (r for r in map(json.loads, file.read_text(encoding="utf-8").splitlines()) if r["case"] == case)
        record["provenance"]["date"] = "2099-01-01T00:00:00Z"
        (self.evidence / "flow-later-h200.jsonl").write_text(json.dumps(record | values) + "\n", encoding="utf-8")

    def test_latest_record_counts(self):
        self.change("flow-step/cuda/64x64x64/periodic", samples=[2e-3, 3e-3, 1e-3], error=2.5e-9)
        changed = readme.renewed(README, self.evidence)
        self.assertIn("| 64x64x64 | 2.00 | 7.63 | 2.5e-9 | | | |", changed)
        self.assertIn("2099-01-01", changed)

    def test_refuses_failed_and_missing_records(self):
        self.change("flow-step/cuda/64x64x64/periodic", check="failed")
        with self.assertRaisesRegex(SystemExit, r"flow-later-h200\.jsonl:1: .* failed its check"):
            readme.renewed(README, self.evidence)
        (self.evidence / "options-epyc.jsonl").unlink()
        (self.evidence / "springs-solution-h200.jsonl").unlink()
        with self.assertRaisesRegex(SystemExit, "holds no record of springs-solution/drum/cuda/biquadratic/61"):
            readme.springs_table(self.evidence)

    def test_refuses_a_table_of_two_machines(self):
        case = "flow-step/cuda/64x64x64/periodic"
        old = readme.Records(self.evidence, "flow*")(case).provenance
        self.change(case, provenance=old | {"gpu": "another GPU", "date": "2099-01-01T00:00:00Z"})
        with self.assertRaisesRegex(SystemExit, "records of NVIDIA H200 and another GPU in one table"):
            readme.flow_table(self.evidence)

    def test_refuses_pages_without_a_mark(self):
        with self.assertRaisesRegex(SystemExit, "README.md has marks for"):
            readme.renewed(README.replace("table: gas", "other: gas"), self.evidence)

    def test_numbers_have_three_digits_and_short_exponents(self):
        times = {1.0: "1000", 0.0123456: "12.3", 9.154: "9154", 1e-6: "0.00100", 0.1: "100"}
        self.assertEqual(list(times.values()), [forms.time_of(SimpleNamespace(samples=[s]), 1e3) for s in times])
        errors = [(0.045, 3, "0.045"), (0.017, 2, "1.7e-2"), (2.5e-18, 2, "2.5e-18"), (3.6e-6, 2, "3.6e-6"), (0.0, 2, "0.0e+00")]
        self.assertEqual([text for *_, text in errors], [forms.error_of(SimpleNamespace(error=e), n) for e, n, _ in errors])


class Results(unittest.TestCase):
    def test_numbers_are_short(self):
        values = {0.0: "0", 2e-3: "2e-3", 2.026e-3: "2.03e-3", 1e-14: "1e-14", 0.0784: "0.0784", 0.325: "0.325", 43.1: "43.1", 2250.0: "2250"}
        self.assertEqual(list(values.values()), [results.number(value) for value in values])


class Benchmark(unittest.TestCase):
    """Records of a problem on one rank, and of weak scaling."""

    PAGE = "A\n<!-- table: benchmark -->\nold\n<!-- end -->\nB\n"

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.evidence = Path(folder.name)

    def write(self, name, case, check="passed", **facts):
        facts = {"backend": "openmp", "cells": 4096, "problem": "puts", "size": "small", "extent": "4096 options", "ranks": 1, "threads": 2,
                 "memory_bytes": 23_000_000, "quantity": "price", "expected": [1e-6, 2e-6], "merit": "options_per_s",
                 "figure_of_merit": 2048.0, "command": "x"} | facts
        line = {"schema": SCHEMA, "case": f"benchmark/{case}", "check": check, "error": 1.9e-6, "samples": [2.0], "median": 2.0,
                "interval": [2.0, 2.0], "facts": facts,
                "provenance": {"gpu": "", "cpu": "core", "driver": "", "date": "2026-01-02T00:00:00Z", "git": "abc"}}
        (self.evidence / f"benchmark-{name}.jsonl").write_text(json.dumps(line) + "\n", encoding="utf-8")

    def test_table_and_summary_show_figures_with_errors(self):
        self.write("here", "puts/openmp/small/ranks/1", environment={"OMP_PLACES": "cores"})
        self.write("weak", "taylor-green/cuda/large/ranks/4/weak", backend="cuda", ranks=4, merit="cell_steps_per_s", figure_of_merit=3e9, efficiency=0.93)
        text = benchmark.renewed(self.PAGE, self.evidence)
        self.assertIn("| `puts` | 4096 options | 1 x 2 | 23 | 2 | 2048 options/s | 1.9e-6 (1e-6 .. 2e-6) |", text)
        self.assertIn("`OMP_PLACES=cores drogue-perf benchmark --size small --backend openmp --threads 2`", text)
        self.assertIn("--weak --ranks 4`", text)
        self.assertIn("| 3000 M cell-steps/s, 93 % |", text)
        self.assertIn("| process, MB |", text)
        self.assertIn("| arrays, MB |", text)
        self.assertTrue(text.startswith("A\n") and text.endswith("B\n") and "old" not in text)

    def test_summary_shows_the_largest_size_on_each_backend(self):
        self.write("here", "puts/openmp/medium/ranks/1", size="medium")
        self.write("small", "puts/openmp/small/ranks/1")
        self.write("weak", "taylor-green/openmp/large/ranks/4/weak", size="large", ranks=4, efficiency=0.93)
        self.write("core", "puts/serial/small/ranks/1", backend="serial", threads=1)
        self.assertEqual(["2 threads of a core, size medium ([record](docs/evidence/benchmark-here.jsonl)): 2048 options/s (`puts`).",
                          "One thread of a core, size small ([record](docs/evidence/benchmark-core.jsonl)): 2048 options/s (`puts`)."],
                         benchmark.summary(self.evidence))

    def test_refuses_wrong_answers_and_no_records(self):
        with self.assertRaisesRegex(SystemExit, "docs/evidence a file benchmark"):
            benchmark.renewed(self.PAGE, self.evidence)
        self.write("here", "puts/openmp/small/ranks/1", check="failed")
        with self.assertRaisesRegex(SystemExit, "failed its check"):
            benchmark.renewed(self.PAGE, self.evidence)


class Transfers(unittest.TestCase):
    """Records of a GPU with one time per part: copies of 10 and 30 us, compute of 60 us."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.evidence = Path(folder.name)

    def write(self, app, *rows, machine="here", date="2026-01-02T00:00:00Z"):
        lines = []
        for facts in rows:
            facts = {"backend": "cuda", "h2d_s": 1e-5, "compute_s": 6e-5, "d2h_s": 3e-5} | facts
            lines.append({"schema": SCHEMA, "case": f"{app}-transfers/cuda/x", "check": "passed", "error": 2.5e-6, "samples": [1e-4],
                          "median": 1e-4, "interval": [1e-4, 1e-4], "facts": facts,
                          "provenance": {"gpu": "a GPU", "cpu": "a core", "date": date, "git": "abc"}})
        text = "".join(json.dumps(line) + "\n" for line in lines)
        (self.evidence / f"{app}-transfers-{machine}.jsonl").write_text(text, encoding="utf-8")

    def test_shows_our_scheme_of_gas_beside_that_of_the_dissertation(self):
        thesis = {"h2d_us": 500, "compute_us": 300, "d2h_us": 200, "total_us": 1000}
        self.write("gas", *({"cells": 8192, "memory": memory, "method": method, "thesis": thesis}
                            for method in ("seed", "ours") for memory in ("pageable", "pinned")))
        text = transfers.page(self.evidence)
        self.assertIn("| ours | pinned | 8192 | 10 (500) | 60 (300) | 30 (200) | 100 (1000) | 2.5e-6 |", text)
        words = " ".join(text.split())
        self.assertIn("[Shi] spends 70 % of 1000 us on copies", words)
        self.assertIn("40 % of 100 us with pageable memory and 40 % of 100 us with pinned memory", words)
        self.assertIn("a step of ours takes 100 us, copies included (40 %)", words)

    def test_shows_computation_on_one_core_beside_the_cpu_of_the_dissertation(self):
        thesis = {"h2d_us": 500, "compute_us": 300, "d2h_us": 200, "total_us": 1000}
        row = {"memory": "pageable", "method": "seed"}
        self.write("gas", *(row | {"cells": cells, "thesis": thesis | printed} | core
                            for cells, printed, core in ((1024, {}, {"cpu_s": 6e-4}), (2048, {"cpu_us": 6000}, {"cpu_s": 1.2e-3}),
                                                         (3072, {"cpu_us": 9000}, {}))))
        text = transfers.rows_page(self.evidence)
        self.assertIn("| total | CPU | CPU / compute | CPU / total | error |", text)
        cells = {line.split(" | ")[2]: line.split(" | ")[7:10] for line in text.splitlines() if line.startswith("| of [Shi]")}
        self.assertEqual({"1024": ["600", "10", "6"], "2048": ["1200 (6000)", "20 (20)", "12 (6)"],
                          "3072": ["- (9000)", "- (30)", "- (9)"]}, cells)
        largest = [line.split(" | ")[2] for line in transfers.page(self.evidence).splitlines() if line.startswith("| of [Shi]")]
        self.assertEqual(["3072"], largest)

    def test_latest_record_of_a_gpu_counts_with_the_times_of_a_core_of_the_latest_host(self):
        row = {"cells": 1024, "memory": "pageable", "method": "seed", "thesis": {"h2d_us": 5, "compute_us": 3, "d2h_us": 2, "total_us": 10}}
        self.write("gas", row | {"compute_s": 6e-5}, machine="new", date="2026-02-01T00:00:00Z")
        self.write("gas", row | {"compute_s": 9e-5}, machine="old", date="2026-01-01T00:00:00Z")
        self.write("gas", row | {"backend": "openmp", "cpu_s": 6e-4}, machine="host", date="2026-03-01T00:00:00Z")
        self.write("gas", row | {"backend": "serial", "cpu_s": 9e-4}, machine="old-host", date="2026-01-01T00:00:00Z")
        text = transfers.page(self.evidence)
        self.assertEqual(1, text.count("## Gas"))
        self.assertIn("evidence/gas-transfers-new.jsonl", text)
        self.assertIn("CPU: one core of a core, 2026-03-01, commit abc ([records](evidence/gas-transfers-host.jsonl)).", " ".join(text.split()))
        self.assertIn("| 60 (3) | 30 (2) | 100 (10) | 600 | 10 | 6 |", text)

    def test_parachutes_have_no_times_of_the_dissertation(self):
        self.write("parachute", *({"cells": 3456, "grid": "12x12x24", "memory": "pageable", "substeps": steps} for steps in (1, 20)))
        text = transfers.page(self.evidence)
        self.assertIn("| pageable | 12x12x24 | 20 | 10 | 60 | 30 | 100 | 2.5e-6 |", text)
        self.assertIn("would take 40 us, 40 % of the step", " ".join(text.split()))


class EvidenceRows(unittest.TestCase):
    PAGE = "# Evidence\n\n| file | written by | machine |\n|---|---|---|\n| `a-h200.jsonl` | `old` | old |\n| `z.png` | x | y |\n\nEnd\n"

    def test_files_of_the_repository_have_rows_and_rows_have_files(self):
        self.assertEqual(([], []), publish_records.unlisted(forms.EVIDENCE))

    def test_finds_rows_without_a_file_and_files_without_a_row(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "README.md").write_text(self.PAGE.replace("z.png", "b/*.png`, `b/*-h200.jsonl"), encoding="utf-8")
            (folder / "b").mkdir()
            for file in ("page.html", "page.png", "b/z.png", "b/c-h200.jsonl", "b/c-epyc.jsonl", "b/page.html", "End"):
                (folder / file).touch()
            self.assertEqual((["a-h200.jsonl"], ["End", "b/c-epyc.jsonl"]), publish_records.unlisted(folder))

    def test_replaces_rows_and_adds_new_ones(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "alone").mkdir()
            for record, command in (
                ("a", "drogue-perf run --filter '^(a|b)/'"), ("ladder-weno", "drogue-perf ladder weno"),
                ("alone/options-1", "drogue-perf run --filter '^options/cuda/1/'"),
                ("alone/options-4096", "drogue-perf run --filter '^options/cuda/4096/'"),
            ):
                origin = {"gpu": "NVIDIA H200", "cpu": "", "driver": "13.0", "date": "2026-11-27T01:02:03Z", "git": "abc"}
                line = json.dumps({"schema": SCHEMA, "case": record, "check": "passed", "facts": {"backend": "cuda"}, "provenance": origin})
                (folder / f"{record}.jsonl").write_text(line + "\n", encoding="utf-8")
                (folder / f"{record}.txt").write_text(command + " \nprinted\n", encoding="utf-8")
            text = publish_records.renewed(self.PAGE, publish_records.rows(folder, "h200"))
        machine = "one NVIDIA H200, CUDA 13.0, 2026-11-27, commit abc"
        self.assertEqual(
            ["# Evidence", "", "| file | written by | machine |", "|---|---|---|",
             f"| `a-h200.jsonl` | `drogue-perf run --filter '^(a\\|b)/' --out a-h200.jsonl` | {machine} |", "| `z.png` | x | y |",
             f"| `alone/options-h200.jsonl` | `drogue-perf run --filter '^options/cuda/N/' --out options-N.jsonl`, one run per N | {machine} |",
             f"| `ladders/weno-cuda-h200.jsonl` | `drogue-perf ladder weno --out weno-cuda-h200.jsonl` | {machine} |",
             "", "End", ""],
            text.split("\n"))
