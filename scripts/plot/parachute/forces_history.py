"""Figure of bodies and flags over time: forces of the flow, their means and the expected ones, and displacements."""

import re

import numpy as np

from .. import style
from ..run_directory import Run
from .time_figure import Panel, expected_means, time_figure

_ABSENT = 1e-6  # of the largest component: below it a component is round-off
_START = 0.1  # part of the run whose forces need not be in the picture: those of a start from rest


def mean_between(time: np.ndarray, values: np.ndarray, start: float, end: float) -> float:
    """Mean of the rows from `start` to `end`, s, by the trapezoidal rule."""
    inside = (time >= start) & (time <= end)
    time, values = time[inside], values[inside]
    return float(np.sum((values[1:] + values[:-1]) / 2 * np.diff(time)) / np.ptp(time))


def _panel(run: Run, body: int, time: np.ndarray) -> Panel:
    forces = {axis: run.history[f"body_{body}_force_{axis}"].values for axis in "xyz"}
    shown = time >= time[0] + _START * (time[-1] - time[0])
    sizes = {axis: float(np.nanmax(np.abs(values[shown]), initial=0.0)) for axis, values in forces.items()}
    largest = max(sizes.values())
    curves = {axis: values for axis, values in forces.items() if sizes[axis] > _ABSENT * largest or not largest}
    bands, means = [], []
    for column, check, band in expected_means(run):
        found = re.fullmatch(rf"body_{body}_force_([xyz])", column)
        if not found or np.count_nonzero((time >= band.times[0]) & (time <= band.times[1])) < 2:
            continue
        bands.append(band)
        mean = mean_between(time, forces[found[1]], *band.times) / check["reference"]
        means.append(f"mean along {found[1]} / {check['reference']:.3g} N = {mean:.3g}, expected {check['value']:.3g}")
    kind = run.scene.get("body", [{}] * (body + 1))[body].get("kind", "body")
    title = "\n".join([style.axis_label(f"force on {kind} {body}", "N"), *means])
    return Panel(title, curves, bands, settled=time[shown][0])


def _count(run: Run, kind: str) -> int:
    return sum(re.fullmatch(rf"{kind}_\d+_force_x", name) is not None for name in run.history)


def _displacement_panels(run: Run, body: int) -> list[Panel]:
    """Displacement of a plate on a spring along its normal."""
    displacement = run.history.get(f"body_{body}_displacement")
    if displacement is None:
        return []
    return [Panel(style.axis_label(f"displacement of plate {body}", "m"), {"": displacement.values})]


def _flag_panels(run: Run, flag: int, time: np.ndarray) -> list[Panel]:
    """Force of the fluid on a flag, and the place of its tip."""
    shown = time >= time[0] + _START * (time[-1] - time[0])
    settled = time[shown][0]
    return [
        Panel(
            style.axis_label(f"{words} flag {flag}", unit),
            {axis: run.history[f"flag_{flag}_{quantity}_{axis}"].values for axis in "xy"},
            settled=settled,
        )
        for words, quantity, unit in (("force on", "force", "N"), ("tip of", "tip", "m"))
    ]


def forces_history_figure(run: Run):
    """Figure; None without forces on bodies or flags in the history, or with fewer than two rows."""
    time = run.history.get("time")
    bodies, flags = range(_count(run, "body")), range(_count(run, "flag"))
    if time is None or len(time.values) < 2 or not (bodies or flags):
        return None
    panels = [panel for k in bodies for panel in (_panel(run, k, time.values), *_displacement_panels(run, k))]
    panels += [panel for k in flags for panel in _flag_panels(run, k, time.values)]
    return time_figure(run, time.values, panels)
