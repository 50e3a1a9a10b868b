"""Demo of drogue-options: a shipped batch by two independent methods, a surface, and exercise boundaries."""

import csv
import json
import subprocess
from pathlib import Path

from ..failure import IO_ERROR, OK, Failure

BATCH, PARAMETERS = "example", "example_surface"
# In the source tree, where the demo runs.
SHIPPED = Path(__file__).resolve().parents[3] / "miniapps/options/batches"
STRIKES, MATURITIES = "60:140:33", "0.1,0.25,0.5,1,2"
TOLERANCE = 1e-4  # of the strike, the default of drogue-options


def _rows(file: Path) -> dict[str, dict[str, str]]:
    with file.open(newline="", encoding="utf-8") as stream:
        return {row["id"]: row for row in csv.DictReader(stream)}


def largest_difference(prices: Path, others: Path, batch: Path) -> float:
    """Largest difference between the prices of two files, relative to the strike."""
    strikes = {name: float(row["strike"]) for name, row in _rows(batch).items()}
    one, other = _rows(prices), _rows(others)
    return max(abs(float(one[name]["price"]) - float(other[name]["price"])) / strikes[name] for name in strikes)


def run_batch(program: Path, run) -> None:
    """Prices the batch by both methods and stores result, check and exit code in `run`.

    Raises Failure (IO_ERROR) if the prices cannot be compared.
    """
    run.command = f"drogue-options price {BATCH}"
    folder = run.directory
    folder.mkdir(parents=True, exist_ok=True)
    price = [program, "price", BATCH, "--quiet"]
    commands = [
        [*price, "--greeks", "--out", folder / "prices.csv", "--boundary", folder / "boundary.csv",
         "--result", folder / "result.json"],
        [*price, "--method", "cos", "--out", folder / "cos.csv"],
        [program, "surface", PARAMETERS, "--quiet", "--strikes", STRIKES, "--maturities", MATURITIES,
         "--out", folder / "surface.csv"],
    ]
    for command in commands:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
        if done.returncode != OK:
            run.exit_code, run.message = done.returncode, done.stderr.strip()
            return
    file = folder / "result.json"
    run.result = json.loads(file.read_text())
    try:
        difference = largest_difference(folder / "prices.csv", folder / "cos.csv", SHIPPED / f"{BATCH}.csv")
    except (KeyError, ValueError) as error:
        raise Failure(IO_ERROR, f"the prices in {folder} cannot be compared: {error}.") from None
    passed = difference <= TOLERANCE
    run.result["checks"] = [{"name": "cos_difference", "value": difference, "tolerance": TOLERANCE, "passed": passed}]
    run.result["steps"] = run.result.get("counts", {}).get("rows")
    file.write_text(json.dumps(run.result, indent=2) + "\n")
    if not passed:
        run.exit_code, run.message = (5, f"cos_difference is {difference:.3g}, above its tolerance {TOLERANCE:g}.")
