"""Reference results of docs/benchmark.md, from the records benchmark-*.jsonl."""

import re
import shlex
import statistics
import sys

from .forms import EVIDENCE, MARK, passed, table, wrapped
from .results import number

_UNITS = {"cell_steps_per_s": (1e-6, "M cell-steps/s"), "vertex_steps_per_s": (1e-6, "M vertex-steps/s"),
          "options_per_s": (1.0, "options/s"), "simulated_s_per_s": (1.0, "s of flight/s")}

SIZES = ["small", "medium", "large"]


def merit(facts):
    """Figure of merit with its unit, and the efficiency of weak scaling."""
    scale, unit = _UNITS[facts["merit"]]
    share = facts.get("efficiency")
    return f"{number(scale * facts['figure_of_merit'])} {unit}" + (f", {number(100 * share)} %" if share else "")


def row(record):
    """Line of a problem."""
    facts = record.facts
    return [f"`{facts['problem']}`", facts["extent"], f"{facts['ranks']} x {facts['threads']}", number(1e-6 * facts["memory_bytes"]),
            number(statistics.median(record.samples)), merit(facts),
            f"{number(record.error)} ({' .. '.join(map(number, facts['expected']))})"]


def place(records):
    """Devices of the records of a run, in words."""
    facts, most = records[0].facts, max(record.facts["ranks"] for record in records)
    if facts["backend"] == "cuda":
        return f"{'One' if most == 1 else most} {records[0].device(True)}, CUDA {records[0].provenance['driver']}"
    threads, name = most * facts["threads"], records[0].device(False)
    compiled = re.search(r"-march=\S+", records[0].provenance.get("flags", ""))
    return (f"{'One thread' if threads == 1 else f'{threads} threads'} of {'an' if name[0] in 'AEIOU' else 'a'} {name}"
            + (f", compiled with `{compiled[0]}`" if compiled else ""))


def section(file):
    """Paragraph and table of a file."""
    records = passed(file)
    facts, here = records[0].facts, records[0].provenance
    variables = "".join(f"{name}={shlex.quote(value)} " for name, value in facts.get("environment", {}).items() if name != "OMP_NUM_THREADS")
    options = f"--size {facts['size']} --backend {facts['backend']}" + (f" --threads {facts['threads']}" if facts["backend"] == "openmp" else "")
    if (most := max(record.facts["ranks"] for record in records)) > 1:
        options += f"{' --weak' if records[0].case.endswith('/weak') else ''} --ranks {most}"
    origin = f"{place(records)}, {records[0].run_id[0][:10]}, commit {here['git']} ([record](evidence/{file.name})): `{variables}drogue-perf benchmark {options}`."
    memory = "process, MB" if facts["backend"] in ("serial", "openmp") else "arrays, MB"
    heading = ["problem", "size", "ranks x threads", memory, "time, s", "figure of merit", "error (expected)"]
    return ["", origin, "", *table(heading, map(row, records), (0, 1, 5, 6))]


def summary(evidence):
    """Paragraph of the README: figures of merit of the largest size on each backend, without weak scaling."""
    largest = {}
    files = {file: passed(file) for file in sorted(evidence.glob("benchmark-*.jsonl"))}
    for file, records in sorted(files.items(), key=lambda item: SIZES.index(item[1][0].facts["size"])):
        if not records[0].case.endswith("/weak"):
            largest[records[0].facts["backend"]] = file, records
    return [f"{place(records)}, size {records[0].facts['size']} ([record](docs/evidence/{file.name})): "
            + ", ".join(f"{merit(record.facts)} (`{record.facts['problem']}`)" for record in records) + "."
            for _, (file, records) in sorted(largest.items())]


def renewed(text, evidence=EVIDENCE):
    """The text of the page with a table for each file of records."""
    files = sorted(evidence.glob("benchmark-*.jsonl"))
    if [name for _, name, _ in MARK.findall(text)] != ["benchmark"] or not files:
        sys.exit("docs/benchmark.md needs one mark for the table benchmark, and docs/evidence a file benchmark-*.jsonl")
    lines = [line for file in files for line in section(file)]
    return MARK.sub(lambda found: found[1] + wrapped(lines[1:]) + found[3], text)
