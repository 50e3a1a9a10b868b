#!/usr/bin/env python3
"""Writes docs/evidence/springs-<machine>.json, the record of drogue-springs on this machine, from its result files.

    scripts/record_springs.py MACHINE --bin build/cuda/bin [--exact build/cuda-exact/bin]
                              [--backends serial,openmp,cuda] [--tables serial] [--largest]
                              [--small-steps] [--work FOLDER] [--to FOLDER]

The record holds every shipped scene on every backend (error, tolerance, steps, time, ledger), and tables 5.1 to 5.4 of
[Shi] beside its numbers. Options:

    --exact     bitwise comparison of the datasets of all scenes between backends
    --tables    backend of the tables; default: the last one of --backends
    --largest   table 5.3 with its finest mesh
    --small-steps  table 5.3 also at the step of [Shi], z < 0.1, and over its full 2 s
    --to        folder of the record; default: docs/evidence

Needs numpy and h5py. Prints the tables as Markdown. The exit code is 1 if any run failed.
"""

import csv
import json
import pathlib
import subprocess
import sys

from recording import argument_parser, assignments, exact_rows, run, scene_runs, write_record

# Tables 5.1 and 5.2: number of points, spring stiffness (N/m), and Cauchy errors to the next mesh of length (m),
# kinetic and spring energy (J).
CHORD = ((60, 5000, (0.00374, 0.01664, 0.03464)), (123, 10000, (0.00184, 0.00821, 0.01726)),
         (248, 20000, (0.000918, 0.00406, 0.008614)), (498, 40000, None))
# Tables 5.1 and 5.3: number of points, and Cauchy errors of area (m^2), kinetic and spring energy (J).
DRUM = ((266, (0.02528, 1.91810, 1.97967)), (990, (0.01507, 1.21784, 1.21772)), (3790, (0.00604, 0.53550, 0.52837)),
        (14841, None))
# Table 5.4: Poisson's ratio, then for each Young's modulus (Pa) the measured modulus and Poisson's ratio.
STRIP = (
    (0.14, ((1e8, 0.0963016606e9, 0.141887), (2e8, 0.1926061554e9, 0.141920), (3e8, 0.2888656609e9, 0.141910),
            (4e8, 0.3852341348e9, 0.141913), (5e8, 0.4815205552e9, 0.141905))),
    (0.22, ((1e8, 0.0957361901e9, 0.223342), (2e8, 0.1914918931e9, 0.223332), (3e8, 0.2870650506e9, 0.223382),
            (4e8, 0.3829895385e9, 0.223349), (5e8, 0.4784196259e9, 0.223365))),
    (0.30, ((1e8, 0.0953452395e9, 0.305362), (2e8, 0.1906619377e9, 0.305342), (3e8, 0.2860538596e9, 0.305343),
            (4e8, 0.3814011184e9, 0.305359), (5e8, 0.4767297379e9, 0.305355))),
)
STRIP_VERTICES = 1300  # about 2468 triangles, one of the meshes of figure 5.5
THICKNESS = 1e-4  # m; not given in [Shi], and without influence on the ratios
GRIPS = 'pin=[{where="x==0"},{where="x>0.1-1e-9",motion={x=1e-6}},{where="1",axes="z"}]'
END_TIME = 1.0  # s, in tables 5.2 and 5.3
LONG_END_TIME = 2.0  # s, of [Shi]
SMALL_STEP = "time.safety=0.0353"  # z < 0.1 of [Shi] over the limit of stability, 2 sqrt(2)


def until(end_time):
    """Settings of a run to `end_time` (s) with an output every 5 ms."""
    times = [round(0.005 * k, 6) for k in range(round(end_time / 0.005) + 1)]
    return [f"time.end_time={end_time}", f"output.times={times}", "output.history_every=2000"]


def study(program, scene, backend, folder, lists, *sets):
    """Rows of a study, each with its time series and its row of study.csv; empty if the study failed."""
    command = [program, scene, "--backend", backend, "--overwrite", "--quiet", "--out", folder, "--study", lists]
    words = [str(word) for word in [*command, *assignments(*sets)]]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return []
    rows = json.loads((folder / "study.json").read_text())["rows"]
    with (folder / "study.csv").open(newline="") as file:
        return [row | {"cells": cells} for row, cells in zip(rows, csv.DictReader(file), strict=True)]


def mean_difference(time, first, second, power=1):
    """Time average of |first - second| by the trapezoidal rule; for power 2, the root mean square."""
    apart = [abs(a - b) ** power for a, b in zip(first, second, strict=True)]
    integrals = (0.5 * (apart[k - 1] + apart[k]) * (time[k] - time[k - 1]) for k in range(1, len(time)))
    return (sum(integrals) / (time[-1] - time[0])) ** (1 / power)


def cauchy(coarse, fine, measure, power=1):
    """Cauchy errors of a measure and of the kinetic and elastic energies between two meshes."""
    return [
        mean_difference(coarse["series"]["time"], coarse["series"][name], fine["series"][name], power)
        for name in (measure, "kinetic", "elastic")
    ]


