"""Synthetic run directories for the tests of the pictures: exact solutions with a known disturbance."""

import csv
import itertools
import json

import h5py
import numpy as np

from plot.gas.riemann import State, sample

UNITS = {"rho": "kg/m^3", "u": "m/s", "p": "Pa"}
SOD = (State(1.0, 0.0, 1.0), State(0.125, 0.0, 0.1))
SOD_SCENE = """app = "gas"
[gas]
gamma = 1.4
[mesh]
cells = {cells}
domain = [-1.0, 1.0]
[initial]
riemann = {{ x0 = 0.0, left = {{ rho = 1.0, u = 0.0, p = 1.0 }}, right = {{ rho = 0.125, u = 0.0, p = 0.1 }} }}
[boundary]
left = "outflow"
right = "outflow"
[scheme]
weno = "z"
[run]
end_time = 0.4
[verify]
exact = "riemann"
l1_density = 6.5e-3
"""


def sod(time, x):
    """Exact density, velocity and pressure of Sod's problem."""
    return sample(x / max(time, 1e-12), *SOD, 1.4)


def write_fields(file, x, times, values_at, reference=None):
    """`fields.h5` of a gas run; values_at(time, x) gives density, velocity, pressure."""
    with h5py.File(file, "w") as h5:
        dataset = h5.create_dataset("mesh/x", data=x)
        dataset.attrs.update(units="m", centering="cell", description="cell centres")
        for index, time in enumerate(times):
            group = h5.create_group(f"steps/{index:06d}")
            group.attrs["time"] = time
            for (name, units), values in zip(UNITS.items(), values_at(time, x)):
                dataset = group.create_dataset(name, data=values)
                dataset.attrs.update(units=units, centering="cell", description=name)
        if reference:
            group = h5.create_group("reference")
            group.attrs.update(scheme=reference["scheme"], cells=reference["cells"])
            group.create_dataset("x", data=reference["x"])
            for name in UNITS:
                group.create_dataset(name, data=reference[name])


def smeared_sod(time, x):
    """Sod's solution like that of a scheme: jumps smeared over a few cells, and seeded noise of 1e-6."""
    rng = np.random.default_rng(4)
    dx = x[1] - x[0]
    offsets = np.linspace(-1.0, 1.0, 9) * 1.5 * dx
    smeared = [np.mean(values, axis=0) for values in zip(*(sod(time, x + offset) for offset in offsets))]
    return [values * (1 + 1e-6 * rng.standard_normal(len(x))) for values in smeared]


HISTORY_HEADER = (
    "time [s],step,dt [s],mass [kg/m^2],momentum [kg/(m s)],energy [J/m^2],mass_outflow [kg/m^2],"
    "momentum_outflow [kg/(m s)],energy_outflow [J/m^2],max_speed [m/s],limiter_touches,redone_steps"
)


def write_history(file, rows=120):
    """Writes history.csv of a shock tube: momentum enters through the ends, mass and energy drift by round-off."""
    with file.open("w", newline="") as stream:
        stream.write(HISTORY_HEADER + "\n")
        for row in range(rows):
            time = 0.4 * row / (rows - 1)
            dt = 0.0025 * min(1, 0.1 + 0.045 * row)
            drift = 1e-15 * np.sin(7 * row)
            totals = [1.125 + drift, 0.9 * time, 2.75 * (1 + 3 * drift), 0.0, -0.9 * time, 0.0]
            csv.writer(stream).writerow([time, row, dt, *totals, 2.2, 0, 0])


def write_sod(directory, cells=200, snapshots=20):
    """A complete run directory of Sod's problem; returns its path."""
    directory.mkdir(parents=True, exist_ok=True)
    x = -1 + (np.arange(cells) + 0.5) * 2 / cells
    write_fields(directory / "fields.h5", x, np.linspace(0, 0.4, snapshots + 1)[1:], smeared_sod)
    (directory / "scene.toml").write_text(SOD_SCENE.format(cells=cells))
    checks = [{"name": "l1_density", "value": 4.93e-3, "tolerance": 6.5e-3, "passed": True}]
    errors = {"l1_density": 4.93e-3, "l1_velocity": 8.2e-3, "l1_pressure": 3.6e-3}
    (directory / "result.json").write_text(json.dumps({"status": "ok", "checks": checks, "errors": errors}))
    write_history(directory / "history.csv")
    return directory


def write_study(file, meshes=(100, 200, 400, 800), failed=0, settings=("",)):
    """Writes study.csv of three schemes of order 0.9 in all settings, whose last `failed` rows are failures."""
    header = (
        "label,weno,weno_power,splitting,time_scheme,precision,backend,cells,steps,compute_s,l1_density,l1_velocity,"
        "l1_pressure,conservation,status"
    )
    rows = []
    for label, weno, error, cost in (
        ("js", "js", 1.23e-2, 1.0),
        ("z", "z", 1.01e-2, 1.1),
        ("teno5", "teno5", 9.6e-3, 1.3),
    ):
        for setting, cells in itertools.product(settings, meshes):
            value = error * (100 / cells) ** 0.9
            seconds = cost * 2e-3 * (cells / 100) ** 2
            rows.append(
                [label + setting, weno, 1, "lf-stencil", "ssprk3", "double", "serial", cells, 2 * cells, seconds, value,
                 2 * value, value, 1e-15, "ok"]
            )
    for row in rows[len(rows) - failed :]:
        row[-1] = "numerical-failure"
    with file.open("w", newline="") as stream:
        stream.write(header + "\n")
        csv.writer(stream).writerows(rows)
    return file


def write_springs_study(file, order=2.0, checks=("frequency", "equilibrium")):
    """Writes study.csv of a disk on four meshes with the given order in the edge length."""
    header = ["label", "model", "mass", "integrator", "backend", "vertices", "steps", "compute_s", *checks,
              "cauchy_area", "cauchy_elastic", "cauchy_kinetic", "status"]
    with file.open("w", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(header)
        for rings in (4, 8, 16, 32):
            vertices = 1 + 3 * rings * (rings + 1)
            error = 0.3 * vertices ** (-order / 2)
            cauchy = ["", "", ""] if rings == 32 else [error, 2 * error, 3 * error]
            table.writerow(
                [
                    "biquadratic", "biquadratic", "area", "rk4", "serial", vertices, 100 * rings, 1e-3 * rings**3,
                    *[error, 1e-9][: len(checks)], *cauchy, "ok",
                ]
            )
    return file
