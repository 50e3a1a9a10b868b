#!/usr/bin/env python3
"""Compares the results of all small scenes of a program bit for bit between backends, in builds of a preset `exact`.

    scripts/compare_backends.py PROGRAM --bin build/cuda-exact/bin [--backends serial,openmp,cuda] [--only REGEX]
                                [--skip REGEX] [--jobs N] [--work FOLDER] [--to FILE]

PROGRAM is gas, springs or parachute. Of each scene it compares the datasets of fields.h5 and history.csv with those of
the first backend. Options:

    --only   only scenes whose names contain the regular expression
    --skip   scenes that are left out, besides those named -full
    --jobs   scenes that run at the same time, each with its share of the cores and at least two threads, unless
             OMP_NUM_THREADS is set; default: one
    --to     JSON file for the rows and the provenance, written after each scene

Needs h5py. Prints a line per scene. The exit code is 1 if one differs or failed, 2 if nothing was compared.
"""

import argparse
import concurrent.futures
import os
import pathlib
import re
import sys

from recording import exact_row, save_record, small_scenes


def expression(text):
    """A regular expression of the command line."""
    try:
        return re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(f"'{text}' is no regular expression: {error}") from error


def distinct_backends(text):
    """Names of at least two different backends."""
    names = [name.strip() for name in text.split(",")]
    if len(names) < 2 or len(set(names)) < len(names) or "" in names:
        raise argparse.ArgumentTypeError(f"'{text}' is no list of two or more different backends")
    return names


def positive(text):
    """A whole number above zero."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of scenes, 1 or more")
    return int(text)


def chosen_scenes(program, only, skip):
    """Names of the small scenes with `only` in their names and, if it is given, without `skip`."""
    return [name for name in small_scenes(program) if only.search(name) and not (skip and skip.search(name))]


def described(row, backends):
    """One line on a row."""
    if any(row["exit_codes"]):
        codes = (f"{backend} {code}" for backend, code in zip(backends, row["exit_codes"], strict=True))
        return f"{row['scene']}: exit codes {', '.join(codes)}: {row['message']}"
    if row["identical"]:
        return f"{row['scene']}: the same bits"
    counts = (f"{backend} ({count})" for backend, count in row["different"].items() if count)
    return f"{row['scene']}: other bits than on {backends[0]}: {', '.join(counts)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", choices=("gas", "springs", "parachute"))
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--backends", type=distinct_backends, default="serial,openmp,cuda")
    parser.add_argument("--only", type=expression, default="")
    parser.add_argument("--skip", type=expression)
    parser.add_argument("--jobs", type=positive, default=1)
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("out/compare"))
    parser.add_argument("--to", type=pathlib.Path)
    arguments = parser.parse_args()
    program, backends = arguments.bin / f"drogue-{arguments.program}", arguments.backends
    if not program.exists():
        parser.error(f"there is no program {program}")
    scenes = chosen_scenes(program, arguments.only, arguments.skip)
    if not scenes:
        parser.error("nothing was compared: no scene has such a name")
    if arguments.jobs > 1:
        os.environ.setdefault("OMP_NUM_THREADS", str(max(2, os.cpu_count() // arguments.jobs)))
    record = {"schema": "drogue.record/1", "program": arguments.program, "backends": backends}
    rows = {}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as jobs:
        for done in concurrent.futures.as_completed(
            jobs.submit(exact_row, program, scene, backends, arguments.work) for scene in scenes
        ):
            row, results = done.result()
            rows[row["scene"]] = row
            print(described(row, backends), flush=True)
            record |= {key: results[-1][key] for key in ("provenance", "git") if key in results[-1]}
            if arguments.to:
                save_record(record | {"exact": [rows[scene] for scene in scenes if scene in rows]}, arguments.to)
    same = sum(row["identical"] for row in rows.values())
    print(f"{same} of {len(rows)} scenes have the same bits on {', '.join(backends)}")
    return 0 if same == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
