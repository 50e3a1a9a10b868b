#!/usr/bin/env python3
"""Measures how often the stated error of drogue-options covers the true one, on random contracts of every model.

    scripts/studies/measure_coverage.py [--program build/host/bin/drogue-options] [--rows 100] [--tolerance 1e-4,1e-5]
                                        [--mesh M --steps N] [--models gh,kou] [--styles european] [--reference M N] [--seed 1]
                                        [--backend auto] [--out FILE]

For a new fit of the constants in kernels/options/pide/error_estimate.hpp. The prices are those of finite differences, to each
of the tolerances or on a given grid. References: for European options Fourier's integral (`--method cos`), which shares no part
of the method; for American options finite differences on 2048 intervals with 1024 steps, or on the grid of `--reference`. A row is
undecided, and not counted, if one of both has no price, or the reference states an error above a tenth of the stated error to
be tested. The table has, per model, style and tolerance: rows counted; the part that is covered; the quotient of stated and
true error below which a tenth and half of the rows are; undecided rows. The median quotient is the overestimate. Rows of pure
jumps are also counted by themselves.
"""

import argparse
import csv
import json
import math
import random
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PURE = "gh, pure jumps"
MODELS = ("gh", "black-scholes", "merton", "kou")
STYLES = ("european", "american")
REFERENCE = {"european": ["--method", "cos", "--tolerance", "1e-10"], "american": ["--mesh", "2048", "--steps", "1024"]}
COLUMNS = ("id", "style", "model", "spot", "strike", "rate", "dividend", "maturity", "variance", "lambda", "alpha", "beta",
           "delta", "intensity", "jump_mean", "jump_deviation", "up_probability", "up_rate", "down_rate")
HOUR, LONGEST = 1.0 / 8760, 30.0  # years


def between(draw, low, high):
    """A number with a uniformly distributed logarithm."""
    return math.exp(draw.uniform(math.log(low), math.log(high)))


def jumps(draw, model):
    """Random parameters of the jumps of a model."""
    if model == "gh":
        alpha = between(draw, 3.0, 50.0)
        return {"lambda": draw.uniform(-3.0, 3.0), "alpha": alpha, "delta": between(draw, 0.02, 1.0),
                "beta": draw.uniform(-0.9 * alpha, 0.9 * (alpha - 1.0))}
    if model == "merton":
        return {"intensity": between(draw, 0.05, 20.0), "jump_mean": draw.uniform(-0.3, 0.2),
                "jump_deviation": between(draw, 0.02, 0.4)}
    if model == "kou":
        return {"intensity": between(draw, 0.05, 20.0), "up_probability": draw.random(),
                "up_rate": between(draw, 3.0, 60.0), "down_rate": between(draw, 3.0, 60.0)}
    return {}


def random_contract(draw, model, style):
    """A put of strike 1 near the money: a row of a batch, without its id."""
    maturity = between(draw, HOUR, LONGEST)
    variance = between(draw, 0.003, 0.15)
    # A third of the generalized hyperbolic processes consists of jumps only.
    pure = model == "gh" and draw.random() < 1.0 / 3
    spot = math.exp(draw.uniform(-1.5, 1.5) * math.sqrt(variance * min(maturity, 2.0)))
    return {"style": style, "model": model, "spot": spot, "strike": 1.0, "rate": draw.uniform(0.0, 0.09),
            "dividend": draw.uniform(0.0, 0.06), "maturity": maturity, "variance": 0.0 if pure else variance,
            **jumps(draw, model)}


def prices(program, batch, folder, words):
    """Rows of the output of `drogue-options price` in the order of the batch; ends the script if there are none."""
    out = folder / "prices.csv"
    done = subprocess.run([program, "price", batch, "--out", out, "--quiet", *words], capture_output=True, text=True, check=False)
    # 4: some rows have no price.
    if done.returncode not in (0, 4):
        sys.exit(f"{program}: exit code {done.returncode}: {done.stderr.strip()}")
    with out.open(newline="", encoding="utf-8") as rows:
        return list(csv.DictReader(rows))


