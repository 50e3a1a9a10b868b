#!/usr/bin/env python3
"""Compares two builds of the programs: the bits of their results, or their speed in alternating runs.

    scripts/compare_builds.py OLD NEW [--backend serial] [--only REGEX]
    scripts/compare_builds.py OLD NEW --speed FILTER [--rounds 5] [--quick] [--fail-on slower] [--keep FOLDER]

OLD and NEW are folders of programs, such as build/exact/bin. Without --speed, both builds run every shipped scene and
batch, and datasets, histories and prices are compared byte for byte; needs h5py and builds of the preset `exact`, since
the compiler chooses fused operations differently. A scene that fails, or writes neither fields nor history, counts as
different: its bits are unknown; a program that neither build has is left out. With --speed, both builds alternately
run `drogue-perf run --filter FILTER` (with --quick, its shorter form) and NEW's `drogue-perf compare` prints a verdict per
case; --keep writes the records, old.jsonl and new.jsonl, and the verdicts, compare.txt, into FOLDER. The exit code is
then that of `compare --fail-on`. Otherwise it is 1 if a result differs, 2 if nothing was compared.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

from recording import differing_results, run, small_scenes

BATCHES = {
    "example": ["price", "example", "--greeks"],
    "example-128x32": ["price", "example", "--mesh", "128", "--steps", "32"],
    "example-1e-5": ["price", "example", "--tolerance", "1e-5"],
    "example-cos": ["price", "example", "--method", "cos"],
    "example-baseline": ["price", "example", "--method", "seed", "--mesh", "128", "--steps", "32"],
    "hard_cases": ["price", "hard_cases"],
    "example_surface": ["surface", "example_surface", "--strikes", "60:140:9", "--maturities", "0.25,1"],
}


SCENE_PROGRAMS = ("drogue-gas", "drogue-springs", "drogue-parachute")


def scene_difference(programs, scene, backend, work):
    """Names of the datasets that differ between the runs of one scene, or the reason why they cannot be compared."""
    folders = [work / f"{scene}-{side}" for side in ("old", "new")]
    for program, folder in zip(programs, folders, strict=True):
        result = run(program, scene, backend, folder)
        if result["exit_code"] != 0:
            return [f"exit code {result['exit_code']} of {program}: {result['message']}"]
    return differing_results(*folders)


def batch_difference(programs, words, backend, work):
    """Like `scene_difference`, for a batch of options."""
    prices = []
    for side, program in zip(("old", "new"), programs, strict=True):
        file = work / f"{side}.csv"
        file.unlink(missing_ok=True)
        subprocess.run([program, *words, "--backend", backend, "--out", file], capture_output=True, check=False)
        prices.append(file.read_bytes() if file.exists() else None)
    return [] if prices[0] is not None and prices[0] == prices[1] else ["prices"]


def cases_of(program):
    """Comparison and its argument of each scene or batch of a program, by name."""
    if program.name == "drogue-options":
        return {batch: (batch_difference, words) for batch, words in BATCHES.items()}
    # NAME-full repeats the scene NAME on a fine mesh for GPUs and is skipped.
    return {s: (scene_difference, s) for s in small_scenes(program)}


def compare_bits(old, new, backend, only):
    """Prints a line per scene and batch; returns their number and that of those that differ."""
    compared = count = 0
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for name in (*SCENE_PROGRAMS, "drogue-options"):
            programs = [old / name, new / name]
            missing = [program for program in programs if not program.exists()]
            if len(missing) == 2:
                continue
            if missing:
                raise SystemExit(f"{missing[0]} does not exist, but the other build has this program")
            for case, (difference, argument) in cases_of(programs[1]).items():
                if not re.search(only, f"{name}/{case}"):
                    continue
                different = difference(programs, argument, backend, work)
                words = f"different: {', '.join(different[:5])}" if different else "the same bits"
                print(f"{name} {case}: {words}", flush=True)
                compared += 1
                count += bool(different)
    return compared, count


def compare_speed(programs, words, rounds, fail_on, work):
    """Prints the verdicts of `drogue-perf compare`, which stay in `work`; returns its exit code, 0 if no case has a verdict of `fail_on`.

    `programs`: drogue-perf of both builds; `words`: arguments of its subcommand `run`.
    """
    sides = dict(zip(("old", "new"), programs, strict=True))
    for side in sides:
        (work / f"{side}.jsonl").write_text("")
    for turn in range(rounds):
        for side in sides if turn % 2 == 0 else reversed(sides):
            file = work / "run.jsonl"
            # Exit code 5: a case failed its check, which the comparison reports.
            done = subprocess.run([sides[side], "run", *words, "--out", file], stdout=subprocess.DEVNULL, check=False)
            if done.returncode not in (0, 5):
                raise SystemExit(f"{sides[side]} run failed")
            with (work / f"{side}.jsonl").open("a") as records:
                records.write(file.read_text())
            file.unlink()
    done = subprocess.run(
        [sides["new"], "compare", work / "old.jsonl", work / "new.jsonl", "--fail-on", fail_on],
        stdout=subprocess.PIPE, text=True, check=False,
    )
    (work / "compare.txt").write_text(done.stdout)
    print(done.stdout, end="")
    return done.returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path)
    parser.add_argument("--backend", default="serial")
    parser.add_argument("--only", default="", help="regular expression for PROGRAM/SCENE")
    parser.add_argument("--speed", metavar="FILTER", help="compare the speed of these cases of drogue-perf instead")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--quick", action="store_true", help="as in drogue-perf run")
    parser.add_argument("--fail-on", default="slower", help="as in drogue-perf compare")
    parser.add_argument(
        "--keep", type=pathlib.Path, metavar="FOLDER", help="folder for the records and verdicts of --speed"
    )
    arguments = parser.parse_args()
    old, new = arguments.old.resolve(), arguments.new.resolve()
    if arguments.speed is not None:
        words = ["--filter", arguments.speed, *(["--quick"] if arguments.quick else [])]
        programs = [build / "drogue-perf" for build in (old, new)]
        with tempfile.TemporaryDirectory() as temporary:
            work = arguments.keep or pathlib.Path(temporary)
            work.mkdir(parents=True, exist_ok=True)
            return compare_speed(programs, words, arguments.rounds, arguments.fail_on, work)
    compared, different = compare_bits(old, new, arguments.backend, arguments.only)
    if compared == 0:
        print("nothing was compared: no case has such a name", file=sys.stderr)
        return 2
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
