"""Figure of the history of canopies: forces, drag coefficient, projected area, payload, and energies of the cloth."""

import re

import numpy as np

from .. import style
from ..expression import evaluate
from ..failure import Failure
from ..run_directory import Run
from .time_figure import Band, Panel, expected_means, time_figure


def _vector(run: Run, canopy: int, quantity: str) -> np.ndarray:
    """Vectors (rows, 3) of a canopy over time."""
    return np.stack([run.history[f"canopy_{canopy}_{quantity}_{axis}"].values for axis in "xyz"], axis=1)


def _count(run: Run) -> int:
    """Number of canopies in the history."""
    return sum(name.startswith("canopy_") and name.endswith("_projected_area") for name in run.history)


def relative_velocity(run: Run, canopy: int) -> np.ndarray:
    """Velocity (rows, 3) of the fluid far upstream relative to the payload, m/s.

    A component that changes in space or time counts as 0, as it does in the checks.
    """
    stream = []
    for component in run.scene["fluid"]["velocity"]:
        try:
            stream.append(float(evaluate(component)))
        except Failure:
            stream.append(0.0)
    return np.array(stream) - _vector(run, canopy, "payload_velocity")


def drag_coefficient(run: Run, canopy: int) -> np.ndarray:
    """2 F / (rho U^2 S0) in every row: F the force along the relative velocity U, S0 the nominal area."""
    velocity = relative_velocity(run, canopy)
    speed = np.linalg.norm(velocity, axis=1)
    area = nominal_area(run, canopy)
    along = np.sum(_vector(run, canopy, "force") * velocity, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return along / (0.5 * run.scene["fluid"]["density"] * speed**3 * area)


def nominal_area(run: Run, canopy: int) -> float:
    """Area of the cloth with its vent, m^2: a disk, and the frustum of a cone below it if there is a skirt."""
    keys = run.scene["canopy"][canopy]
    area = np.pi / 4 * keys["diameter"] ** 2
    if skirt := keys.get("skirt"):
        area += np.pi / 2 * (keys["diameter"] + skirt["diameter"]) * skirt["length"]
    return area


def _has_lines(run: Run, canopy: int) -> bool:
    """Whether a canopy has lines and a payload: a sheet or drum has its centre of mass in their columns."""
    return run.scene["canopy"][canopy].get("kind") not in ("sheet", "drum")


def _checks(run: Run, quantity: str) -> list[Band]:
    """Bands of the means of a quantity of canopies over intervals of time."""
    return [band for column, _, band in expected_means(run) if re.fullmatch(rf"canopy_\d+_{quantity}", column)]


def _panels(run: Run) -> list[Panel]:
    canopies = range(_count(run))

    def label(words, canopy):
        return f"{words or 'canopy'} {canopy}" if len(canopies) > 1 else words

    def of_all(words, values):
        return {label(words, canopy): values(canopy) for canopy in canopies}

    def history(name):
        return run.history[name].values

    peaks = [
        Band(tuple(check.get("time", history("time")[[0, -1]])), tuple(check["force"]))
        for check in run.scene.get("verify", {}).get("peak_force", [])
    ]
    has_fluid = "fluid" in run.scene
    line_forces = {
        label("lines", canopy): np.linalg.norm(_vector(run, canopy, "line_force"), axis=1)
        for canopy in canopies
        if _has_lines(run, canopy)
    }
    panels = []
    if has_fluid:
        panels += [
            Panel(
                "force of the air along z" + (", and of the lines on the payload" if line_forces else "") + " (N)",
                of_all("air", lambda canopy: history(f"canopy_{canopy}_force_z")) | line_forces,
                peaks,
                dashed=frozenset(line_forces),
            )
        ]
        # The flow past a sheet or drum changes its direction as they move.
        drags = {label("", k): drag_coefficient(run, k) for k in canopies if _has_lines(run, k)}
        if drags:
            panels += [Panel("drag coefficient", drags, _checks(run, "drag_coefficient"))]
    elif line_forces:
        panels += [Panel("force of the lines on the payload (N)", line_forces, peaks)]
    panels += [
        Panel(
            style.axis_label("projected area", "m^2"),
            of_all("", lambda canopy: history(f"canopy_{canopy}_projected_area")),
            _checks(run, "projected_area"),
            constants={
                f"nominal: {area:.1f}": area
                for area in dict.fromkeys(nominal_area(run, canopy) for canopy in canopies)
            },
        ),
    ]
    what, own = ("payload", "of the payload") if line_forces else ("centre of mass", "of the cloth")
    free = [canopy for canopy in canopies if np.ptp(_vector(run, canopy, "payload"), axis=0).max() > 0]
    if free:
        panels += [
            Panel(
                f"speed of the {what} (m/s)",
                {label(own, k): np.linalg.norm(_vector(run, k, "payload_velocity"), axis=1) for k in free}
                | {
                    label("in the stream", k): np.linalg.norm(relative_velocity(run, k), axis=1)
                    for k in free
                    if has_fluid
                },
                _checks(run, "airspeed"),
            ),
            Panel(f"height of the {what}, z (m)", {label("", k): history(f"canopy_{k}_payload_z") for k in free}),
        ]
    energies = {"kinetic": history("cloth_kinetic_energy"), "elastic": history("cloth_elastic_energy")}
    if "potential_energy" in run.history:
        energies["potential"] = history("potential_energy") - history("potential_energy")[0]
    return [*panels, Panel(f"energy of cloth{', lines and payloads' if line_forces else ''} (J)", energies)]


def canopies_history_figure(run: Run):
    """Figure; None without canopies in the history, or with fewer than two rows."""
    time = run.history.get("time")
    if time is None or len(time.values) < 2 or not _count(run):
        return None
    return time_figure(run, time.values, _panels(run))
