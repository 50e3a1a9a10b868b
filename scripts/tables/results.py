"""docs/results.md: checks of all shipped scenes and times of steps, as recorded in docs/evidence."""

import json
import sys

from .forms import EVIDENCE, error_of, passed, table, time_of, wrapped

HEAD = """# Results

Checks of all shipped scenes and times of steps. `scripts/publish_records.py --tables` writes this page from the records that
the commands below wrote, with the scenes of the commits that they name. Errors and tolerances have the unit of their
quantity; seconds are from start to exit. What the numbers mean, and other machines: the notebooks of
[gas](gas-notebook.md), [springs](springs-notebook.md), [options](options-notebook.md), [flow](flow-notebook.md),
[coupling](coupling-notebook.md) and [parachutes](parachute-notebook.md). Cases of `drogue-perf` are named by their size and
[variant](perf-records.md#records), with an [error of their kind](perf-reference.md#cases). Speed beside error is in the
[README](../README.md#speed-beside-error), on [transfers](transfers.md) and [ladders](lessons/tables.md) there are pages.
"""


def number(value):
    """Three digits without trailing zeros, with a short exponent below 0.01; whole from 100 on."""
    if value == 0.0 or value >= 100.0:
        return f"{value:.0f}"
    if value >= 0.01:
        return f"{value:.3g}"
    digits, _, exponent = f"{value:.2e}".partition("e")
    return f"{digits.rstrip('0').rstrip('.')}e{int(exponent)}"


def scenes(title, name, backend, program, **more):
    """Section of the scenes of a program on a backend, with columns `more` of the group `limiter`."""
    record = json.loads((EVIDENCE / name).read_text(encoding="utf-8"))
    runs = sorted((run for run in record["runs"] if run["backend"] == backend), key=lambda run: run["scene"])
    rows = []
    for run in runs:
        if run["exit_code"] != 0 or not all(check["passed"] for check in run["checks"]):
            sys.exit(f"{EVIDENCE / name}: {run['scene']} failed on {backend}")
        checks = (f"{check['name']} {number(check['value'])} ({number(check['tolerance'])})" for check in run["checks"])
        rows.append([f"`{run['scene']}`", str(run["steps"]), ", ".join(checks), *(str(run["limiter"][key]) for key in more.values()),
                     f"{run['wall_s']:.2g}"])
    first = runs[0] if "provenance" in runs[0] else record
    device = runs[0]["device"].replace("(R)", "")
    place = f"One {device}" if backend == "cuda" else f"One core of an {device}"
    origin = f"{place}, {first['provenance']['date'][:10]}, commit {first['git']} ([record](evidence/{name}))"
    heading = ["scene", "steps", "checks: error (tolerance)", *(words.replace("_", " ") for words in more), "seconds"]
    return ["", f"## {title}", f"{origin}: `{program} SCENE --backend {backend}`.", "", *table(heading, rows, (0, 2))]


def cases(title, name, group, unit, factor, note=""):
    """Section of the cases of a group in a record, all on its first backend."""
    records = [record for record in passed(EVIDENCE / name) if record.case.startswith(f"{group}/")]
    first = records[0]
    backend = first.facts["backend"]
    records = [record for record in records if record.facts["backend"] == backend]
    rows = []
    for record in records:
        low, high = (number(factor * bound) for bound in record.interval)
        rows.append([f"`{record.case.split('/', 2)[2]}`", time_of(record, factor), f"[{low} .. {high}]", error_of(record)])
    date, commit = first.run_id
    on_gpu = backend == "cuda"
    place = f"One {first.device(True)}" if on_gpu else f"One core of an {first.device(False)}"
    origin = f"{place}, {date[:10]}, commit {commit} ([record](evidence/{name}))"
    return ["", f"### {title}", f"{origin}: `drogue-perf run --filter '^{group}/{backend}'`{note}.", "",
            *table(["case", unit, "95 % interval", "error"], rows, (0, 2))]


def page():
    """Text of the page."""
    lines = [
        *scenes("Gas", "gas-h100.json", "cuda", "drogue-gas", faces_limited="touches", steps_redone="redone_steps"),
        *cases("Steps of Sod's problem", "gas-step-h100.jsonl", "gas-step", "us per step", 1e6),
        *scenes("Cloth and strings", "springs-xeon-2.json", "serial", "drogue-springs"),
        *cases("Steps of a sheet", "springs-step-h100.jsonl", "springs-step", "us per step", 1e6),
        *cases("Steps in contact", "springs-contact-h100.jsonl", "springs-contact", "us per step", 1e6),
        "", "## Options",
        *cases("Batches on a GPU", "alone/options-h100.jsonl", "options", "ms per batch", 1e3, ", one run for each number of options"),
        *cases("Batches on a core", "options-xeon-2.jsonl", "options", "ms per batch", 1e3),
        *scenes("Flow and parachutes", "parachute-h200.json", "cuda", "drogue-parachute"),
    ]
    return HEAD + wrapped(lines)
