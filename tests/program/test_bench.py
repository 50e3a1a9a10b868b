# ctest-label: no-sanitizer
"""scripts/bench.sh with a program that stands for drogue-perf: what is measured, and how it goes on after an end."""

import contextlib
import io
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys

SOURCE = pathlib.Path(os.environ["DROGUE_SOURCE"])
sys.path.insert(0, str(SOURCE / "scripts"))

from folder_test import FolderTest
import publish_records

BENCH = SOURCE / "scripts/bench.sh"
PERF = pathlib.Path(os.environ["DROGUE_BIN"]) / "drogue-perf"
# Writes its words to calls.txt, and half a record first, as a program that is killed leaves it. plan.txt maps a part of the words,
# _ for spaces, to an exit code, or to KILL (kills the script that started it), TERM (sends it that signal), SLOW (a minute of work).
PROGRAM = """\
#!/bin/sh
here="${0%/*}" words="$*"
case "$words" in
  --version) exec cat "$here/version.txt" ;;
  list*) exec cat "$here/cases.txt" ;;
esac
echo "$words" >>"$here/calls.txt"
case "$words" in report*) echo page >"$2/report.html" && exit ;; esac
for out; do :; done
echo "{" >"$out"
act=0
while read -r part then; do case "$words" in *"$(echo "$part" | tr _ ' ')"*) act="$then" ;; esac; done <"$here/plan.txt"
case "$act" in
  KILL) kill -KILL "$PPID" && exit ;;
  TERM) kill -TERM "$PPID" && exec sleep 60 ;;
  SLOW) exec sleep 60 ;;
esac
echo "$words" >"$out"
echo "printed: $words"
[ "$act" = 0 ] || echo "the reason" >&2
exit "$act"
"""
HEAD = {"schema": "drogue.perf/1", "check": "passed"}  # of each record
HOST = ["gas-step/serial/1024", "gas-step/openmp/1024", "gas-step/dense-loop/1024", "ceiling/fp64/serial", "options/serial/1/128x32"]
CUDA = ["gas-step/cuda/1024", "gas-step/serial/1024", "options/cuda/1/128x32", "options/cuda/4096/128x32", "options/cuda/4096/256x64",
        "flow-step/cuda/64x64x64/periodic"]


