#!/usr/bin/env python3
"""Compares the results of all small scenes of a program bit for bit between backends, in builds of a preset `exact`.

    scripts/compare_backends.py PROGRAM --bin build/cuda-exact/bin [--backends serial,openmp,cuda] [--only REGEX]
                                [--skip REGEX] [--jobs N] [--work FOLDER] [--to FILE]

PROGRAM is gas, springs or parachute. Of each scene it compares the datasets of fields.h5, or history.csv if the scene
writes no fields, with those of the first backend. Options:

    --only   only scenes whose names contain the regular expression
    --skip   scenes that are left out, besides those named -full
    --jobs   scenes that run at the same time, each on one thread of a host; default: one
    --to     JSON file for the rows and the provenance

Needs h5py. Prints the scenes that differ, with the numbers of datasets, or failed. The exit code is 1 if any did, 2 if
nothing was compared.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import sys

from recording import exact_row, list_scenes, save_record


def chosen_scenes(program, only, skip):
    """Names of the small scenes with `only` in their names and, if it is given, without `skip`."""
    names = [name for name in list_scenes(program) if not name.endswith("-full") and re.search(only, name)]
    return [name for name in names if not (skip and re.search(skip, name))]


def described(row, backends):
    """One line on a row that is not identical."""
    if any(row["exit_codes"]):
        codes = (f"{backend} {code}" for backend, code in zip(backends, row["exit_codes"], strict=True))
        return f"{row['scene']}: exit codes {', '.join(codes)}"
    counts = (f"{backend} ({count})" for backend, count in row["different"].items() if count)
    return f"{row['scene']}: other bits than on {backends[0]}: {', '.join(counts)}"


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program", choices=("gas", "springs", "parachute"))
    options.add_argument("--bin", type=pathlib.Path, required=True)
    options.add_argument("--backends", default="serial,openmp,cuda")
    options.add_argument("--only", default="")
    options.add_argument("--skip")
    options.add_argument("--jobs", type=int, default=1)
    options.add_argument("--work", type=pathlib.Path, default=pathlib.Path("out/compare"))
    options.add_argument("--to", type=pathlib.Path)
    arguments = options.parse_args()
    program, backends = arguments.bin / f"drogue-{arguments.program}", arguments.backends.split(",")
    if arguments.jobs > 1:
        os.environ["OMP_NUM_THREADS"] = "1"
    scenes = chosen_scenes(program, arguments.only, arguments.skip)
    if not scenes:
        print("no scene was compared")
        return 2
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as jobs:
        rows = list(jobs.map(lambda scene: exact_row(program, scene, backends, arguments.work), scenes))
    different = [row for row in rows if not row["identical"]]
    for row in different:
        print(described(row, backends))
    print(f"{len(rows) - len(different)} of {len(rows)} scenes have the same bits on {', '.join(backends)}")
    if arguments.to:
        last = json.loads((arguments.work / f"exact-{rows[-1]['scene']}-{backends[-1]}" / "result.json").read_text())
        head = {"schema": "drogue.record/1", "program": arguments.program, "backends": backends}
        save_record(head | {key: last.get(key) for key in ("provenance", "git")} | {"exact": rows}, arguments.to)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
