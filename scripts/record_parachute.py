#!/usr/bin/env python3
"""Writes docs/evidence/parachute-<machine>.json, the record of drogue-parachute on this machine, from its result files.

    scripts/record_parachute.py MACHINE --bin build/host/bin [--backends serial,openmp,cuda] [--ranks 1,2,4] [--full]
                                [--only REGEX] [--skip REGEX] [--limit SECONDS] [--add] [--work FOLDER] [--to FOLDER]

The record holds a row for every shipped scene, backend and number of ranks: exit code, checks with value and tolerance,
steps, times, pressure solver. Runs on several ranks start through mpirun; a scene that refuses them has a row with the
sentence of the refusal. Options:

    --full     also the scenes -full, which take minutes on a GPU
    --only     only scenes whose names contain the regular expression
    --skip     scenes that are not run
    --limit    seconds of a run after which it is stopped; default: none
    --add      keep the rows of the file of an earlier call that have run, and run the others

What --skip or --limit leaves out has a row with the reason in `not_run`. Prints what failed, refused or was not run, and
a table of the small scenes, which miniapps/parachute/README.md holds. The exit code is 1 if any run failed.
"""

import json
import re
import sys

from recording import argument_parser, list_scenes, run, save_record, small_scenes, write_record

KEEP = ("scene", "backend", "ranks", "device", "threads", "git", "provenance", "steps", "exit_code", "message", "checks")


def row_of(result, scene, backend, ranks):
    """Row of a record from the result of a run; a run on several ranks that ended with exit code 2 is `refused`."""
    row = {key: result.get(key) for key in KEEP} | {"scene": scene, "backend": backend, "ranks": ranks}
    timing = result.get("timing", {})
    row |= {"compute_s": timing.get("compute_s"), "wall_s": timing.get("wall_s")}
    row["solver"] = result.get("pressure", {}).get("solver")
    if result["exit_code"] is None:
        row["not_run"] = result["message"]
    elif ranks > 1 and result["exit_code"] == 2:
        row["refused"] = result["message"]
    return row


def failed(row):
    """True if the run of a row ended in a failure: neither refused nor left out."""
    return not ("refused" in row or "not_run" in row) and row["exit_code"] != 0


def scene_names(program, arguments):
    """Names of the scenes that have rows."""
    names = list_scenes(program) if arguments.full else small_scenes(program)
    return [name for name in names if re.search(arguments.only, name)]


def record_rows(program, arguments, earlier, save):
    """Rows of all scenes, backends and ranks in the order of ranks; calls `save` with the rows after each run."""
    kept = {(row["scene"], row["backend"], row["ranks"]): row for row in earlier}
    rows = []
    cases = [
        (scene, backend, ranks)
        for ranks in map(int, arguments.ranks.split(","))
        for backend in arguments.backends.split(",")
        for scene in scene_names(program, arguments)
    ]
    for case in cases:
        scene, backend, ranks = case
        before = kept.pop(case, None)
        skipped = arguments.skip and re.search(arguments.skip, scene)
        if before and (skipped or "not_run" not in before):
            rows.append(before)
            continue
        if skipped:
            result = {"exit_code": None, "message": f"left out by --skip '{arguments.skip}'"}
        else:
            folder = arguments.work / f"{scene}-{backend}-{ranks}"
            result = run(program, scene, backend, folder, ranks=ranks, limit=arguments.limit)
        rows.append(row_of(result, *case))
        save(rows + list(kept.values()))
    return rows + list(kept.values())


def print_gaps(rows):
    """Prints the scenes that refused ranks or were not run."""
    for key in ("refused", "not_run"):
        for row in rows:
            if key in row:
                print(f"{key}: {row['scene']}, {row['backend']}, ranks {row['ranks']}: {row[key]}")


def table(rows, names):
    """Markdown table of the scenes `names`: how many passed on each backend and number of ranks, and the others."""
    lines = ["| ranks | backend | passed | failed | refuse several ranks | not run |", "|---:|---|---:|---|---|---|"]
    for ranks, backend in sorted({(row["ranks"], row["backend"]) for row in rows}):
        here = {row["scene"]: row for row in rows if (row["ranks"], row["backend"]) == (ranks, backend)}
        kinds = {"passed": [], "refused": [], "not_run": [], "failed": []}
        for name in names:
            row = here.get(name, {"not_run": "no row"})
            kind = next((key for key in ("refused", "not_run") if key in row), None)
            kinds[kind or ("failed" if failed(row) else "passed")].append(name)
        lists = (", ".join(f"`{name}`" for name in kinds[key]) for key in ("failed", "refused", "not_run"))
        lines.append(f"| {ranks} | {backend} | {len(kinds['passed'])} of {len(names)} | {' | '.join(lists)} |")
    return "\n".join(lines)


def main():
    options = argument_parser(__doc__)
    options.add_argument("--ranks", default="1,2,4")
    options.add_argument("--full", action="store_true")
    options.add_argument("--only", default="")
    options.add_argument("--skip")
    options.add_argument("--limit", type=float)
    options.add_argument("--add", action="store_true")
    arguments = options.parse_args()
    file = arguments.to / f"parachute-{arguments.machine}.json"
    earlier = json.loads(file.read_text())["runs"] if arguments.add and file.exists() else []
    record = {"schema": "drogue.record/1", "machine": arguments.machine}

    def save(rows):
        save_record(record | {"runs": rows}, file)

    program = arguments.bin / "drogue-parachute"
    rows = record_rows(program, arguments, earlier, save)
    print_gaps(rows)
    print(table(rows, small_scenes(program)))
    return write_record(record | {"runs": rows}, file, [row for row in rows if failed(row)], ())


if __name__ == "__main__":
    sys.exit(main())
