#!/usr/bin/env python3
"""Draws drag and opening force of a held C-9 against the time of a flight, with and without corrections of the coupling.

    scripts/studies/draw_flight_precision.py [--bin build/cuda/bin] [--record FILE] [--out FILE]

With --bin, flies each of four starts of `c9-flat-full` for 2 s on five grids first, and writes the record: rows of the study's
runs.csv with the coupling and the size of the cells, m, in front. Prints means with the scatter of the starts; the drag is that in
free air, from 1 s on. Needs numpy and matplotlib.
"""

import argparse
import collections
import csv
import pathlib
import statistics
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from plot import style  # noqa: E402
from recording import run_parachute  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPACINGS = (0.4, 0.3, 0.2, 0.15, 0.1)
NAMES = {"default": "default coupling", "plain": "without corrections"}
QUANTITIES = (
    ("canopy_0.drag_coefficient_free_air", 1.0, "drag coefficient in free air", (0.75, 0.80), "published, 0.75 to 0.80"),
    ("canopy_0.peak_line_force", 1e-3, "largest force of the lines (kN)", None, None),
)


def fly(programs, record):
    """Runs the ten studies one after the other, and writes their rows."""
    rows = []
    with tempfile.TemporaryDirectory() as work:
        options = argparse.Namespace(bin=programs, out=pathlib.Path(work))
        for coupling in NAMES:
            for spacing in SPACINGS:
                sets = (f"grid.spacing={spacing}", f"canopy[0].edge_length={0.7 * spacing:.4g}", f'coupling.corrections="{coupling}"',
                        "grid.core=[[-6,6],[-6,6],[-6.4,5.6]]", "canopy[0].perturbation.amplitude=0.01", "run.end_time=2",
                        "output={fields=[],restart_every=0}", "verify={divergence=1e-9}")
                folder = run_parachute(options, "c9-flat-full", f"{coupling}-{spacing}", sets, ["--study", "ensemble=4,jobs=1"])
                with open(folder / "runs.csv", newline="") as file:
                    rows += [{"coupling": coupling, "spacing": spacing} | row for row in csv.DictReader(file)]
    with open(record, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def draw(flights, out):
    figure, axes = style.plt.subplots(1, 2, figsize=(7.2, 3.1))
    style.heading(figure, "A held C-9 for 2 s on one H200", "four starts on each grid, cells of 0.4 to 0.1 m; bars: their scatter")
    figure.subplots_adjust(left=0.08, right=0.98, top=0.72, bottom=0.15, wspace=0.22)
    for axis, (column, factor, label, band, source) in zip(axes, QUANTITIES):
        if band:
            axis.axhspan(*band, color=style.GRID, label=source)
        for (coupling, name), colour in zip(NAMES.items(), style.PALETTE):
            points = []
            for spacing in SPACINGS:
                rows = flights[coupling, spacing]
                values = [factor * float(row[column]) for row in rows]
                points.append((statistics.median(float(row["wall_s"]) for row in rows), statistics.mean(values), statistics.stdev(values)))
                print(f"{coupling:8} {spacing:4} m  {points[-1][0]:6.2f} s  {label} {points[-1][1]:.3f} +- {points[-1][2]:.3f}")
            times, means, scatter = zip(*points)
            axis.errorbar(times, means, scatter, color=colour, marker="o", markersize=4, capsize=2, label=name)
        axis.set(xscale="log", xlabel="time of a flight (s)", title=label)
        style.set_log_ticks(axis.xaxis)
        axis.legend(frameon=False, fontsize=8)
    style.save_figure(figure, out, 150)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=pathlib.Path, help="folder of drogue-parachute with CUDA; without it the record is read")
    parser.add_argument("--record", type=pathlib.Path, default=ROOT / "docs/evidence/flight-precision-h200.csv")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/images/flight-precision.png")
    options = parser.parse_args()
    if options.bin:
        fly(options.bin, options.record)
    flights = collections.defaultdict(list)
    with open(options.record, newline="") as file:
        for row in csv.DictReader(file):
            flights[row["coupling"], float(row["spacing"])].append(row)
    draw(flights, options.out)


if __name__ == "__main__":
    main()
