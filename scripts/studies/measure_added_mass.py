#!/usr/bin/env python3
"""Prints the added mass of a disk that oscillates along its axis in fluid at rest, on several grids.

    scripts/studies/measure_added_mass.py [--cells 8 16] [--amplitude 0.02] [--bin build/host/bin] [--out out/added-mass]
                                          [-- ARGUMENT...]

The disk of `disk-normal` is moved by amplitude sin(2 pi t), m, for three periods in a box of two diameters to each side.
--cells: cells per diameter. The part of the force on the disk in phase with its acceleration, over two periods, is printed
as added mass; then follow the part in phase with the velocity (negative if it brakes the disk), the root mean square of the
rest, and the largest force. All are relative to the force of an ideal fluid, whose added mass is 8/3 rho a^3 (Lamb,
Hydrodynamics, 1932, section 102). ARGUMENTs go to the program, such as `--backend serial --set 'coupling={method="sharp"}'`.
"""

import argparse
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from recording import parse_with_arguments, read_history, run_parachute  # noqa: E402

RADIUS, DENSITY = 0.5, 1.0  # m, kg/m^3, of the scene
OMEGA = 2.0 * math.pi  # angular frequency, rad/s
START, END = 1.0, 3.0  # s, of the two periods measured


def settings(cells, amplitude):
    """Assignments of the run on a grid with `cells` cells to a diameter of the disk."""
    values = {"fluid.velocity": "[0,0,0]", "initial": "{}", "grid.cells": [4 * cells] * 3,
              "grid.domain": "[[-2,2],[-2,2],[-2,2]]", "body[0].edge_length": 0.5 / cells,
              "body[0].motion": f'{{x="{amplitude:g}*sin({OMEGA!r}*t)"}}', "run.end_time": END,
              "run.max_dt": 0.08 / cells, "output": "{history_every=1,fields=[]}", "verify": "{}"}
    return [f"{key}={value}" for key, value in values.items()]


def parts(rows):
    """Parts of the force in phase with acceleration and velocity, root mean square of the rest, and largest force, N."""
    rows = [row for row in rows if row["time"] > START - 1e-9]
    # Trapezoidal rule: integrals over whole periods leave one part of the force each.
    widths = [0.5 * (after["time"] - before["time"]) for before, after in zip(rows, rows[1:])]
    weights = [left + right for left, right in zip([0.0, *widths], [*widths, 0.0])]

    def mean(values):
        return sum(weight * value for weight, value in zip(weights, values)) / sum(weights)

    force = [row["body_0_force_x"] for row in rows]
    sine, cosine = ([wave(OMEGA * row["time"]) for row in rows] for wave in (math.sin, math.cos))
    offset = mean(force)
    inertia, drag = (2.0 * mean([f * w for f, w in zip(force, wave)]) for wave in (sine, cosine))
    rest = [f - offset - inertia * s - drag * c for f, s, c in zip(force, sine, cosine)]
    return inertia, drag, math.sqrt(mean([r * r for r in rest])), max(map(abs, force))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", nargs="+", default=[8, 16], type=int, help="cells to a diameter of the disk, several grids")
    parser.add_argument("--amplitude", type=float, default=0.02, help="largest displacement, m")
    options, arguments = parse_with_arguments(parser, "out/added-mass")
    program = options.bin / "drogue-parachute"
    if not program.exists() or min(options.cells) < 1 or not options.amplitude > 0.0:
        sys.exit(f"measure_added_mass.py: --cells and --amplitude must be positive, and {program} must exist.")
    ideal = 8.0 / 3.0 * DENSITY * RADIUS**3 * options.amplitude * OMEGA**2
    for cells in options.cells:
        out = run_parachute(options, "disk-normal", f"{cells}", settings(cells, options.amplitude), arguments)
        inertia, drag, rest, largest = (part / ideal for part in parts(read_history(out)))
        print(f"{cells} cells: added mass {inertia:.3f}, with the velocity {drag:.3f}, rest {rest:.3f}, largest {largest:.2f}",
              flush=True)


if __name__ == "__main__":
    main()
