#!/usr/bin/env python3
"""Measures what the corrections of delta functions change: drag of a disk, leak of a canopy, frequency of a drum, drag of a porous
canopy, on several grids of equal and of stretched cells.

    scripts/studies/measure_corrections.py [CASE...] [--cells N...] [--grids uniform stretched] [--corrections plain default]
                                           [--bin build/host/bin] [--out out/corrections] [-- ARGUMENT...]

CASEs, by default all; --cells replaces their numbers of cells per m of the finest part of a grid:

    disk    C_D at Reynolds number 100 between sides of four diameters
    leak    of an impermeable C-9 held in 5.7 m/s, mean from 3 to 6 s over U A, percent; a box of 24 m, or stretched to 36 m
    drum    frequency of a membrane in air, Hz: a periodic box of 2 m, or stretched to slip sides 4 m apart
    porous  drag coefficient of a C-9 of coarse cloth, mean from 2 to 4 s

Prints a row per grid, with the seconds of all steps. ARGUMENTs go to the program, such as `--backend cuda`.
"""

import argparse
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from recording import parse_with_arguments, read_history, run_parachute  # noqa: E402

STREAM_X, STREAM_Z = '{x=["inflow","outflow"],y="slip",z="slip"}', '{x="slip",y="slip",z=["inflow","outflow"]}'


def cube(half):
    return [[-half, half]] * 3


def grid(domain, core, boundary, cells, stretched):
    """The group `grid` with so many cells per m."""
    if stretched:
        return f"grid={{core={core},spacing={1.0 / cells!r},domain={domain},boundary={boundary}}}"
    numbers = [round((high - low) * cells) for low, high in domain]
    return f"grid={{cells={numbers},domain={domain},boundary={boundary}}}"


def disk(cells, stretched):
    return "disk-normal", [grid([[-2, 4], [-2, 2], [-2, 2]], [[-1, 1.5], [-1, 1], [-1, 1]], STREAM_X, cells, stretched),
                           "fluid.viscosity=0.01", "initial.velocity=[0,0,0]", f"body[0].edge_length={0.5 / cells!r}",
                           "run.end_time=12", "run.cfl=0.5", "run.max_dt=1", "output={history_every=4,fields=[]}", "verify={}"]


def leak(cells, stretched):
    core, domain = [[-9.6, 9.6], [-9.6, 9.6], [-7.2, 9.6]], [[-12, 12], [-12, 12], [-9, 15]]
    if stretched:
        domain = [[-18, 18], [-18, 18], [-15, 21]]
    return "c9-drop", [grid(domain, core, STREAM_Z, cells, stretched), "canopy[0].payload={fixed=true}",
                       'canopy[0].porosity={law="none"}', f"canopy[0].edge_length={min(0.28, 0.7 / cells)!r}", "run.end_time=6",
                       "output={history_every=5,fields=[]}", "verify={leak=[{from=3,to=6,tolerance=9}]}"]


def drum(cells, stretched):
    boundary = '{x="slip",y="slip",z="slip"}' if stretched else '{x="periodic",y="periodic",z="periodic"}'
    return "membrane-drum-in-air", [grid(cube(2.0 if stretched else 1.0), cube(1.0), boundary, cells, stretched),
                                    f"canopy[0].edge_length={0.5 / cells!r}", "run.dt=0.0005", "output={history_every=4,fields=[]}",
                                    'verify={history=[{column="canopy_0_payload_z",statistic="frequency",value=1,tolerance=99}]}']


def porous(cells, stretched):
    core = [[-4.8, 4.8], [-4.8, 4.8], [-7.6, 6.0]]
    return "porous-c9", [grid([[-7.2, 7.2], [-7.2, 7.2], [-9, 15]], core, STREAM_Z, cells, stretched),
                         f"canopy[0].edge_length={0.67 / cells!r}", "canopy[0].perturbation={}",
                         "run={end_time=4,cfl=0.25,max_dt=0.02}", "output={history_every=5,fields=[]}", "verify={}"]


def mean(folder, column, start):
    """Mean of a column from a time on, by the trapezoidal rule."""
    rows = [row for row in read_history(folder) if row["time"] >= start]
    pairs = list(zip(rows, rows[1:]))
    return sum(0.5 * (a[column] + b[column]) * (b["time"] - a["time"]) for a, b in pairs) / (rows[-1]["time"] - rows[0]["time"])


def of_disk(folder):
    return mean(folder, "body_0_force_x", 11.0) / 0.3926990817


def of_leak(folder):
    return 100.0 * result(folder)["canopies"]["leak_0"]


def of_drum(folder):
    return 1.0 + next(check["value"] for check in result(folder)["checks"] if "frequency" in check["name"] or "payload" in check["name"])


def of_porous(folder):
    return mean(folder, "canopy_0_drag_coefficient", 2.0)


# Settings, number of a run, and cells per m.
CASES = {"disk": (disk, of_disk, [6, 8, 12]), "leak": (leak, of_leak, [1.25, 5 / 3, 2.5]), "drum": (drum, of_drum, [8, 12, 16]),
         "porous": (porous, of_porous, [5 / 3, 2.5, 5])}


def result(folder):
    return json.loads((folder / "result.json").read_text(encoding="utf-8"))


def measure(options, case, cells, kind, corrections, arguments):
    """Number of a run, and the seconds of its steps."""
    settings, number, _ = CASES[case]
    scene, sets = settings(cells, kind == "stretched")
    folder = run_parachute(options, scene, f"{case}-{kind}-{cells:.4g}-{corrections}",
                           [*sets, f"coupling.corrections={corrections}"], arguments, codes=(0, 5))
    return number(folder), result(folder)["timing"]["compute_s"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", metavar="CASE")
    parser.add_argument("--cells", nargs="+", type=float)
    parser.add_argument("--grids", nargs="+", default=["uniform", "stretched"], choices=["uniform", "stretched"])
    parser.add_argument("--corrections", nargs="+", default=["plain", "default"], choices=["plain", "default"])
    options, arguments = parse_with_arguments(parser, "out/corrections")
    if unknown := [case for case in options.cases if case not in CASES]:
        sys.exit(f"measure_corrections.py: there is no case {unknown[0]}; those are {', '.join(CASES)}.")
    print("| case | grid | cells per m |", *(f"{name} | s |" for name in options.corrections))
    print("|---|---|---:|" + "---:|---:|" * len(options.corrections), flush=True)
    for case in options.cases or CASES:
        for kind in options.grids:
            for cells in options.cells or CASES[case][2]:
                row = f"| {case} | {kind} | {cells:.4g} |"
                for corrections in options.corrections:
                    number, seconds = measure(options, case, cells, kind, corrections, arguments)
                    row += f" {number:.4g} | {seconds:.1f} |"
                print(row, flush=True)


if __name__ == "__main__":
    main()
