#!/usr/bin/env python3
"""Compares two builds of the programs: the bits of their results, or their speed in alternating runs.

    scripts/compare_builds.py OLD NEW [--backend serial] [--only REGEX]
    scripts/compare_builds.py OLD NEW --speed FILTER [--rounds 5]

OLD and NEW are folders of programs, such as build/exact/bin. Without --speed, both builds run every shipped scene and
batch, and datasets, histories and prices are compared byte for byte; needs h5py and builds of the preset `exact`, since
the compiler chooses fused operations differently. With --speed, both builds alternately run `drogue-perf run --filter
FILTER`, and `drogue-perf compare` gives the verdicts. The exit code is 1 if a result differs or a case takes longer.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

from recording import differing_results, list_scenes, run

BATCHES = {
    "example": ["price", "example", "--greeks"],
    "example-128x32": ["price", "example", "--mesh", "128", "--steps", "32"],
    "example-1e-5": ["price", "example", "--tolerance", "1e-5"],
    "example-cos": ["price", "example", "--method", "cos"],
    "example-baseline": ["price", "example", "--method", "seed", "--mesh", "128", "--steps", "32"],
    "hard_cases": ["price", "hard_cases"],
    "example_surface": ["surface", "example_surface", "--strikes", "60:140:9", "--maturities", "0.25,1"],
}


def scene_difference(programs, scene, backend, work):
    """Names of the datasets that differ between the runs of one scene, or the reason why they cannot be compared."""
    folders = [work / f"{scene}-{side}" for side in ("old", "new")]
    results = [
        run(program, scene, backend, folder) for program, folder in zip(programs, folders, strict=True)
    ]
    codes = [result["exit_code"] for result in results]
    if codes[0] != codes[1]:
        return [f"exit codes {codes}: {results[1]['message']}"]
    different = differing_results(*folders) if (folders[0] / "fields.h5").exists() else []
    histories = [
        (folder / "history.csv").read_bytes() for folder in folders if (folder / "history.csv").exists()
    ]
    return different + (["history.csv"] if len(set(histories)) > 1 else [])


def batch_difference(programs, words, backend, work):
    """Like `scene_difference`, for a batch of options."""
    prices = []
    for side, program in zip(("old", "new"), programs, strict=True):
        file = work / f"{side}.csv"
        file.unlink(missing_ok=True)
        subprocess.run(
            [program, *words, "--backend", backend, "--out", file], capture_output=True, check=False
        )
        prices.append(file.read_bytes() if file.exists() else None)
    return [] if prices[0] is not None and prices[0] == prices[1] else ["prices"]


def compare_bits(old, new, backend, only):
    """Prints a line per scene and batch; returns the number of those that differ."""
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for name in ("drogue-gas", "drogue-springs", "drogue-options"):
            programs = [old / name, new / name]
            if name == "drogue-options":
                cases = {batch: (batch_difference, words) for batch, words in BATCHES.items()}
            else:
                # NAME-full repeats the scene NAME on a fine mesh for GPUs and is skipped.
                cases = {
                    s: (scene_difference, s) for s in list_scenes(programs[1]) if not s.endswith("-full")
                }
            for case, (difference, argument) in cases.items():
                if not re.search(only, f"{name}/{case}"):
                    continue
                different = difference(programs, argument, backend, work)
                print(
                    f"{name} {case}: {'different: ' + ', '.join(different[:5]) if different else 'the same bits'}",
                    flush=True,
                )
                count += bool(different)
    return count


def compare_speed(old, new, pattern, rounds):
    """Prints the verdicts of `drogue-perf compare`; returns its exit code, 0 if no case takes longer."""
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        sides = {"old": old, "new": new}
        for turn in range(rounds):
            for side in sides if turn % 2 == 0 else reversed(sides):
                file = work / "records.jsonl"
                file.unlink(missing_ok=True)
                # Exit code 5: a case failed its check, which the comparison reports.
                words = [sides[side] / "drogue-perf", "run", "--filter", pattern, "--out", file]
                if subprocess.run(words, stdout=subprocess.DEVNULL, check=False).returncode not in (0, 5):
                    raise SystemExit(f"drogue-perf of {sides[side]} failed")
                with (work / f"{side}.jsonl").open("a") as records:
                    records.write(file.read_text())
        words = [new / "drogue-perf", "compare", work / "old.jsonl", work / "new.jsonl", "--fail-on", "slower"]
        return subprocess.run(words, check=False).returncode


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("old", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path)
    parser.add_argument("--backend", default="serial")
    parser.add_argument("--only", default="", help="regular expression for PROGRAM/SCENE")
    parser.add_argument(
        "--speed", metavar="FILTER", help="compare the speed of these cases of drogue-perf instead"
    )
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    old, new = arguments.old.resolve(), arguments.new.resolve()
    if arguments.speed is not None:
        return 1 if compare_speed(old, new, arguments.speed, arguments.rounds) else 0
    return 1 if compare_bits(old, new, arguments.backend, arguments.only) else 0


if __name__ == "__main__":
    sys.exit(main())
