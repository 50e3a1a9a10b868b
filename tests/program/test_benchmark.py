"""drogue-perf benchmark: answers that are right and wrong, records, repeated commands, ranks, and usage errors."""

import json
import os
import pathlib
import shutil
import subprocess
import sys

import perf_program

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/scripts")
from plot.evidence import perf_record  # noqa: E402

# Stands for a program of the suite: plan.json beside it has the exit code, and what differs in its result. A number of prices by
# their errors makes prices of the known puts.
PROGRAM = """#!{python} -IS
import json, os, pathlib, sys, time
words, here, ranks = sys.argv[1:], pathlib.Path(sys.argv[0]), int(os.environ.get("RANKS", "1"))
plan = json.loads((here.parent / "plan.json").read_text()).get(here.name, {{}})
with (here.parent / "calls.jsonl").open("a") as calls:
    calls.write(json.dumps([here.name, *words]) + "\\n")
(here.parent / "cores.json").write_text(json.dumps(sorted(os.sched_getaffinity(0))))
time.sleep(plan.get("sleep", 0))
if plan.get("sentence"):
    sys.exit(print(here.name + ": " + plan["sentence"], file=sys.stderr) or plan["code"])
out = pathlib.Path(words[words.index("--out") + 1])
if "price" in words:
    errors = plan.get("errors", [1.9e-6] * 5)
    prices = (0.239004005, 0.318658312, 0.275403193, 0.208230166, 0.182096749)
    out.write_text("id,price,error,status\\n" + "".join(
        f"{{k}},{{price + error}},{{plan.get('stated', 2e-6)}},ok\\n" for k, (price, error) in enumerate(zip(prices, errors))))
    result = pathlib.Path(words[words.index("--result") + 1])
else:
    out.mkdir()
    result = out / "result.json"
check = plan.get("check", ["none", 0.0])
result.write_text(json.dumps({{
    "ranks": plan.get("ranks", ranks), "threads": int(os.environ["OMP_NUM_THREADS"]), "device": "a device",
    "git": "its-own", "provenance": {{"flags": "-Oits-own"}}, "timing": {{"compute_s": plan.get("seconds", 10.0)}}, "peak_bytes": {{"host": 2000000, "device": 0}},
    "checks": [{{"name": check[0], "value": check[1], "tolerance": 1.0, "passed": True}}],
    "figure_of_merit": {{"cell_steps_per_s": plan.get("share", 1.0) ** (ranks - 1) * 3e6 * ranks,
                        "vertex_steps_per_s": 4e6, "options_per_s": 50.0, "simulated_s_per_s": 0.25}}}}))
sys.exit(plan.get("code", 0))
"""
LAUNCHER = """#!{python} -IS
import os, sys
words = sys.argv[3:] if sys.argv[3] != "--bind-to" else sys.argv[5:]
os.execvpe(words[0], words, {{**os.environ, "RANKS": sys.argv[2]}})
"""


