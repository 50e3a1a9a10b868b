#!/usr/bin/env python3
"""Runs taylor-green-3d with every turbulence model and prints the table of docs/flow-notebook.md.

    scripts/studies/measure_turbulence.py [--cells 32,64] [--advections weno5,central] [--models none,smagorinsky,vreman]
                                          [--bin build/host/bin] [--out out/turbulence] [-- ARGUMENT...]

Energy at t = 10 over that at the start; peak of the fall of the kinetic energy per time between rows of the history, as
[verify] takes it, with its time, and peak of the viscous dissipation of the resolved flow, as means over the volume; processor
time per step and cell on one core, all of the program included. ARGUMENTs go to the program.
"""

import argparse
import json
import math
import pathlib
import resource
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from recording import parse_with_arguments, read_history, run_parachute  # noqa: E402

VOLUME = (2 * math.pi) ** 3


def measure(rows):
    """Remaining part of the energy, peak of its fall and the time of that, peak of the viscous dissipation."""
    time, energy, dissipation = ([row[name] for row in rows] for name in ("time", "kinetic_energy", "dissipation"))
    falls = [((e0 - e1) / (t1 - t0), 0.5 * (t0 + t1)) for t0, t1, e0, e1 in zip(time, time[1:], energy, energy[1:], strict=False)]
    peak, at = max(falls)
    return energy[-1] / energy[0], peak / VOLUME, at, max(dissipation) / VOLUME


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", default="32,64", type=lambda text: [int(part) for part in text.split(",")])
    parser.add_argument("--advections", default="weno5,central", type=lambda text: text.split(","))
    parser.add_argument("--models", default="none,smagorinsky,vreman", type=lambda text: text.split(","))
    options, arguments = parse_with_arguments(parser, "out/turbulence")
    for cells in options.cells:
        for advection in options.advections:
            for model in options.models:
                # Rows about 0.1 s apart: a coarser history flattens the peak.
                sets = (f"grid.cells=[{cells}, {cells}, {cells}]", f"flow.advection={advection}", f"flow.turbulence={model}",
                        f"output={{history_every={max(1, cells // 32)}}}", "verify={}")
                before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
                out = run_parachute(options, "taylor-green-3d", f"{cells}-{advection}-{model}", sets, arguments)
                spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
                steps = json.loads((out / "result.json").read_text(encoding="utf-8"))["steps"]
                left, peak, at, viscous = measure(read_history(out))
                print(f"| {cells}^3 | {advection} | {model} | {left:.3f} | {peak:.5f} | {at:.2f} | {viscous:.5f} | "
                      f"{1e9 * spent / steps / cells**3:.0f} |", flush=True)


if __name__ == "__main__":
    main()