def table_row(points, mass, printed, found, **more):
    """Row of a table with the printed values of [Shi] and the computed ones."""
    return {"points": points, "mass": mass} | more | {"dissertation": printed, "cauchy": found}


def chord_table(program, backend, work):
    """Table 5.2, with the stiffnesses of [Shi], whose E A varies slightly by mesh, and with fixed E A."""
    sets = until(END_TIME)
    own = [
        study(
            program, "swing-chord", backend, work / f"chord-{points}", "masses=equal:area", *sets,
            f"mesh.string.vertices={points}", f"material.stiffness={stiffness}",
        )
        for points, stiffness, _ in CHORD
    ]
    kept = study(
        program, "swing-chord", backend, work / "chord-kept",
        "meshes=" + ":".join(str(points) for points, *_ in CHORD) + ",masses=equal:area", *sets,
    )
    if not all(own) or not kept:
        return None
    rows = []
    for turn, mass in enumerate(("equal", "area")):
        for k, (points, stiffness, printed) in enumerate(CHORD[:-1]):
            pair = own[k][turn], own[k + 1][turn], "length"
            found = {
                "stiffness": cauchy(*pair),
                "stiffness_rms": cauchy(*pair, power=2),
                "axial_stiffness": cauchy(kept[4 * turn + k], kept[4 * turn + k + 1], "length"),
            }
            rows.append(table_row(points, mass, printed, found, stiffness=stiffness, average_mass_g=0.5 / points))
    return rows


def drum_table(program, backend, work, largest, sets):
    """Table 5.3, with springs along edges as in [Shi], and with the biquadratic membrane."""
    meshes = DRUM if largest else DRUM[:-1]
    lists = "meshes=" + ":".join(str(points) for points, _ in meshes) + ",models=edge:biquadratic,masses=equal:area"
    found = study(program, "drum-cone", backend, work / "drum-cone-study", lists, *sets)
    if not found:
        return None
    rows = []
    for first in range(0, len(found), len(meshes)):
        for k, (points, printed) in enumerate(meshes[:-1]):
            row = found[first + k]
            rows.append(
                table_row(
                    points, row["mass"], printed, cauchy(row, found[first + k + 1], "area"),
                    model=row["model"], vertices=row["vertices"], average_mass_g=380.0 / points,
                    energy_at_start=row["series"]["elastic"][0], energy_drift=row["errors"]["energy_drift"],
                )
            )
    return rows


def end_forces(file, membrane, poisson):
    """Rest positions, final positions (m), and vertex forces of St. Venant-Kirchhoff triangles (N), each (n, 3)."""
    import h5py
    import numpy as np

    with h5py.File(file) as h5:
        rest, triangles = h5["mesh/vertices"][...], h5["mesh/triangles"][...]
        now = h5["steps"][max(h5["steps"])]["position"][...]
    sides = rest[triangles[:, 1:]] - rest[triangles[:, :1]]
    inverse = np.linalg.inv(np.swapaxes(sides[:, :, :2], 1, 2))
    gradient = np.swapaxes(now[triangles[:, 1:]] - now[triangles[:, :1]], 1, 2) @ inverse
    strain = 0.5 * (np.swapaxes(gradient, 1, 2) @ gradient - np.eye(2))
    trace = np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(2)
    stress = membrane / (1 - poisson**2) * ((1 - poisson) * strain + poisson * trace)
    area = 0.5 * np.abs(np.linalg.det(sides[:, :, :2]))[:, None, None]
    pulls = -area * gradient @ stress @ np.swapaxes(inverse, 1, 2)
    force = np.zeros_like(now)
    for corner in (0, 1):
        np.add.at(force, triangles[:, corner + 1], pulls[:, :, corner])
        np.add.at(force, triangles[:, 0], -pulls[:, :, corner])
    return rest, now, force


def response(file, membrane, poisson):
    """Apparent moduli and Poisson's ratios of a stretched strip.

    `modulus` is relative to the given one, from the whole reaction force; `modulus_without_a_corner` omits one corner
    node. `poisson` is the contraction of the width over the strain in the middle, `largest_poisson` its maximum along
    the strip, and `widths_from_a_grip` the distance of the maximum from a grip in widths: about 1 for a clamped strip.
    """
    import numpy as np

    rest, now, force = end_forces(file, membrane, poisson)
    moved = now - rest
    length, width = np.ptp(rest[:, 0]), np.ptp(rest[:, 1])
    end = np.flatnonzero(rest[:, 0] > length * (1 - 1e-9))
    strain = moved[end, 0].mean() / length
    pull = -force[end, 0] / (width * strain * membrane)
    along = np.linspace(0.0, length, 201)
    sides = []
    for y in (0.0, width):
        flank = np.flatnonzero(np.abs(rest[:, 1] - y) < 1e-9 * width)
        flank = flank[np.argsort(rest[flank, 0])]
        sides.append(np.interp(along, rest[flank, 0], moved[flank, 1]))
    contraction = (sides[0] - sides[1]) / (width * strain)
    return {
        "modulus": pull.sum(),
        "modulus_without_a_corner": pull.sum() - pull[np.argmax(rest[end, 1])],
        "poisson": contraction[100],
        "largest_poisson": contraction.max(),
        "widths_from_a_grip": min(x := along[contraction.argmax()], length - x) / width,
    }


