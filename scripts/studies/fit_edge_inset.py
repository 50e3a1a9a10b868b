#!/usr/bin/env python3
"""Fits the inset of free edges that gives a disk across a steady stream, and a plate in two dimensions, their drag.

    scripts/studies/fit_edge_inset.py [--cells 6 8] [--courant 0.5 0.25 0.125] [--limit 1.56 2.868] [--bin build/host/bin]
                                      [--out out/inset] [-- ARGUMENT...]

The disk of `disk-normal` has a Reynolds number of 100 between sides of four diameters, the plate one of 40 between sides
of six widths. --cells: across the body. --limit: drag coefficients of disk and plate on infinitely many cells. Of each
body, grid and Courant number, two runs with insets INSETS give the one with the drag of the limit, by a line. The last
row is the least-squares fit a + b log2(0.5 / C) of `coupling::standard_edge_inset`. ARGUMENTs go to the program.
"""

import argparse
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from recording import parse_with_arguments, read_history, run_parachute  # noqa: E402

INSETS = (0.55, 0.7)  # cells
BODIES = ("disk", "plate")
END, MEAN = {"disk": 12.0, "plate": 10.0}, 1.0  # s, of the run, and before it


def settings(body, cells, courant, inset):
    """Assignments of `disk-normal` for a body on a grid with `cells` cells across it."""
    plane = body == "plate"
    thickness = 1.0 / cells
    shape = (f'kind="plate",normal="x",centre=[0,0,{0.5 * thickness!r}],lengths=[1,{thickness!r}]' if plane else
             'kind="disk",normal="x",centre=[0,0,0],radius=0.5')
    return ["fluid.viscosity=0.025" if plane else "fluid.viscosity=0.01",
            f"grid.cells=[{8 * cells},{6 * cells},1]" if plane else f"grid.cells=[{6 * cells},{4 * cells},{4 * cells}]",
            f"grid.domain=[[-3,5],[-3,3],[0,{thickness!r}]]" if plane else "grid.domain=[[-2,4],[-2,2],[-2,2]]",
            'grid.boundary={x=["inflow","outflow"],y="slip"' + ("}" if plane else ',z="slip"}'),
            "initial.velocity=[0,0,0]", f"body=[{{{shape},edge_length={0.5 / cells!r}}}]", f"run.end_time={END[body]}",
            "run.max_dt=1", f"run.cfl={courant}", f"coupling.edge_inset={inset}", "output={history_every=4,fields=[]}", "verify={}"]


def drag(options, body, cells, courant, inset, arguments):
    """Mean drag coefficient at the end of a run."""
    out = run_parachute(options, "disk-normal", f"{body}-{cells}-{courant:g}-{inset:g}", settings(body, cells, courant, inset), arguments)
    forces = [row["body_0_force_x"] for row in read_history(out) if row["time"] > END[body] - MEAN]
    area = math.pi / 4.0 if body == "disk" else 1.0 / cells
    return sum(forces) / len(forces) / (0.5 * area)


def line(points):
    """Offset and slope of the least-squares line through points."""
    xs, ys = zip(*points)
    x, y = sum(xs) / len(xs), sum(ys) / len(ys)
    slope = sum((a - x) * (b - y) for a, b in points) / sum((a - x)**2 for a in xs)
    return y - slope * x, slope


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", nargs="+", default=[6, 8], type=int)
    parser.add_argument("--courant", nargs="+", default=[0.5, 0.25, 0.125], type=float)
    parser.add_argument("--limit", nargs=2, default=[1.56, 2.868], type=float)
    options, arguments = parse_with_arguments(parser, "out/inset")
    points = []
    for body, limit in zip(BODIES, options.limit):
        for cells in options.cells:
            for courant in options.courant:
                found = [drag(options, body, cells, courant, inset, arguments) for inset in INSETS]
                best = INSETS[0] + (limit - found[0]) * (INSETS[1] - INSETS[0]) / (found[1] - found[0])
                points.append((math.log2(0.5 / courant), best))
                print(f"{body} {cells} cells, Courant number {courant:g}: drag {found[0]:.4f} and {found[1]:.4f}, inset {best:.3f}", flush=True)
    if len(set(options.courant)) > 1:
        print("inset = {:.3f} + {:.3f} log2(0.5 / C)".format(*line(points)))


if __name__ == "__main__":
    main()
