#!/usr/bin/env python3
"""Fits the constants of `error_factor` in kernels/options/pide/error_estimate.hpp to runs of drogue-options.

    scripts/studies/fit_error_estimate.py [--program build/host/bin/drogue-options] [--rows 200] [--covered 0.95] [--seed 1] [--backend auto]

Each constant is fitted on a grid on which its term is the largest of the estimate, to European options of random contracts, as
scripts/studies/measure_coverage.py draws them, against Fourier's integral. The stated error is then proportional to the constant, but for
the terms that do not depend on the difference of the grids, which are part of both. So the constant that covers a part of the
rows is the present one times that quantile of true over stated error. Where the fit is below the present constant, more
than that part is covered. All models share the constants, so the largest fit of a line counts.
"""

import argparse
import csv
import random
import tempfile
from pathlib import Path

import measure_coverage
from measure_coverage import MODELS, REFERENCE

# Constant, its present value, and a grid on which its term decides: few steps on a fine mesh for errors in time, many steps on
# a coarse mesh for errors in space. 6.5/steps is below 0.5 from 14 steps on.
TERMS = (("few steps", 0.5, 1024, 8), ("1/steps", 6.5, 2048, 64), ("root of y", 0.45, 64, 2048))


def quantile(values, part):
    """The value that `part` of the values, at least one, do not exceed; between two of them, interpolated linearly."""
    ordered = sorted(values)
    place = part * (len(ordered) - 1)
    below = int(place)
    return ordered[below] + (place - below) * (ordered[min(below + 1, len(ordered) - 1)] - ordered[below])


def ratios(found, known):
    """True over stated errors of the rows that both runs price, and whose reference is ten times as accurate as stated."""
    pairs = [(row, reference) for row, reference in zip(found, known, strict=True) if row["error"] and reference["error"]]
    return [abs(float(row["price"]) - float(reference["price"])) / float(row["error"]) for row, reference in pairs
            if 10.0 * float(reference["error"]) <= float(row["error"])]


def of_model(arguments, model, folder):
    """Ratios of one model for each of TERMS, on the same contracts."""
    draw = random.Random(f"{arguments.seed} {model} fit")
    batch = folder / "batch.csv"
    with batch.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, measure_coverage.COLUMNS)
        writer.writeheader()
        writer.writerows({"id": i} | measure_coverage.random_contract(draw, model, "european") for i in range(arguments.rows))

    def prices(*words):
        return measure_coverage.prices(arguments.program, batch, folder, [*words, "--backend", arguments.backend])

    known = prices(*REFERENCE["european"])
    return [ratios(prices("--mesh", str(mesh), "--steps", str(steps)), known) for _, _, mesh, steps in TERMS]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=measure_coverage.ROOT / "build/host/bin/drogue-options")
    parser.add_argument("--rows", type=int, default=200, help="contracts per model")
    parser.add_argument("--covered", type=float, default=0.95, help="part of the rows whose stated error is to cover the true one")
    parser.add_argument("--seed", type=int, default=1, help="of the random contracts")
    parser.add_argument("--backend", default="auto")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        of_models = [of_model(arguments, model, Path(folder)) for model in MODELS]
    print(f"{'term':10} {'grid':>10} {'present':>8} " + " ".join(f"{model:>13}" for model in MODELS) + f" {'largest':>8}")
    for i, (name, present, mesh, steps) in enumerate(TERMS):
        fits = [present * quantile(of_one[i], arguments.covered) if of_one[i] else float("nan") for of_one in of_models]
        print(f"{name:10} {f'{mesh}x{steps}':>10} {present:8.3g} " + " ".join(f"{fit:13.3g}" for fit in fits)
              + f" {max(fits):8.3g}")


if __name__ == "__main__":
    main()
