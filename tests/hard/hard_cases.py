"""Rows of tolerances.csv and failures.csv, and the scene assignments of each row."""

import csv
import pathlib

import gas_program

FOLDER = pathlib.Path(__file__).parent


def rows(name):
    with (FOLDER / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def scheme_sets(scheme):
    """Assignments of a scheme name: js, z1, z2, teno5. Only Z has a power."""
    if scheme.startswith("z"):
        return ['scheme.weno="z"', f"scheme.weno_power={scheme[1:]}"]
    return [f'scheme.weno="{scheme}"']


def row_sets(row):
    """Assignments of the scheme and mesh of a row, without verification."""
    sets = scheme_sets(row["scheme"]) + [f"mesh.cells={row['N']}", f"scheme.cfl={row['cfl']}"]
    if "limiter" in row:
        sets += [f'scheme.positivity="{row["limiter"]}"', f'scheme.splitting="{row["splitting"]}"']
    return sets


def label(row):
    return " ".join(row.get(key, "") for key in ("case", "scheme", "N", "splitting", "reference")).strip()


def tolerance_sets(row):
    """`row_sets` and the tolerance: 5 % above the error, or 2 % around the largest density."""
    tolerance = float(row["tolerance"])
    if row["quantity"] == "max_density":
        return row_sets(row) + [f"verify.max_density.value={tolerance}", "verify.max_density.tolerance=0.02"]
    return row_sets(row) + [f"verify.{row['quantity']}={1.05 * tolerance!r}"]


def unverified(test, case):
    """Shipped scene without [verify], to avoid its reference run, and with at most one output."""
    text = (gas_program.SOURCE / f"miniapps/gas/scenes/{case}.toml").read_text(encoding="utf-8")
    return test.write(text[:text.index("[output]")] + "[verify]\nconservation = 1e-12\n", f"{case}.toml")