def coverage(found, known):
    """Counts and quotients of stated and true errors, of rows with prices and errors in the order of both lists."""
    quotients, undecided = [], 0
    for row, reference in zip(found, known, strict=True):
        if not row["error"] or not reference["error"] or 10.0 * float(reference["error"]) > float(row["error"]):
            undecided += 1
            continue
        true = abs(float(row["price"]) - float(reference["price"]))
        quotients.append(float(row["error"]) / max(true, 1e-300))
    quotients.sort()
    counted = len(quotients)
    return {"rows": counted, "undecided": undecided,
            "covered": sum(quotient >= 1.0 for quotient in quotients) / counted if counted else None,
            "tenth": quotients[counted // 10] if counted else None,
            "median": statistics.median(quotients) if counted else None}


def measure(program, arguments, model, style):
    """Yields the coverage of random contracts of one model and style, per tolerance. The same seed gives the same contracts."""
    draw = random.Random(f"{arguments.seed} {model} {style}")
    contracts = [random_contract(draw, model, style) for _ in range(arguments.rows)]
    pure = [k for k, contract in enumerate(contracts) if contract["variance"] == 0.0]
    grid = ["--mesh", str(arguments.mesh), "--steps", str(arguments.steps)] if arguments.mesh else []
    reference = REFERENCE[style]
    if style == "american" and arguments.reference:
        reference = ["--mesh", str(arguments.reference[0]), "--steps", str(arguments.reference[1])]
    backend = ["--backend", arguments.backend]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        batch = folder / "batch.csv"
        with batch.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows({"id": i} | contract for i, contract in enumerate(contracts))
        known = prices(program, batch, folder, [*reference, *backend])
        for tolerance in [None] if grid else arguments.tolerance:
            found = prices(program, batch, folder, [*(grid or ["--tolerance", str(tolerance)]), *backend])
            kind = {"style": style, "tolerance": tolerance}
            yield {"model": model} | kind | coverage(found, known)
            if pure:
                yield {"model": PURE} | kind | coverage([found[k] for k in pure], [known[k] for k in pure])


def line(result):
    """One row of the table."""
    numbers = ["-" if result[key] is None else f"{result[key]:.3g}" for key in ("covered", "tenth", "median")]
    tolerance = "-" if result["tolerance"] is None else f"{result['tolerance']:g}"
    return f"{result['model']:14} {result['style']:9} {tolerance:>9} {result['rows']:6} {numbers[0]:>8} {numbers[1]:>8} {numbers[2]:>8} {result['undecided']:10}"


def chosen(names, valid):
    """The names of a comma-separated list, all of which are valid."""
    unknown = [name for name in names.split(",") if name not in valid]
    if unknown:
        raise argparse.ArgumentTypeError(f"unknown name '{unknown[0]}': valid names are {', '.join(valid)}")
    return names.split(",")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/host/bin/drogue-options")
    parser.add_argument("--rows", type=int, default=100, help="contracts per model and style")
    parser.add_argument("--tolerance", type=lambda text: [float(word) for word in text.split(",")], default=[1e-4],
                        help="of the prices under test, as a fraction of the strike")
    parser.add_argument("--mesh", type=int, help="intervals of the prices under test; with --steps, instead of a tolerance")
    parser.add_argument("--steps", type=int)
    parser.add_argument("--models", type=lambda names: chosen(names, MODELS), default=MODELS)
    parser.add_argument("--styles", type=lambda names: chosen(names, STYLES), default=STYLES)
    parser.add_argument("--reference", type=int, nargs=2, metavar=("MESH", "STEPS"), help="grid of the American references")
    parser.add_argument("--seed", type=int, default=1, help="of the random contracts")
    parser.add_argument("--backend", default="auto")
    parser.add_argument("--out", type=Path, help="JSON file for the table and the arguments")
    arguments = parser.parse_args()
    if (arguments.mesh is None) != (arguments.steps is None):
        parser.error("--mesh and --steps belong together")
    print(f"{'model':14} {'style':9} {'tolerance':>9} {'rows':>6} {'covered':>8} {'tenth':>8} {'median':>8} {'undecided':>10}")
    results = []
    for style in arguments.styles:
        for model in arguments.models:
            for result in measure(arguments.program, arguments, model, style):
                results.append(result)
                print(line(result), flush=True)
    if arguments.out:
        record = {"arguments": vars(arguments) | {"program": str(arguments.program), "out": str(arguments.out)}, "table": results}
        arguments.out.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
