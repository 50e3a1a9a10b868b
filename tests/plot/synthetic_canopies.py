"""Synthetic run directories of drogue-parachute with canopies and bodies."""

import h5py
import numpy as np
from synthetic_flow import centres

SCENE = """app = "parachute"
[fluid]
density = 1.5
velocity = [0.0, {side_velocity}, 4.0]
[grid]
cells = [6, 6, 10]
domain = [[-3.0, 3.0], [-3.0, 3.0], [-4.0, 6.0]]
boundary = {{ x = "slip", y = "slip", z = ["inflow", "outflow"] }}
{canopies}
[verify]
history = [
  {{ column = "canopy_0_drag_coefficient", statistic = "mean", from = 1.0, to = 2.0, reference = 1.0, value = 0.5, tolerance = 0.2 }},
  {{ column = "canopy_0_airspeed", statistic = "mean", from = 1.0, to = 2.0, reference = 1.0, value = 3.0, tolerance = 0.1 }},
]
peak_force = [{{ canopy = 0, force = [40.0, 80.0], time = [0.5, 1.5] }}]
"""
CANOPY = """[[canopy]]
kind = "flat-circular"
diameter = 2.0
"""
LOW, HIGH = (-3.0, -3.0, -4.0), (3.0, 3.0, 6.0)
CELLS = (6, 6, 10)
GORES = 8


def tent(bulge):
    """Vertices of a cone with its tip at (0, 0, bulge), a skirt of radius 1 at z = 0, and a payload at z = -2."""
    angle = 2 * np.pi * (np.arange(GORES) + 0.5) / GORES
    skirt = np.stack((np.cos(angle), np.sin(angle), 0 * angle), axis=1)
    return np.concatenate(([[0, 0, bulge]], skirt, [[0, 0, -2.0]]))


def write_history(file, columns):
    """Writes history.csv of columns, each a list of values by its header."""
    rows = zip(*columns.values())
    file.write_text("\n".join([",".join(columns), *(",".join(map(str, row)) for row in rows)]) + "\n")


def canopy_columns(index, payload_speed=0.0):
    """Columns of a canopy at 0, 1 and 2 s; the air pulls with 0, 50 and 25 N along z."""
    name = f"canopy_{index}_"
    zero = [0.0] * 3
    return {
        name + "force_x [N]": zero, name + "force_y [N]": zero, name + "force_z [N]": [0.0, 50.0, 25.0],
        name + "line_force_x [N]": [0.0, 30.0, 0.0], name + "line_force_y [N]": zero,
        name + "line_force_z [N]": [0.0, 40.0, 24.0],
        name + "payload_x [m]": zero, name + "payload_y [m]": zero,
        name + "payload_z [m]": [-2.0 + payload_speed * time for time in range(3)],
        name + "payload_velocity_x [m/s]": zero, name + "payload_velocity_y [m/s]": zero,
        name + "payload_velocity_z [m/s]": [payload_speed] * 3,
        name + "projected_area [m^2]": [3.0, 2.0, 2.5], name + "largest_strain": zero, name + "inversion": zero,
    }


