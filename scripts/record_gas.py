#!/usr/bin/env python3
"""Writes docs/evidence/gas-<machine>.json, the record of drogue-gas on this machine, from its result files.

    scripts/record_gas.py MACHINE --bin build/cuda/bin [--exact build/cuda-exact/bin] [--backends serial,openmp,cuda]
                          [--largest] [--long] [--work FOLDER]

The record holds every shipped scene on every backend (error, tolerance, steps, time, limiter), and the
scheme of [Shi] (--seed-mode) on the meshes of its Table 5.5. Further parts:

    --exact     bitwise comparison of the datasets of all scenes between backends; needs h5py
    --largest   a run of 2^28 cells
    --long      runs of many steps in a closed box, each run twice: conservation, and bitwise equality; needs h5py

Prints a summary. The exit code is 1 if any run failed.
"""

import pathlib
import sys

from recording import (
    argument_parser, assignments, differing_datasets, exact_rows, run, scene_runs, summary, write_record,
)

BASELINE_MESHES = (1024, 2048, 3072, 4096, 5120, 6144, 7168, 8192)
LONG_RUNS = ((1024, 1_000_000), (2**24, 10_000))  # cells, steps


def baseline_rows(program, backend, work):
    """Times of the three phases of a step, us per step, over 200 steps on each mesh."""
    rows = []
    for cells in BASELINE_MESHES:
        end_time = 200 * 0.6 * 2.0 / cells / 2.2
        # The error after 208 steps is 1.2986/cells on every mesh.
        sets = assignments(f"mesh.cells={cells}", f"run.end_time={end_time}", f"output.times=[{end_time}]",
                           f"verify.l1_density={1.36 / cells}", "output.history_every=0")
        result = run(program, "sod", backend, work / f"seed-{cells}", "--seed-mode", *sets)
        steps, timing = result.get("steps", 0), result.get("timing", {})
        if result["exit_code"] != 0 or steps == 0:
            rows.append({"cells": cells, "exit_code": result["exit_code"], "message": result["message"]})
            continue
        phases = {name: 1e6 * timing[f"{name}_s"] / steps for name in ("h2d", "compute", "d2h")}
        rows.append({"cells": cells, "steps": steps, "exit_code": 0} | {f"{k}_us": v for k, v in phases.items()})
    return rows


def long_rows(program, backend, work, largest):
    """Runs of Sod's problem between walls at about half the largest stable time step.

    Checks conservation, and bitwise equality of two runs.
    """
    rows = []
    for cells, steps in LONG_RUNS if largest else LONG_RUNS[:1]:
        dt = 0.4 * 2.0 / cells / 2.2
        end_time = steps * dt
        folders = [work / f"long-{cells}-{turn}" for turn in (1, 2)]
        # The exact solution has no walls; 10^6 steps change the sums by 2.3e-13.
        sets = assignments(
            f"mesh.cells={cells}", f"scheme.fixed_dt={dt}", f"run.end_time={end_time}", "run.max_steps=2000000",
            'boundary.left="reflecting"', 'boundary.right="reflecting"', f"output.times=[{end_time}]",
            "output.history_every=0", "verify={conservation=1e-12}")
        results = [run(program, "sod", backend, folder, *sets) for folder in folders]
        same = not any(r["exit_code"] for r in results) and not differing_datasets(*(folder / "fields.h5" for folder in folders))
        rows.append(summary(results[0]) | {"cells": cells, "identical": same})
    return rows


def main():
    options = argument_parser(__doc__)
    options.add_argument("--exact", type=pathlib.Path)
    options.add_argument("--largest", action="store_true")
    options.add_argument("--long", action="store_true")
    arguments = options.parse_args()
    program = arguments.bin / "drogue-gas"
    backends = arguments.backends.split(",")
    work = arguments.work

    record = {"schema": "drogue.record/1", "machine": arguments.machine} | scene_runs(program, backends, work)
    record["seed_mode"] = baseline_rows(program, backends[-1], work)
    failed = [r for r in record["runs"] + record["seed_mode"] if r["exit_code"] != 0]
    if arguments.exact:
        record["exact"] = exact_rows(arguments.exact / "drogue-gas", backends, work)
        failed += [row for row in record["exact"] if not row["identical"]]
    if arguments.largest:
        sets = assignments(f"mesh.cells={2**28}", "run.end_time=1e-9", "output.times=[1e-9]", 'output.fields=["rho"]')
        result = run(program, "sod", backends[-1], work / "largest", *sets)
        bytes_a_cell = result.get("peak_bytes", {}).get("device", 0) / 2**28
        record["largest"] = summary(result) | {"device_bytes_a_cell": bytes_a_cell}
        failed += [record["largest"]] if result["exit_code"] != 0 else []
    if arguments.long:
        record["long"] = long_rows(program, backends[-1], work, arguments.largest)
        failed += [row for row in record["long"] if not row["identical"]]
    return write_record(record, arguments.to / f"gas-{arguments.machine}.json", failed, ("seed_mode", "exact", "largest", "long"))


if __name__ == "__main__":
    sys.exit(main())
