"""Picture of history.csv: one panel a quantity, conserved ones as their relative change."""

import numpy as np

from . import style
from .run_directory import Run
from .style import plt

_CONSERVED = ("mass", "momentum", "energy")
_NOT_DRAWN = ("time", "step")


def _draw_conserved(axes, run: Run, names: list[str]) -> None:
    time = run.history["time"].values
    ends = []
    for index, name in enumerate(names):
        values = run.history[name].values
        # A momentum that starts at zero has no relative change; the largest value seen is the scale then.
        scale = abs(values[0]) or np.max(np.abs(values)) or 1.0
        change = (values - values[0]) / scale
        axes.plot(*style.thin(time, change), color=style.PALETTE[index])
        ends.append(((time[-1], change[-1]), style.axis_label(name, ""), style.PALETTE[index]))
    axes.set_title("relative change of the conserved quantities")
    style.label_ends(axes, ends)


def history_figure(run: Run):
    """Figure, or None where the history has fewer than two rows."""
    time = run.history.get("time")
    if time is None or len(time.values) < 2:
        return None
    names = [name for name in run.history if name not in _NOT_DRAWN]
    conserved = [name for name in names if name in _CONSERVED]
    single = [name for name in names if name not in conserved]
    panels = ([conserved] if conserved else []) + [[name] for name in single]
    if not panels:
        return None
    height = 0.55 + 1.45 * len(panels)
    figure, axes = plt.subplots(len(panels), 1, figsize=(5.2, height + 0.35), sharex=True, squeeze=False)
    figure.subplots_adjust(
        left=0.14, right=0.8, top=1 - 0.78 / (height + 0.35), bottom=0.45 / (height + 0.35), hspace=0.5
    )
    for panel, group in zip(axes[:, 0], panels):
        if group == conserved:
            _draw_conserved(panel, run, group)
            continue
        item = run.history[group[0]]
        panel.plot(*style.thin(time.values, item.values), color=style.RUN_COLOUR)
        panel.set_title(style.axis_label(item.name, item.units))
    axes[-1, 0].set_xlabel("time (s)")
    style.heading(figure, run.name, f"history, {len(time.values)} rows")
    return figure
