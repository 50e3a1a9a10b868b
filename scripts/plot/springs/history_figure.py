"""Figure of the history of a drogue-springs run: energies, change of their sum, and probes."""

import numpy as np

from .. import style
from ..checks import failure_caption
from ..run_directory import Run
from ..style import plt

_ENERGIES = ("kinetic", "elastic", "potential")
_WORKS = ("contact", "friction")  # prefixes of the columns *_work


def _moves_pins(run: Run) -> bool:
    """Whether pins do work, which no column counts."""
    return any(float(motion) != 0 if isinstance(motion, int | float) else motion.strip() != "0"
               for pin in run.scene.get("pin", []) for motion in pin.get("motion", {}).values())


def _probes(run: Run) -> list[str]:
    return [name[:-2] for name in run.history if name.startswith("probe_") and name.endswith("_x")]


def _draw_curves(axes, time: np.ndarray, curves: dict[str, np.ndarray]) -> None:
    ends = []
    for colour, (name, values) in zip(style.PALETTE, curves.items()):
        axes.plot(*style.decimate(time, values), color=colour)
        ends.append(((time[-1], values[-1]), name, colour))
    style.label_curves(axes, ends)


def _draw_change(axes, time: np.ndarray, values: dict[str, np.ndarray], works: dict[str, np.ndarray]) -> None:
    released = values["kinetic"][0] - sum(values[name] - values[name][0] for name in ("elastic", "potential"))
    # The same denominator as in the check, so that the figure shows the value of the check.
    largest = max(values["kinetic"].max(), released.max()) or 1.0
    kept = values["energy"] - sum(works.values())
    axes.plot(*style.decimate(time, (kept - kept[0]) / largest), color=style.ERROR_COLOUR)
    axes.set_title("change of sum" + (" less works," if works else "") + " over largest kinetic or released energy")


def springs_history_figure(run: Run):
    """Figure; None if the history has fewer than two rows. Where pins move, the sum of the energies is not drawn: it is not kept."""
    time = run.history.get("time")
    if time is None or len(time.values) < 2:
        return None
    probes = _probes(run)
    keeps_sum = not _moves_pins(run)
    count = 1 + keeps_sum + len(probes)
    height = 1.0 + 1.6 * count
    figure, axes = plt.subplots(count, 1, figsize=(5.2, height), sharex=True, squeeze=False)
    axes = list(axes[:, 0])
    figure.subplots_adjust(left=0.16, right=0.8, top=1 - 0.9 / height, bottom=0.45 / height, hspace=0.5)
    values = {name: run.history[name].values for name in (*_ENERGIES, "energy")}
    # Only changes of the potential energy are meaningful.
    values["potential"] = values["potential"] - values["potential"][0]
    works = {name: run.history[f"{name}_work"].values for name in _WORKS if f"{name}_work" in run.history}
    _draw_curves(axes[0], time.values, {name: values[name] for name in _ENERGIES} | works)
    axes[0].set_title("energies, the potential one from its start" + (", and works" if works else "") + " (J)")
    if keeps_sum:
        _draw_change(axes[1], time.values, values, works)
    for panel, probe in zip(axes[1 + keeps_sum :], probes):
        moved = {axis: run.history[f"{probe}_{axis}"].values for axis in "xyz"}
        _draw_curves(panel, time.values, {axis: place - place[0] for axis, place in moved.items()})
        panel.set_title(f"{probe.replace('_', ' ')}: displacement from its start (m)")
    axes[-1].set_xlabel("time (s)")
    style.heading(figure, run.name, f"history, {len(time.values)} rows{failure_caption(run.result)}")
    return figure