class Bench(FolderTest):
    def setUp(self):
        super().setUp()
        self.bin, self.out = self.folder / "bin", self.folder / "out"
        self.bin.mkdir()
        (self.bin / "drogue-perf").write_text(PROGRAM)
        (self.bin / "drogue-perf").chmod(0o755)
        self.put("version.txt", "drogue-perf 1.0 (git abc)")
        self.put("cases.txt", *HOST)
        self.put("plan.txt")
        self.host(2, "exit 0")

    def put(self, name, *lines):
        (self.bin / name).write_text("".join(line + "\n" for line in lines))

    def plan(self, acts=None):
        self.put("plan.txt", *(f"{part.replace(' ', '_')} {act}" for part, act in (acts or {}).items()))

    def host(self, cores, launcher):
        """Programs in PATH of a host with two hardware threads per core, and whose mpirun is the text of a shell."""
        for name, text in (("lscpu", "echo '# Core,Socket'; for k in $(seq %d); do echo $k,0; echo $k,0; done" % cores),
                           ("nproc", f"echo {2 * cores}"), ("mpirun", launcher)):
            file = self.folder / "host" / name
            file.parent.mkdir(exist_ok=True)
            file.write_text(f"#!/bin/sh\n{text}\n")
            file.chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{self.folder}/host:{os.environ['PATH']}"}

    def bench(self, code, *words):
        """Standard error of the script, whose exit code is `code`."""
        done = subprocess.run([BENCH, self.out, "--bin", self.bin, *words], capture_output=True, text=True, timeout=60, check=False,
                              env=self.environment)
        self.assertEqual(code, done.returncode, done.stdout + done.stderr)
        return done.stderr

    def calls(self):
        """Words of the calls since the last time."""
        file = self.bin / "calls.txt"
        lines = file.read_text().splitlines() if file.exists() else []
        file.unlink(missing_ok=True)
        return lines

    def made(self):
        return sorted(path.relative_to(self.out).as_posix() for path in self.out.rglob("*.jsonl"))

    def names(self, *words):
        return subprocess.run([BENCH, "--bin", self.bin, "--list", *words], capture_output=True, text=True, check=True,
                              env=self.environment).stdout.split()

    def test_makes_a_record_and_a_text_of_every_table_and_the_page(self):
        self.bench(0)
        self.assertEqual(sorted(f"{name}.jsonl" for name in self.names()), self.made())
        calls = self.calls()
        self.assertEqual(f"report {self.out}", calls[-1])
        self.assertIn("^(gas-step|ceiling/[^/]+)/(serial|openmp|dense-loop|scatter-loop)(/|$)", calls[0])
        for app in ("gas", "springs", "options", "parachute"):
            words = f"table transfers --app {app} --backend auto"
            self.assertEqual(1, sum(words in call for call in calls))
            self.assertIn(words, (self.out / f"{app}-transfers.jsonl").read_text())
            text = (self.out / f"{app}-transfers.txt").read_text()
            self.assertTrue(text.startswith(f"drogue-perf {words} \nprinted: {words}"), text)
        steps = (self.out / "gas-step.txt").read_text()
        self.assertTrue(steps.startswith("drogue-perf run --filter '^(gas-step|ceiling/[^/]+)/(serial|openmp|dense-loop|scatter-loop)(/|$)' \n"))
        self.assertFalse((self.out / ".partial").exists())

    def test_measures_the_gpu_alone_in_a_build_for_it(self):
        self.put("cases.txt", *CUDA)
        self.bench(0)
        calls = self.calls()
        self.assertTrue(all(re.search(r"/cuda(/|\(/)", call) for call in calls if call.startswith("run")), calls)
        self.assertTrue(all("--backend cuda" in call for call in calls if call.startswith(("table transfers", "work", "ladder"))))
        for app in ("gas", "options", "flow", "parachute"):
            self.assertIn(f"table block-size --app {app} --backend cuda --out", "\n".join(calls))
        for app in ("gas", "springs", "flow"):
            self.assertIn(f"table abstraction --app {app} --backend cuda --out", "\n".join(calls))
        self.assertEqual(["alone/options-1.jsonl", "alone/options-4096.jsonl"], [name for name in self.made() if "alone" in name])
        self.assertEqual(["flow-step"], [name for name in self.names() if name.startswith(("flow-step", "springs-step"))])

    def test_measures_ranks_on_the_cores_of_a_host_whose_launcher_starts_them(self):
        self.host(2, "exit 1")
        self.assertIn("no scaling over ranks", self.bench(0, "--only", "^scaling-flow"))
        self.assertEqual(["scaling-flow-weak.jsonl", "scaling-flow.jsonl"], self.made())
        self.host(4, '[ "$*" = "-n 4 true" ]')
        self.calls()
        self.assertNotIn("no scaling over ranks", self.bench(0, "--only", "^scaling-flow"))
        self.assertEqual([f"table scaling --over ranks {weak}--most 4 --backend auto" for weak in ("", "--weak ")],
                         [call.partition(" --out")[0] for call in self.calls()[:-1]])
        self.put("cases.txt", *CUDA)
        self.assertEqual(["scaling-flow"], [name for name in self.names() if name.startswith("scaling-flow")])
        # Names and other records start no ranks.
        self.put("cases.txt", *HOST)
        self.host(2, f"touch {self.folder}/started")
        self.assertIn("scaling-flow-ranks", self.names())
        self.bench(0, "--only", "^occupancy$")
        self.assertFalse((self.folder / "started").exists())
        self.host(1, "exit 0")
        self.assertNotIn("scaling-flow-ranks", self.names("--backend", "openmp"))

    def test_makes_every_table_of_every_mini_app(self):
        def tables_of(app):
            """Names in the sentence of the program that refuses another."""
            other = "occupancy" if app == "flow" else "pressure"
            refused = subprocess.run([PERF, "table", other, "--app", app], capture_output=True, text=True, check=False)
            self.assertEqual(2, refused.returncode)
            return set(re.search("valid names are (.*)", refused.stderr)[1].split(", "))

        self.bench(0)
        self.put("cases.txt", *CUDA)
        shutil.rmtree(self.out)
        self.bench(0)
        calls = "\n".join(self.calls())
        wanted = {(app, table) for app in ("gas", "springs", "options", "flow", "parachute") for table in tables_of(app)}
        self.assertGreater(len(wanted), 15)
        # These have no --app, as they have one mini-app or none.
        without_app = {"machine", "occupancy", "pressure", "memory"}
        for app, table in sorted(wanted):
            self.assertRegex(calls, f"table {table} " if table in without_app else f"table {table} --app {app} ")
        for words in ("--weak --backend", "--over ranks --most", "--over ranks --weak"):
            self.assertIn(f"table scaling {words}", calls)

    def test_goes_on_after_a_kill_and_makes_no_record_twice(self):
        self.plan({"--app options --backend": "KILL"})
        self.bench(-signal.SIGKILL)
        before, calls = self.made(), self.calls()
        self.assertIn("gas-transfers.jsonl", before)
        self.assertNotIn("options-transfers.jsonl", before)
        self.assertTrue((self.out / ".partial").exists())
        self.plan()
        self.bench(0)
        after = self.calls()
        self.assertEqual(sorted(f"{name}.jsonl" for name in self.names()), self.made())
        self.assertFalse(set(after) & set(calls[:-1]))
        self.assertEqual(calls[-1], after[0])
        self.assertNotIn("{", (self.out / "options-transfers.jsonl").read_text())
        self.bench(0)
        self.assertEqual([f"report {self.out}"], self.calls())

    def test_ends_at_once_after_a_signal(self):
        self.plan({"table memory": "TERM"})
        self.assertIn("goes on from here", self.bench(130))
        self.assertNotIn("flow-memory.jsonl", self.made())
        self.assertFalse((self.out / ".partial").exists())

    def test_refuses_a_folder_in_use(self):
        self.plan({"table occupancy": "SLOW"})
        with subprocess.Popen([BENCH, self.out, "--bin", self.bin], stderr=subprocess.PIPE, text=True) as first:
            for line in first.stderr:
                if "options: " in line:
                    break
            self.assertIn("another bench.sh", self.bench(1))
            first.terminate()
            first.stderr.read()
        self.assertEqual(130, first.returncode)

    def test_failed_checks_are_kept_and_failed_commands_are_not(self):
        self.plan({"table occupancy": "5", "table memory": "77", "ladder weno": "4"})
        text = self.bench(77)
        self.assertRegex(text, "occupancy: .*a row failed its check")
        self.assertIn("flow-memory: exit code 77: the reason", text)
        self.assertIn("ladder-weno: exit code 4: the reason", text)
        self.assertIn("occupancy.jsonl", self.made())
        self.assertNotIn("flow-memory.jsonl", self.made())
        self.plan()
        self.calls()
        self.bench(5)
        self.assertEqual(["ladder weno", "report " + str(self.out), "table memory"],
                         sorted(call.partition(" --")[0] for call in self.calls()))

    def test_returns_the_code_of_a_failed_check(self):
        self.plan({"table occupancy": "5"})
        self.bench(5)
        self.plan()
        self.assertIn("occupancy is there; a row failed its check", self.bench(5))
        (self.out / "occupancy.jsonl").unlink()
        self.bench(0)

    def test_refuses_records_of_another_build_or_with_other_options(self):
        self.bench(0, "--only", "^occupancy$")
        self.assertEqual(["occupancy.jsonl"], self.made())
        self.assertIn("another build or with other options", self.bench(1, "--quick"))
        self.put("version.txt", "drogue-perf 1.0 (git def)")
        self.assertIn("another build", self.bench(1))

    def test_publishes_records_and_renews_documents(self):
        """In a tree that holds the script and the reader of records alone; what it starts notes its words."""
        tree = self.folder / "tree"
        for name in ("scripts", "docs/evidence"):
            (tree / name).mkdir(parents=True)
        shutil.copy(SOURCE / "scripts/publish_records.py", tree / "scripts")
        shutil.copytree(SOURCE / "scripts/plot", tree / "scripts/plot")
        (tree / "docs/evidence/README.md").write_text("| file | written by | machine |\n|---|---|---|\n")
        renewed = self.folder / "renewed.txt"
        (tree / "scripts/tables.py").write_text(f"def renew():\n    open('{renewed}', 'a').write('tables\\n')\n")
        (self.bin / "drogue-plot").write_text(f'#!/bin/sh\necho "${{0##*/}} $*" >>{renewed}\n')
        (self.bin / "drogue-plot").chmod(0o755)
        self.put("cases.txt", *CUDA)
        words = [tree / "scripts/publish_records.py", self.out, "h200", "--bin", self.bin]
        self.plan({"table occupancy": "5"})
        self.bench(5)
        failed = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual((1, "nothing is published: a row of occupancy failed its check\n"), (failed.returncode, failed.stderr))
        self.assertEqual(["README.md"], [path.name for path in (tree / "docs/evidence").iterdir()])
        (self.out / "occupancy.jsonl").unlink()
        self.plan()
        self.bench(0)
        origin = {"gpu": "NVIDIA H200", "cpu": "", "threads": 16, "driver": "13.0", "date": "2026-11-27T01:02:03Z", "git": "abc"}
        for file in self.out.rglob("*.jsonl"):
            file.write_text(json.dumps(HEAD | {"case": file.name, "facts": {"backend": "cuda"}, "provenance": origin}) + "\n")
        text = self.out / "occupancy.txt"
        command, _, printed = text.read_text().partition("\n")
        text.write_text(f"{command}--quick \n{printed}")
        quick = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual((1, "nothing is published: occupancy was made with --quick, whose few samples are no evidence\n"),
                         (quick.returncode, quick.stderr))
        self.assertEqual(["README.md"], [path.name for path in (tree / "docs/evidence").iterdir()])
        text.write_text(f"{command}\n{printed}")
        noted = (self.bin / "drogue-plot").read_text()
        (self.bin / "drogue-plot").write_text("#!/bin/sh\necho 'a.jsonl:1: the line ends within a record' >&2\nexit 3\n")
        broken = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual((1, "a.jsonl:1: the line ends within a record\nnothing is published: no page can be made of the records, "
                             "for the reason above\n"), (broken.returncode, broken.stderr))
        self.assertEqual(["README.md"], [path.name for path in (tree / "docs/evidence").iterdir()])
        (self.bin / "drogue-plot").write_text(noted)
        first = subprocess.run(words, capture_output=True, text=True, check=True)
        self.assertEqual("", first.stdout)
        published = {path.relative_to(tree / "docs/evidence").as_posix(): path for path in (tree / "docs").rglob("*.jsonl")}
        flat = {f"{name}-h200.jsonl" for name in self.names("--backend", "cuda") if "/" not in name and not name.startswith("ladder")}
        ladders = {f"ladders/{name}-cuda-h200.jsonl" for name in ("weno", "springs", "options", "transfers")}
        self.assertEqual(flat | ladders | {"alone/options-h200.jsonl"}, set(published))
        published["occupancy-h200.jsonl"].write_text(json.dumps(HEAD | {"case": "kernel/sm_90"}) + "\n")
        again = subprocess.run(words, capture_output=True, text=True, check=True)
        self.assertEqual("occupancy-h200.jsonl had 1 other cases, such as kernel/sm_90: the new records replace them too\n",
                         again.stdout)
        batches = published["alone/options-h200.jsonl"].read_text().splitlines()
        self.assertEqual(["options-1.jsonl", "options-4096.jsonl"], [json.loads(line)["case"] for line in batches])
        self.assertEqual([], list(tree.rglob("*.html")))
        rows = (tree / "docs/evidence/README.md").read_text().splitlines()[2:]
        self.assertEqual(set(published), {row.split("`")[1] for row in rows})
        self.assertIn("| `alone/options-h200.jsonl` | `drogue-perf run --filter '^options/cuda/N/' --out options-N.jsonl`, one run per N |",
                      "\n".join(rows))
        self.assertIn("| `occupancy-h200.jsonl` | `drogue-perf table occupancy --out occupancy-h200.jsonl` |", "\n".join(rows))
        calls = [f"drogue-plot {self.out} --report --quiet", f"drogue-plot {tree}/docs/evidence/ladders --quiet", "tables"]
        self.assertEqual(2 * calls, renewed.read_text().splitlines())

    def test_published_records_replace_older_ones_that_no_document_quotes(self):
        evidence = self.folder / "docs/evidence"
        evidence.mkdir(parents=True)

        def put(name, *cases):
            (evidence / name).write_text("".join(
                json.dumps(HEAD | {"case": case, "provenance": {"gpu": gpu, "cpu": "", "date": date}}) + "\n" for case, gpu, date in cases))

        put("new-h200.jsonl", ("a/1", "H200", "2026-11-27"), ("a/2", "H200", "2026-11-27"))
        put("all-h200.jsonl", ("a/1", "H200", "2026-11-20"))
        put("part-h200.jsonl", ("a/1", "H200", "2026-11-20"), ("b", "H200", "2026-11-20"), ("a/2", "H100", "2026-11-20"))
        put("quoted-h200.jsonl", ("a/2", "H200", "2026-11-20"))
        put("later-h200.jsonl", ("a/2", "H200", "2026-11-28"))
        put("all-h100.jsonl", ("a/1", "H200", "2026-11-20"))
        put("in-code-h200.jsonl", ("a/2", "H200", "2026-11-20"))
        (self.folder / "docs/gas.md").write_text("[record](evidence/quoted-h200.jsonl), [other](evidence/overall-h200.jsonl)")
        (self.folder / "sheet.hpp").write_text("// docs/evidence/in-code-h200.jsonl")
        (evidence / "README.md").write_text("| `all-h200.jsonl` |")
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            self.assertEqual(["all-h200.jsonl"], publish_records.remove_older(evidence, ["new-h200.jsonl"], "h200"))
        left = {path.name: [json.loads(line)["case"] for line in path.read_text().splitlines()] for path in evidence.glob("*.jsonl")}
        self.assertEqual({"new-h200.jsonl": ["a/1", "a/2"], "part-h200.jsonl": ["b", "a/2"], "quoted-h200.jsonl": ["a/2"],
                          "in-code-h200.jsonl": ["a/2"], "later-h200.jsonl": ["a/2"], "all-h100.jsonl": ["a/1"]}, left)
        self.assertIn("quoted-h200.jsonl stays with 1 older records: it is quoted by docs/gas.md", printed.getvalue())
        self.assertIn("in-code-h200.jsonl stays with 1 older records: it is quoted by sheet.hpp", printed.getvalue())
        page = "| file |\n|---|\n| `all-h200.jsonl` | a |\n| `part-h200.jsonl` | b |\n\nEnd\n"
        self.assertEqual("| file |\n|---|\n| `part-h200.jsonl` | b |\n\nEnd\n", publish_records.without_rows(page, ["all-h200.jsonl"]))

    def test_rows_name_the_threads_of_a_host(self):
        def put(name, threads, cpu):
            origin = {"gpu": "", "cpu": cpu, "threads": threads, "date": "2026-11-27T01:02:03Z", "git": "abc"}
            (self.folder / f"{name}.jsonl").write_text(json.dumps(HEAD | {"case": f"a-{name}", "provenance": origin}) + "\n")
            (self.folder / f"{name}.txt").write_text(f"drogue-perf table {name} \n")

        put("memory", 1, "Intel(R) Xeon(R)")
        put("machine", 8, "Neoverse")
        rows = publish_records.rows(self.folder, "host")
        self.assertIn("| one thread of an Intel Xeon, ", rows["memory-host.jsonl"])
        self.assertIn("| 8 threads of a Neoverse, ", rows["machine-host.jsonl"])

    def test_solutions_replace_the_two_of_the_readme(self):
        self.assertEqual({"gas-shu-osher"}, set(self.names()) - set(self.names("--quick")))
        usual, all_ = set(self.names()), set(self.names("--solutions"))
        self.assertEqual({"gas-shu-osher", "springs-drum"}, usual - all_)
        self.assertEqual({f"{app}-solution" for app in ("gas", "springs", "options", "flow", "parachute")}, all_ - usual)

    def test_refuses_unknown_words(self):
        for words, sentence in ((["--quik"], "unknown argument --quik"), (["--backend", "hip"], "no backend 'hip'"),
                                (["--only"], "--only needs a value"), (["--only", "("], "--only '(' is no regular expression"),
                                (["--bin", "nowhere"], "there is no program")):
            self.assertIn(sentence, self.bench(2, *words))

    def test_refuses_an_expression_that_matches_no_record(self):
        for words in (["--only", "zz"], ["--only", "zz", "--list"]):
            self.assertEqual("bench.sh: no record of this machine matches --only 'zz': --list prints the names of all.\n",
                             self.bench(2, *words))
        self.host(2, "exit 1")
        self.assertIn("no record of this machine matches", self.bench(2, "--only", "ranks"))
        self.assertFalse(self.out.exists())

    def test_list_names_what_it_needs_where_no_program_is_built(self):
        shutil.rmtree(self.bin)
        self.assertIn("which --list needs: build it by scripts/build.sh host, or name its folder by --bin", self.bench(2, "--list"))

    def test_commands_of_the_readme_are_made(self):
        """Every command under a table of README.md is one of this script, or selects from one."""
        self.put("cases.txt", *HOST, *CUDA)
        kinds = BENCH.read_text()
        for words in ("work-precision --app gas --filter '^shu-osher$'", "work-precision --app springs --filter '^drum$'",
                      'run --filter "^options/cuda/$count/"', "cases options ", "cases flow-step "):
            self.assertIn(words, kinds)
