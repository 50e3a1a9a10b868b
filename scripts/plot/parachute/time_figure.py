"""Figure of curves over time, one panel below the other, with the ranges in which checks expect them."""

from dataclasses import dataclass, field
from itertools import cycle

import numpy as np
from matplotlib.patches import Rectangle

from .. import style
from ..checks import failure_caption
from ..run_directory import Run
from ..style import plt

_MARGIN = 0.08  # of a panel above and below its curves
_BAND = "#DDDDDD"


@dataclass(frozen=True)
class Band:
    """Range (low, high) of values in an interval of time, s, and the expected value if there is one."""

    times: tuple[float, float]
    values: tuple[float, float]
    expected: float | None = None


def expected_means(run: Run) -> list[tuple[str, dict, Band]]:
    """Column, check and band of each mean that `verify.history` of the scene expects, in the unit of the column."""
    found = []
    for check in run.scene.get("verify", {}).get("history", []):
        if check["statistic"] != "mean":
            continue
        expected = check["value"] * check["reference"]
        margin = check["tolerance"] * (abs(expected) or check["reference"])
        times = (check["from"], check.get("to", run.history["time"].values[-1]))
        found.append((check["column"], check, Band(times, (expected - margin, expected + margin), expected)))
    return found


@dataclass
class Panel:
    """Values over time by label, bands of checks, and constants by label.

    `dashed` curves lie on others. The range of values is that of the times from `settled` on, s: a start from rest may
    have far larger forces.
    """

    title: str
    curves: dict[str, np.ndarray]
    bands: list[Band] = field(default_factory=list)
    constants: dict[str, float] = field(default_factory=dict)
    settled: float | None = None
    dashed: frozenset[str] = frozenset()

    def limits(self, time: np.ndarray) -> tuple[float, float]:
        """Lower and upper end of the axis of values."""
        shown = time >= (time[0] if self.settled is None else self.settled)
        values = [part[shown] for part in self.curves.values()] + [np.array(list(self.constants.values()))]
        values += [np.array(band.values) for band in self.bands]
        every = np.concatenate(values)
        every = every[np.isfinite(every)]
        if not every.size:
            return 0.0, 1.0
        low, high = float(every.min()), float(every.max())
        margin = _MARGIN * (high - low) or 0.1 * abs(high) or 1.0
        return low - margin, high + margin


def _draw(axes, time: np.ndarray, panel: Panel) -> None:
    axes.set_title(panel.title)
    axes.set_xlim(time[0], time[-1])
    axes.set_ylim(*panel.limits(time))
    for band in panel.bands:
        low, high = band.values
        size = (band.times[1] - band.times[0], high - low)
        axes.add_patch(Rectangle((band.times[0], low), *size, facecolor=_BAND, edgecolor="none", zorder=0.5))
        if band.expected is not None:
            axes.plot(band.times, [band.expected] * 2, color=style.MUTED, linewidth=1, linestyle="--", zorder=1.5)
    ends = []
    for colour, (label, values) in zip(cycle(style.PALETTE), panel.curves.items()):
        axes.plot(*style.decimate(time, values), color=colour, linestyle="--" if label in panel.dashed else "-")
        finite = values[np.isfinite(values)]
        if label and finite.size:
            ends.append(((time[-1], finite[-1]), label, colour))
    for label, value in panel.constants.items():
        axes.axhline(value, color=style.MUTED, linewidth=1, linestyle=":")
        ends.append(((time[-1], value), label, style.MUTED))
    style.label_curves(axes, ends)


def time_figure(run: Run, time: np.ndarray, panels: list[Panel]):
    """Figure of panels over `time`, s; the name of the run, the meaning of bands and a check that failed stand above them."""
    height = 1.0 + 1.6 * len(panels)
    figure, axes = plt.subplots(len(panels), 1, figsize=(5.6, height), sharex=True, squeeze=False)
    figure.subplots_adjust(left=0.15, right=0.8, top=1 - 0.9 / height, bottom=0.45 / height, hspace=0.45)
    for one, panel in zip(axes[:, 0], panels):
        _draw(one, time, panel)
    axes[-1, 0].set_xlabel("time (s)")
    marks = ""
    if any(panel.bands for panel in panels):
        has_value = any(band.expected is not None for panel in panels for band in panel.bands)
        marks = "; grey: what [verify] allows" + (", dashed: the value that it expects" if has_value else "")
    style.heading(figure, run.name, f"history, {len(time)} rows{marks}{failure_caption(run.result)}")
    return figure