class Benchmark(perf_program.PerfTest):
    """With the programs of this build."""

    def test_right_answers_pass_and_their_commands_repeat_them(self):
        text, records = self.recorded("benchmark", "--filter", "^(sod|puts)$", "--backend", "serial")
        self.assertEqual(["benchmark/sod/serial/small/ranks/1", "benchmark/puts/serial/small/ranks/1"], [record["case"] for record in records])
        rows = [line for line in text.splitlines() if line.startswith(("drogue-gas ", "drogue-options "))]
        commands = [line.strip() for line in text.splitlines() if line.startswith("  env ")]
        self.assertEqual([record["facts"]["command"] for record in records], commands)
        for record, row in zip(records, rows, strict=True):
            facts = record["facts"]
            self.assertEqual(("passed", "s per run"), (record["check"], record["unit"]))
            self.assertTrue(facts["expected"][0] <= record["error"] <= facts["expected"][1])
            self.assertTrue(1 <= len(record["samples"]) <= 7 and min(record["samples"]) > 0.0)
            self.assertRegex(row, r"serial +1 x 1 .* passed$")
            self.assertGreater(facts["memory_bytes"], 1e6)
            self.assertIn(facts["extent"], row)
        work, merit = 12800 * self.steps(commands[0]), records[0]["facts"]["figure_of_merit"]
        self.assertTrue(0.999 * work / max(records[0]["samples"]) <= merit <= 1.001 * work / min(records[0]["samples"]))

    def steps(self, command):
        """Steps of a run by a printed command in a new folder."""
        self.expect_command(command.replace("drogue-gas", str(perf_program.PROGRAM.with_name("drogue-gas"))))
        return json.loads((self.folder / "sod/result.json").read_text(encoding="utf-8"))["steps"]

    def expect_command(self, command):
        done = subprocess.run(["sh", "-c", command], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual((0, ""), (done.returncode, done.stderr))

    def test_bad_input(self):
        (self.folder / "kept").mkdir()
        (self.folder / "kept/notes.txt").touch()
        for code, words, sentence in (
            (2, ["--size", "huge"], "huge"),
            (2, ["--filter", "^cloth$"], "no problem matches '^cloth$'; there are sod, drum, puts, taylor-green, c9-flat"),
            (2, ["--weak", "--filter", "sod"], "no problem matches 'sod'; there are taylor-green"),
            (2, ["--filter", "("], "is not a valid regular expression"),
            (2, ["--ranks", "0"], "--ranks"),
            (2, ["--ranks", "2", "--filter", "sod|puts"], "--ranks are those of taylor-green, and --filter 'sod|puts' leaves it out"),
            (2, ["--launcher", "srun"], "--launcher starts several ranks: give their number by --ranks"),
            (2, ["--weak", "--ranks", "4", "--launcher", "srun -n 4"], "--weak runs on 1, 2, 4, ... ranks: write {ranks} for their number in --launcher"),
            (2, ["--backend", "serial", "--threads", "2"], "the backend serial has one thread"),
            (2, ["--keep", "kept"], "the folder 'kept' of --keep holds files; name a new one"),
            (6, ["--out", "none/rows.jsonl"], "none/rows.jsonl"),
            (2, ["--out", "kept/notes.txt"], "the file 'kept/notes.txt' of --out exists; name a new one"),
        ):
            with self.subTest(words):
                process = self.expect(code, "benchmark", *words)
                self.assertIn(sentence, process.stderr)
                self.assertEqual("", process.stdout)
        process = self.expect(77, "benchmark", "--ranks", "2", environment={"PATH": str(self.folder)})
        self.assertIn("need mpirun, and no folder of PATH holds it", process.stderr)


class Planned(perf_program.PerfTest):
    """With programs that stand for those of the suite."""

    def setUp(self):
        super().setUp()
        self.bin = self.folder / "bin"
        self.bin.mkdir()
        shutil.copy(perf_program.PROGRAM.resolve(), self.bin / "drogue-perf")
        for name in ("drogue-gas", "drogue-springs", "drogue-options", "drogue-parachute"):
            self.put(self.bin / name, PROGRAM)
        self.put(self.folder / "mpirun", LAUNCHER)

    @staticmethod
    def put(file, text):
        file.write_text(text.format(python=sys.executable))
        file.chmod(0o755)

    def benchmark(self, code, plan, *words, backend="serial", **environment):
        """Standard output and error, and records, with a plan; asserts the exit code. OMP_* are those of `environment` alone."""
        (self.bin / "plan.json").write_text(json.dumps(plan))
        (self.folder / "rows.jsonl").unlink(missing_ok=True)
        inherited = {name: value for name, value in os.environ.items() if not name.startswith("OMP_")}
        done = subprocess.run([self.bin / "drogue-perf", "benchmark", "--backend", backend, "--out", "rows.jsonl", *words], cwd=self.folder,
                              capture_output=True, text=True, check=False,
                              env={**inherited, "PATH": f"{self.folder}:{os.environ['PATH']}", **environment})
        self.assertEqual(code, done.returncode, f"{done.stdout}{done.stderr}")
        rows = self.folder / "rows.jsonl"
        return done.stdout, done.stderr, self.records("rows.jsonl") if rows.exists() else []

    def verdicts(self, code, plan, *words):
        return [record["check"] for record in self.benchmark(code, plan, *words)[2]]

    def calls(self):
        return [json.loads(line) for line in (self.bin / "calls.jsonl").read_text().splitlines()]

    def test_wrong_answer_fails_and_the_other_problems_run(self):
        for error in (1.0, 1e-9):  # too large, and too small for the scheme on this mesh
            with self.subTest(error):
                text, _, (gas, puts) = self.benchmark(5, {"drogue-gas": {"check": ["l1_density", error]}}, "--filter", "sod|puts")
                row = next(line for line in text.splitlines() if line.startswith("drogue-gas"))
                self.assertRegex(row, rf" FAILED +- +l1_density {error:g}, expected \S+ to \S+: FAILED$")
                self.assertNotIn("cell-steps/s", row)
                self.assertEqual(("failed", "passed"), (gas["check"], puts["check"]))
                self.assertEqual(([], None, None), (gas["samples"], gas["median"], gas["facts"]["figure_of_merit"]))
                self.assertEqual(50.0, puts["facts"]["figure_of_merit"])
                self.assertEqual(["failed", "passed"], [perf_record.parse(json.dumps(record), "rows").check for record in (gas, puts)])

    def test_answer_that_is_missing_fails(self):
        self.assertEqual(["failed"], self.verdicts(5, {"drogue-gas": {"check": ["l2_density", 7e-5]}}, "--filter", "sod"))

    def test_program_that_computes_nonsense_fails_its_row(self):
        for code, seconds in ((4, 0.0), (5, 10.0)):
            plan = {"drogue-parachute": {"code": code, "seconds": seconds, "check": ["canopy_0_drag_coefficient_mean", 0.01]}}
            record, = self.benchmark(5, plan, "--filter", "c9-flat")[2]
            self.assertEqual(("failed", []), (record["check"], record["samples"]))

    def test_prices_are_compared_with_known_ones_and_with_their_stated_errors(self):
        for code, plan in ((0, {}), (5, {"errors": [0, 0, 0, 0, 3e-6], "stated": 1.0}), (5, {"errors": [0, 2.1e-6, 0, 0, 0]})):
            self.benchmark(code, {"drogue-options": plan}, "--filter", "puts", "--keep", f"kept-{plan}")
        self.assertEqual(16385, len((self.folder / "kept-{}/puts-16384.csv").read_text().splitlines()))

    def test_other_programs_beside_a_row_are_stated(self):
        plan = {"drogue-gas": {"check": ["l1_density", 9.1e-5]}}
        busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2 * os.cpu_count())]
        try:
            text, _, (record,) = self.benchmark(0, plan, "--filter", "sod")
        finally:
            for process in busy:
                process.kill()
                process.wait()
        others = record["facts"]["other_threads"]
        self.assertGreaterEqual(others, os.cpu_count())
        self.assertIn(f" passed\n  too slow: threads of other programs ran when it began, {others} on {os.cpu_count()} cores\n", text)

    def test_one_run_has_no_interval(self):
        text, _, (record,) = self.benchmark(0, {"drogue-gas": {"check": ["l1_density", 9.1e-5], "sleep": 2.6}}, "--filter", "sod")
        self.assertEqual([10.0], record["samples"])
        self.assertIn(" 10.000  one run ", text)

    def test_other_problems_run_beside_one_without_a_result(self):
        plan = {"drogue-options": {"code": 6, "sentence": "out of memory: use fewer cells"}}
        text, sentence, records = self.benchmark(6, plan, "--filter", "drum|puts|c9")
        failure = "puts on 1 rank failed: drogue-options: out of memory: use fewer cells"
        self.assertIn(failure, sentence)
        self.assertRegex(text, rf"drogue-options +puts +.*  {failure}\n")
        self.assertEqual(["drum", "c9-flat"], [record["facts"]["problem"] for record in records])
        self.assertRegex(text, r"\n  env .*drogue-options price puts-16384.csv ")

    def test_records_state_the_build_of_the_program_and_too_many_threads(self):
        text, _, (record,) = self.benchmark(0, {"drogue-gas": {"check": ["l1_density", 9.1e-5]}}, "--filter", "sod", "--threads", "500", backend="openmp")
        self.assertEqual(("its-own", "-Oits-own"), (record["provenance"]["git"], record["provenance"]["flags"]))
        self.assertRegex(text, r"\n  too slow: 500 threads on \d+ cores\n")

    def test_programs_have_all_cores_though_threads_are_bound(self):
        """OpenMP binds the first thread of drogue-perf too, before `main`."""
        self.benchmark(0, {"drogue-gas": {"check": ["l1_density", 9.1e-5]}}, "--filter", "sod", OMP_PROC_BIND="spread", OMP_PLACES="cores")
        self.assertEqual(sorted(os.sched_getaffinity(0)), json.loads((self.bin / "cores.json").read_text()))

    def test_program_that_is_missing_is_named(self):
        (self.bin / "drogue-springs").unlink()
        text, sentence, records = self.benchmark(6, {}, "--filter", "sod|drum")
        self.assertIn("needs drogue-springs: build target drogue-springs beside drogue-perf", sentence)
        self.assertEqual(("", []), (text, records))

    def test_weak_scaling_gives_each_rank_a_cube(self):
        plan = {"drogue-parachute": {"check": ["kinetic_energy_curve_0", 2.06e-3]}}
        records = self.benchmark(0, plan, "--weak", "--ranks", "2")[2]
        self.assertEqual([f"benchmark/taylor-green/serial/small/ranks/{ranks}/weak" for ranks in (1, 2)], [record["case"] for record in records])
        self.assertEqual([64**3, 2 * 64**3], [record["facts"]["cells"] for record in records])
        one, two = ([word for word in call if "grid." in word or "verify" in word] for call in {call[5]: call for call in self.calls()}.values())
        self.assertIn("grid.cells=[64,64,64]", one)
        self.assertIn("grid.cells=[64,64,128]", two)
        self.assertIn("12.56637061435917]]", " ".join(two))
        self.assertIn("[1,61.77208]", " ".join(two))
        self.assertNotIn("mpirun", records[0]["facts"]["command"])
        self.assertTrue(records[1]["facts"]["command"].startswith("env OMP_NUM_THREADS=1 mpirun -n 2 drogue-parachute taylor-green-3d --set "))

    def test_weak_scaling_starts_as_many_ranks_as_each_row_has(self):
        plan = {"drogue-parachute": {"check": ["kinetic_energy_curve_0", 2.06e-3]}}
        for words in ((), ("--launcher", "mpirun -n {ranks}")):
            records = self.benchmark(0, plan, "--weak", "--ranks", "4", *words)[2]
            self.assertEqual([1, 2, 4], [record["facts"]["ranks"] for record in records])

    def test_weak_scaling_has_equal_threads_and_an_efficiency_in_all_rows(self):
        plan = {"drogue-parachute": {"check": ["kinetic_energy_curve_0", 2.06e-3], "share": 0.9}}
        most = 2 * os.cpu_count()
        for words, environment, threads in (((), {}, 1), (("--threads", "3"), {"OMP_NUM_THREADS": "2"}, 3), ((), {"OMP_NUM_THREADS": "2"}, 2)):
            text, _, records = self.benchmark(0, plan, "--weak", "--ranks", str(most), *words, backend="openmp", **environment)
            self.assertEqual({threads}, {record["facts"]["threads"] for record in records})
            for record, row in zip(records, [line for line in text.splitlines() if line.startswith("drogue-")], strict=True):
                facts = record["facts"]
                self.assertAlmostEqual(0.9 ** (facts["ranks"] - 1), facts["efficiency"])
                self.assertIn(f" {facts['ranks']} x {threads} ", row)
                self.assertIn(f" M cell-steps/s, {100 * facts['efficiency']:.1f} % ", row)

    def test_weak_scaling_keeps_the_files_of_each_row(self):
        plan = {"drogue-parachute": {"check": ["kinetic_energy_curve_0", 2.06e-3]}}
        _, _, records = self.benchmark(0, plan, "--weak", "--ranks", "2", "--keep", "kept")
        for ranks, record in enumerate(records, 1):
            self.assertIn(f" --out taylor-green-ranks-{ranks} ", record["facts"]["command"])
            self.assertEqual(ranks, json.loads((self.folder / f"kept/taylor-green-ranks-{ranks}/result.json").read_text())["ranks"])

    def test_processors_are_shared_by_the_ranks_unless_a_launcher_may_use_other_nodes(self):
        plan = {"drogue-parachute": {"check": ["kinetic_energy_curve_0", 2.06e-3]}}
        note, launcher = "one thread per rank with --launcher", ("--launcher", "mpirun -n {ranks}")
        for words, environment, threads, stated in (((), {}, os.cpu_count(), False), (("--ranks", "2"), {}, max(1, os.cpu_count() // 2), False),
                                                    (("--ranks", "2", *launcher), {}, 1, True),
                                                    (("--ranks", "2", *launcher), {"OMP_NUM_THREADS": "3"}, 3, False)):
            text, _, (record,) = self.benchmark(0, plan, "--filter", "taylor-green", *words, backend="openmp", **environment)
            self.assertEqual((threads, None, stated), (record["facts"]["threads"], record["facts"]["efficiency"], note in text), words)

    def test_variables_of_openmp_are_in_record_and_command(self):
        variables = {"OMP_NUM_THREADS": "3", "OMP_PLACES": "{0},{1}", "OMP_PROC_BIND": "spread"}
        text, _, (record,) = self.benchmark(0, {"drogue-gas": {"check": ["l1_density", 9.1e-5]}}, "--filter", "sod", backend="openmp", **variables)
        self.assertEqual((variables, 3), (record["facts"]["environment"], record["facts"]["threads"]))
        self.assertIn("\n  env OMP_NUM_THREADS=3 'OMP_PLACES={0},{1}' OMP_PROC_BIND=spread drogue-gas sod ", text)

    def test_ranks_that_mpirun_refuses_end_it_before_the_table(self):
        self.put(self.folder / "mpirun", "#!/bin/sh\necho 'There are not enough slots available to satisfy the 4 slots that were requested:' >&2\nexit 1\n")
        output, sentence, _ = self.benchmark(2, {}, "--weak", "--ranks", "4")
        self.assertEqual(("", False), (output, (self.bin / "calls.jsonl").exists()))
        self.assertIn("a run on 4 ranks failed: mpirun has fewer slots than ranks, by default one per core; take fewer ranks, or let them share "
                      "cores by OMPI_MCA_rmaps_base_oversubscribe=1, with Open MPI 5", sentence)

    def test_launcher_of_the_user_must_start_the_ranks(self):
        plan = {"drogue-parachute": {"check": ["kinetic_energy_curve_0", 2.06e-3]}}
        words = ("--filter", "taylor-green", "--ranks", "4", "--launcher")
        self.assertEqual(4, self.benchmark(0, plan, *words, "mpirun -n 4")[2][0]["facts"]["ranks"])
        self.assertIn("taylor-green on 4 ranks: the launcher started 2 of them", self.benchmark(2, plan, *words, "mpirun -n 2")[1])