def strip_table(program, backend, work):
    """Table 5.4, for a strip that is free to contract (correct) and with clamped grips as in [Shi]."""
    rows = []
    for poisson, cases in STRIP:
        for modulus, printed_modulus, printed_poisson in cases:
            membrane = modulus * THICKNESS
            # Statics do not depend on the mass, which is chosen such that the number of steps equals that of the scene.
            sets = [
                f"material.poisson={poisson}", f"material.membrane_modulus={membrane!r}",
                f"material.area_density={1e-4 * membrane!r}", f"mesh.strip.vertices={STRIP_VERTICES}",
            ]
            row = {
                "poisson": poisson,
                "modulus": modulus,
                "dissertation": {"modulus": printed_modulus / modulus, "poisson": printed_poisson},
            }
            for name, more in (("free", []), ("clamped", [GRIPS, "verify={equilibrium=1e-6}"])):
                folder = work / f"strip-{name}"
                done = run(program, "strip", backend, folder, *assignments(*sets, *more))
                if done["exit_code"] != 0:
                    return None
                row[name] = response(folder / "fields.h5", membrane, poisson)
            rows.append(row)
    return rows


def print_markdown(title, header, rows):
    """Prints a Markdown table."""
    print(f"\n{title}\n\n| {' | '.join(header)} |\n|{'---:|' * len(header)}")
    for row in rows:
        print("| " + " | ".join(cell if isinstance(cell, str) else f"{cell:.4g}" for cell in row) + " |")


def print_tables(record):
    """Prints the tables of a record beside the numbers of [Shi]."""

    def triple(values):
        return ", ".join(f"{value:.3g}" for value in values)

    if record["table_5_2"]:
        rows = [(str(r["points"]), r["mass"], triple(r["dissertation"]),
                 *(triple(r["cauchy"][name]) for name in ("stiffness", "stiffness_rms", "axial_stiffness")))
                for r in record["table_5_2"]]
        print_markdown("Table 5.2", ("points", "mass", "[Shi]", "its stiffness", "the same, RMS", "E A kept"), rows)
    for key, title in (("table_5_3", "Table 5.3"), ("table_5_3_small_steps", "Table 5.3, z < 0.1, 2 s")):
        if record.get(key):
            rows = [(str(r["vertices"]), r["model"], r["mass"], triple(r["dissertation"]), triple(r["cauchy"]), r["energy_drift"])
                    for r in record[key]]
            print_markdown(title, ("points", "model", "mass", "[Shi]", "here", "energy drift"), rows)
    if record["table_5_4"]:
        keys = (("dissertation", "modulus"), ("clamped", "modulus_without_a_corner"), ("clamped", "modulus"), ("free", "modulus"),
                ("dissertation", "poisson"), ("clamped", "largest_poisson"), ("clamped", "poisson"), ("free", "poisson"))
        rows = [(f"{r['poisson']:.2f}", f"{r['modulus'] / 1e9:.1f}", *(f"{r[a][b]:.5f}" for a, b in keys)) for r in record["table_5_4"]]
        print_markdown("Table 5.4", ("nu", "E (GPa)", *(f"{a} {b.replace('_', ' ')}" for a, b in keys)), rows)


def main():
    options = argument_parser(__doc__)
    options.add_argument("--exact", type=pathlib.Path)
    options.add_argument("--tables")
    options.add_argument("--largest", action="store_true")
    options.add_argument("--small-steps", action="store_true")
    arguments = options.parse_args()
    program = arguments.bin / "drogue-springs"
    backends, work = arguments.backends.split(","), arguments.work
    tables_backend = arguments.tables or backends[-1]
    record = {"schema": "drogue.record/1", "machine": arguments.machine} | scene_runs(program, backends, work)
    failed = [r for r in record["runs"] if r["exit_code"] != 0]
    if arguments.exact:
        record["exact"] = exact_rows(arguments.exact / "drogue-springs", backends, work)
        failed += [row for row in record["exact"] if not row["identical"]]
    record["table_5_2"] = chord_table(program, tables_backend, work)
    record["table_5_3"] = drum_table(program, tables_backend, work, arguments.largest, until(END_TIME))
    if arguments.small_steps:
        sets = [*until(LONG_END_TIME), SMALL_STEP]
        record["table_5_3_small_steps"] = drum_table(program, tables_backend, work, arguments.largest, sets)
    record["table_5_4"] = strip_table(program, tables_backend, work)
    failed += [{"table": name} for name in record if name.startswith("table") and record[name] is None]
    print_tables(record)
    return write_record(record, arguments.to / f"springs-{arguments.machine}.json", failed, ("exact",))


if __name__ == "__main__":
    sys.exit(main())
