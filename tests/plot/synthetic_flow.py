"""Synthetic run directories of drogue-parachute."""

import csv

import h5py
import numpy as np

UNITS = {"velocity": "m/s", "pressure": "Pa", "vorticity": "1/s", "q_criterion": "1/s^2"}
SCENE = """app = "parachute"
[grid]
cells = [{cells}]
domain = [{domain}]
boundary = {{ x = {x}, y = "periodic", z = "periodic" }}
[flow]
body_force = [0.0, 0.0, 0.0]
"""
HISTORY = (
    "time [s],step,dt [s],kinetic_energy [J],dissipation [W],max_speed [m/s],divergence_rms [1/s],divergence_max [1/s],"
    "outflow_x_low [m^3/s],outflow_x_high [m^3/s]"
)


def centres(cells, lengths):
    """Cell centres (nx, ny, nz) along each axis of a box from the origin."""
    axes = [(np.arange(count) + 0.5) * length / count for count, length in zip(cells, lengths)]
    return np.meshgrid(*axes, indexing="ij")


def growing_faces(count, length, growth):
    """Faces of cells each `growth` times as wide as the one before."""
    widths = growth ** np.arange(count)
    return np.concatenate(([0.0], np.cumsum(widths) * length / widths.sum()))


def write_flow(folder, cells, lengths, fields_at, times=(0.0,), is_open=False, growth=1.0):
    """Writes a run directory; fields_at(time, x, y, z) gives the fields by name. Returns its path."""
    folder.mkdir(parents=True, exist_ok=True)
    domain = ", ".join(f"[0.0, {length}]" for length in lengths)
    sides = '["inflow", "outflow"]' if is_open else '"periodic"'
    (folder / "scene.toml").write_text(SCENE.format(cells=", ".join(map(str, cells)), domain=domain, x=sides))
    rows = [f"{0.5 * k},{k},0.5,{4.0 - k * k},{1.0 + k},2,{(k > 0) * 1e-15},{k * 1e-14},-1,1" for k in range(3)]
    header, rows = (HISTORY, rows) if is_open else (
        HISTORY.rsplit(",", 2)[0], [row.rsplit(",", 2)[0] for row in rows]
    )
    (folder / "history.csv").write_text("\n".join([header, *rows]) + "\n")
    with h5py.File(folder / "fields.h5", "w") as h5:
        faces = [np.linspace(0, length, count + 1) if growth == 1 else growing_faces(count, length, growth)
                 for count, length in zip(cells, lengths)]
        places = centres(cells, lengths) if growth == 1 else np.meshgrid(*((f[1:] + f[:-1]) / 2 for f in faces), indexing="ij")
        for axis, values in zip("xyz", faces):
            h5[f"mesh/{axis}"] = values
        for k, time in enumerate(times):
            group = h5.create_group(f"steps/{k:06d}")
            group.attrs["time"] = time
            for name, values in fields_at(time, *places).items():
                group[name] = values
                group[name].attrs["units"] = UNITS[name]
    return folder


def write_flow_study(file):
    """Writes study.csv of two schemes on three meshes, with errors of order 2 and 3; returns its path."""
    header = ["label", "advection", "time_scheme", "pressure", "backend", "cells", "steps", "compute_s", "l1_velocity",
              "l2_velocity", "linf_velocity", "l2_pressure", "order_l2_velocity", "order_l2_pressure", "divergence",
              "status"]
    with file.open("w", newline="") as stream:
        table = csv.writer(stream)
        table.writerow(header)
        for advection, time, order in (("central", "ab2", 2), ("weno-z", "rk3", 3)):
            for cells in (16, 32, 64):
                error = cells**-order
                table.writerow(
                    [f"{advection} {time}", advection, time, "auto", "serial", cells, cells, 1e-6 * cells**3, 2 * error,
                     error, 3 * error, "", order, "", 1e-15, "ok"]
                )
    return file
