#!/usr/bin/env python3
"""Drops a canopy at several angles to the stream, each several times with other random displacements of its cloth, and prints
how often it opens inside out.

    scripts/studies/measure_inversion.py [--angles 15,30,45,60,75,90] [--runs 8] [--amplitude 0.01] [--bin build/host/bin]
                                         [--out out/inversion] [-- ARGUMENT...]

The scene is c9-angled-60 in a box of 18 m, with the payload at one place for all angles. Openings are chaotic, so that a single run
means little. For each angle: the inversion index at the end of each run (the share of the lines at whose vertex of the skirt the
cloth is inside out, `canopy_0_inversion`), their mean, the number of runs above one half, and the median over the runs of the
largest index and of the largest force of the lines and its time. ARGUMENTs go to the program,
such as `--backend cuda --set run.end_time=3`.
"""

import argparse
import math
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from recording import parse_with_arguments, read_history, run_parachute  # noqa: E402

PAYLOAD = (-3.0, 0.0, -4.4)  # m
BOX = ("grid.cells=[45, 45, 48]", "grid.domain=[[-9, 9], [-9, 9], [-9.2, 10]]", "canopy[0].edge_length=0.28", "run.cfl=0.25",
       "run.max_dt=0.01", "verify={divergence = 1e-12}")
DIAMETER, LINES = 8.534, 7.0  # m, of the scene


def settings(angle, seed, amplitude):
    """Assignments of a run."""
    distance = math.sqrt(LINES**2 - (DIAMETER / 2) ** 2)
    turn = math.radians(angle)
    centre = [PAYLOAD[0] + distance * math.sin(turn), PAYLOAD[1], PAYLOAD[2] + distance * math.cos(turn)]
    return [*BOX, 'canopy[0].shape="flat"', f"canopy[0].angle={angle:g}", f"canopy[0].centre={centre}",
            f"canopy[0].perturbation={{amplitude = {amplitude}, seed = {seed}}}", "output.fields=[]"]


def measures(directory):
    """Last and largest inversion index, largest force of the lines, N, and its time, s."""
    rows = read_history(directory)
    index = [row["canopy_0_inversion"] for row in rows]
    force, time = max((math.hypot(*(row[f"canopy_0_line_force_{axis}"] for axis in "xyz")), row["time"]) for row in rows)
    return index[-1], max(index), force, time


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--angles", default="15,30,45,60,75,90", type=lambda text: [float(part) for part in text.split(",")])
    parser.add_argument("--runs", type=int, default=8)
    parser.add_argument("--amplitude", type=float, default=0.01, help="largest displacement, m")
    options, arguments = parse_with_arguments(parser, "out/inversion")
    program = options.bin / "drogue-parachute"
    if options.runs < 1 or not program.exists():
        sys.exit("measure_inversion.py: " + (f"there is no {program}." if options.runs > 0 else "--runs must be at least 1."))
    for angle in options.angles:
        runs = []
        for seed in range(1, options.runs + 1):
            sets = settings(angle, seed, options.amplitude)
            runs.append(measures(run_parachute(options, "c9-angled-60", f"{angle:g}-{seed}", sets, arguments)))
        last, largest, force, time = zip(*runs)
        print(f"{angle:g} degrees: index", " ".join(f"{index:.2f}" for index in last),
              f"; mean {statistics.mean(last):.2f}; above one half {sum(index > 0.5 for index in last)} of {len(runs)}"
              f"; largest {statistics.median(largest):.2f}; {statistics.median(force):.0f} N at {statistics.median(time):.2f} s",
              flush=True)


if __name__ == "__main__":
    main()
