"""Figure of history.csv: conservation of mass, momentum and energy, then one panel per quantity."""

import numpy as np

from .. import style
from ..checks import failure_caption
from ..run_directory import Run
from ..style import plt

_CONSERVED = ("mass", "momentum", "energy")
_LABELS = {"max_speed": "largest signal speed |u| + c"}
# Counters that are drawn only if they are not zero throughout.
_COUNTERS = ("limiter_touches", "redone_steps")


def conservation(run: Run) -> dict[str, np.ndarray]:
    """Relative change of each conserved quantity, corrected for the outflow through the boundaries.

    Momentum is relative to its bound sqrt(2 mass energy), because its total may be zero.
    """
    present = [name for name in _CONSERVED if name in run.history]
    total = {name: run.history[name].values for name in present}
    scale = {name: abs(total[name][0]) or 1.0 for name in present}
    if "momentum" in present and {"mass", "energy"} <= set(present):
        scale["momentum"] = np.sqrt(2 * scale["mass"] * scale["energy"])
    change = {}
    for name in present:
        outflow = run.history.get(f"{name}_outflow")
        left = outflow.values - outflow.values[0] if outflow else 0.0
        change[name] = (total[name] - total[name][0] + left) / scale[name]
    return change


def _draw_conservation(axes, time: np.ndarray, change: dict[str, np.ndarray]) -> None:
    ends = []
    for colour, (name, values) in zip(style.PALETTE, change.items()):
        axes.plot(*style.decimate(time, values), color=colour)
        ends.append(((time[-1], values[-1]), style.axis_label(name, ""), colour))
    axes.set_title("relative change less what left through the ends")
    style.label_curves(axes, ends)


def _single_panels(run: Run) -> list[str]:
    drawn = set(_CONSERVED) | {f"{name}_outflow" for name in _CONSERVED} | {"time", "step"}
    return [
        name
        for name, item in run.history.items()
        if name not in drawn and (name not in _COUNTERS or np.any(item.values != 0))
    ]


def history_figure(run: Run):
    """Figure; None if the history has fewer than two rows or no column besides time and step."""
    time = run.history.get("time")
    if time is None or len(time.values) < 2:
        return None
    change, single = conservation(run), _single_panels(run)
    count = bool(change) + len(single)
    if count == 0:
        return None
    height = 1.0 + 1.45 * count
    figure, axes = plt.subplots(count, 1, figsize=(5.2, height), sharex=True, squeeze=False)
    figure.subplots_adjust(left=0.14, right=0.8, top=1 - 0.9 / height, bottom=0.45 / height, hspace=0.5)
    panels = list(axes[:, 0])
    if change:
        _draw_conservation(panels.pop(0), time.values, change)
    for panel, name in zip(panels, single):
        item = run.history[name]
        panel.plot(*style.decimate(time.values, item.values), color=style.RUN_COLOUR)
        panel.set_title(style.axis_label(_LABELS.get(name, name), item.units))
    axes[-1, 0].set_xlabel("time (s)")
    style.heading(figure, run.name, f"history, {len(time.values)} rows{failure_caption(run.result)}")
    return figure