def write_canopies(folder, fields=("velocity", "position", "von_mises"), payload_speed=0.0, canopies=1, side=0.0):
    """Writes a run of cones of cloth in a stream; returns its path. `side`: velocity of the stream along y."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(SCENE.format(canopies=CANOPY * canopies, side_velocity=side))
    columns = {"time [s]": [0.0, 1.0, 2.0], "kinetic_energy [J]": [1.0, 2.0, 3.0]}
    for index in range(canopies):
        columns |= canopy_columns(index, payload_speed)
    columns |= {"cloth_kinetic_energy [J]": [0.0, 1.0, 2.0], "cloth_elastic_energy [J]": [0.0, 4.0, 3.0]}
    write_history(folder / "history.csv", columns)
    payload = GORES + 1
    ring = 1 + np.arange(GORES)
    triangles = np.stack((0 * ring, ring, np.roll(ring, -1)), axis=1)
    lines = np.stack((ring, 0 * ring + payload), axis=1)
    seams = np.stack((0 * ring, ring), axis=1)
    with h5py.File(folder / "fields.h5", "w") as h5:
        for axis, low, high, count in zip("xyz", LOW, HIGH, CELLS):
            h5[f"mesh/{axis}"] = np.linspace(low, high, count + 1)
        if {"position", "von_mises"} & set(fields):
            h5["mesh/canopy/triangles"] = triangles
            h5["mesh/canopy/strings"] = np.concatenate((seams, lines))
            h5["mesh/canopy/vertices"] = tent(0.0)
        for k, bulge in enumerate((0.0, 0.5, 1.0)):
            group = h5.create_group(f"steps/{k:06d}")
            group.attrs["time"] = float(k)
            z = centres(CELLS, np.subtract(HIGH, LOW))[2]
            values = {
                "velocity": (np.stack((0 * z, 0 * z, 4 + 0.1 * k * z), axis=-1), "m/s"),
                "vorticity": (np.stack((0 * z, 0.1 * k * z, 0 * z), axis=-1), "1/s"),
                "canopy/position": (tent(bulge), "m"),
                "canopy/von_mises": (bulge * np.arange(GORES), "N/m"),
            }
            for name, (array, units) in values.items():
                if name.split("/")[-1] in fields:
                    group[name] = array
                    group[name].attrs["units"] = units
    return folder


def write_drum(folder):
    """Writes a run of a drum beside a sphere at the origin; returns its path."""
    run = write_canopies(folder, payload_speed=0.5)
    scene = (run / "scene.toml").read_text().replace('"flat-circular"', '"drum"')
    body = '[[body]]\nkind = "sphere"\ncentre = [0.0, 0.0, 0.0]\nradius = 0.8\n'
    (run / "scene.toml").write_text(scene[:scene.index("[verify]")] + body)
    return run


def write_springs_and_flags(folder):
    """Writes a history of a plate on a spring and of a flag; returns its path."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text('app = "parachute"\n[[body]]\nkind = "plate"\n[[flag]]\n')
    columns = {f"body_0_force_{axis} [N]": [1.0, 2.0, 3.0] for axis in "xyz"}
    columns |= {f"flag_0_force_{axis} [N]": [1.0, 0.5, 1.5] for axis in "xy"}
    columns |= {"flag_0_tip_x [m]": [1.0, 0.9, 1.0], "flag_0_tip_y [m]": [0.3, -0.3, 0.2]}
    write_history(folder / "history.csv", {
        "time [s]": [0.0, 1.0, 2.0], "kinetic_energy [J]": [1.0] * 3, "body_0_displacement [m]": [0.0, 0.01, -0.02], **columns,
    })
    return folder


def write_cloth_drop(folder):
    """Writes a run of such a cone without a fluid; returns its path."""
    write_canopies(folder, ("position", "von_mises"))
    (folder / "scene.toml").write_text('app = "parachute"\n' + CANOPY)
    columns = {name: values for name, values in canopy_columns(0, 1.0).items() if not name.startswith("canopy_0_force")}
    write_history(folder / "history.csv", {
        "time [s]": [0.0, 1.0, 2.0], **columns, "cloth_kinetic_energy [J]": [0.0, 1.0, 2.0],
        "cloth_elastic_energy [J]": [0.0, 4.0, 3.0], "potential_energy [J]": [9.0, 4.0, 4.0], "energy [J]": [9.0] * 3,
    })
    with h5py.File(folder / "fields.h5", "a") as h5:
        for axis in "xyz":
            del h5[f"mesh/{axis}"]
    return folder


def write_bodies(folder):
    """Writes a history of forces on a cylinder (mean 3 N along x from 2 s on) and on a sphere; returns its path.

    The forces of the first row are a thousand times larger, as at a start from rest.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(
        'app = "parachute"\n[[body]]\nkind = "cylinder"\n[[body]]\nkind = "sphere"\n[verify]\n'
        'history = [{ column = "body_0_force_x", statistic = "mean", from = 2.0, reference = 2.0, value = 1.4, tolerance = 0.1 },\n'
        '{ column = "body_1_force_x", statistic = "max", from = 2.0, reference = 1.0, value = 3.0, tolerance = 0.1 }]\n'
    )
    time = [0.0, 1.0, 2.0, 3.0, 4.0]
    write_history(folder / "history.csv", {
        "time [s]": time, "kinetic_energy [J]": [1.0] * 5,
        "body_0_force_x [N]": [3000.0, 5.0, 2.0, 4.0, 2.0], "body_0_force_y [N]": [0.0, 1.0, -1.0, 1.0, -1.0],
        "body_0_force_z [N]": [1e-12] * 5,
        **{f"body_1_force_{axis} [N]": [1.0, 2.0, 3.0, 2.0, 1.0] for axis in "xyz"},
        **{f"body_1_outside_force_{axis} [N]": [0.5, 1.0, 1.5, 1.0, 0.5] for axis in "xyz"},
    })
    return folder
