#!/usr/bin/env python3
"""Runs a scene of drogue-parachute with a body on several grids and prints what its [[verify.history]] measures.

    scripts/studies/measure_drag.py SCENE --ratio 1,1.5,2 [--bin build/host/bin] [--out out/drag] [-- ARGUMENT...]

--ratio: numbers of cells along each axis over those of the scene; axes of one cell keep it. Edges of bodies and max_dt
shrink with the cells. The last two grids give the value for infinitely many cells, if the error is of first order.
ARGUMENTs go to the program, such as `--backend serial --set run.end_time=100`.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from recording import parse_with_arguments, run_parachute  # noqa: E402


def settings(scene, ratio):
    """Assignments of the scene on a grid with `ratio` times the cells along each axis."""
    cells = [n if n == 1 else round(ratio * n) for n in scene["grid"]["cells"]]
    bodies = [{**body, "edge_length": body["edge_length"] / ratio} for body in scene["body"]]
    values = {"grid.cells": cells, "body": bodies, "run.max_dt": scene["run"]["max_dt"] / ratio}
    # With = for the colons of JSON its text is TOML.
    return [f"{key}={json.dumps(value, separators=(', ', ' = '))}" for key, value in values.items()]


def refuse(scene, ratios):
    """Ends the program with a sentence if the scene cannot be run on grids of these ratios."""
    if "max_dt" not in scene["run"] or not scene.get("verify", {}).get("history"):
        sys.exit("measure_drag.py: the scene needs run.max_dt and a [[verify.history]].")
    for ratio in ratios:
        for n in scene["grid"]["cells"]:
            if n > 1 and (ratio <= 0 or ratio * n != round(ratio * n)):
                sys.exit(f"measure_drag.py: --ratio {ratio:g} makes {ratio * n:g} of {n} cells: choose a whole number.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("--ratio", required=True, type=lambda text: [float(part) for part in text.split(",")])
    options, arguments = parse_with_arguments(parser, "out/drag")
    printed = subprocess.run([options.bin / "drogue-parachute", options.scene, "--print-scene"], capture_output=True, text=True, check=True)
    scene = tomllib.loads(printed.stdout)
    refuse(scene, options.ratio)
    rows = []
    for ratio in options.ratio:
        # A check may fail: its value is the point.
        out = run_parachute(options, options.scene, f"{pathlib.Path(options.scene).stem}-{ratio:g}", settings(scene, ratio), arguments, (0, 5))
        checks = json.loads((out / "result.json").read_text(encoding="utf-8"))["checks"]
        rows.append((ratio, {check["name"]: check["measured"] for check in checks if "measured" in check}))
        print(f"ratio {ratio:g}:", ", ".join(f"{name} {value:.4f}" for name, value in rows[-1][1].items()), flush=True)
    if len(rows) > 1:
        (coarse, of_coarse), (fine, of_fine) = rows[-2:]
        limits = {name: (fine * of_fine[name] - coarse * of_coarse[name]) / (fine - coarse) for name in of_fine}
        print("extrapolated:", ", ".join(f"{name} {value:.4f}" for name, value in limits.items()))


if __name__ == "__main__":
    main()
