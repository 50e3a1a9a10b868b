"""Figure of velocities along lines beside the expected ones, with their deviation below."""

import numpy as np
from matplotlib.ticker import FuncFormatter, MaxNLocator

from .. import style
from ..checks import failure_caption
from ..run_directory import Run, Snapshot
from ..style import plt
from .plane import AXES, cell_counts
from .profiles import Comparison, comparisons

_MAX_COLUMNS = 4
# Inches.
_WIDTH, _VALUES, _DEVIATION = 2.6, 1.9, 0.95  # width and heights of the panels of a comparison
_LEFT, _RIGHT, _HEADING, _ABOVE, _BETWEEN, _BELOW = 0.7, 0.2, 0.5, 0.3, 0.34, 0.5
_ROUND_OFF = 1e-12  # relative to the largest velocity; smaller deviations are not drawn
_EXTREME = "D"


def _velocity(component: int) -> str:
    return style.axis_label(f"velocity along {AXES[component]}", "m/s")


def _place(run: Run, comparison: Comparison) -> str:
    """Label of the axis along a line, with the place of the line."""
    others = [axis for axis in range(3) if axis != comparison.along and cell_counts(run)[axis] > 1]
    where = ", ".join(f"{AXES[axis]} = {comparison.through[axis]:.4g} m" for axis in others)
    return style.axis_label(AXES[comparison.along], "m") + (f" at {where}" if where else "")


def _draw_values(axes, comparison: Comparison) -> None:
    line = comparison.line
    if comparison.exact is not None:
        places = line.curve[0]
        axes.plot(places, comparison.exact(places), color=style.INK, linewidth=0.9)
        axes.plot(
            line.places, line(line.places), "o", color=style.RUN_COLOUR, markersize=2.8,
            markerfacecolor="white", markeredgewidth=0.8,
        )
        return
    axes.plot(*line.curve, color=style.RUN_COLOUR)
    points = {"color": style.INK, "markerfacecolor": "white", "markeredgewidth": 0.9, "linestyle": "none"}
    axes.plot(*comparison.points.T, marker="o", markersize=3.6, **points)
    for _, at, value, _ in comparison.extremes:
        if at is None:
            axes.axhline(value, color=style.INK, linewidth=0.8, linestyle="--")
        else:
            axes.plot([at], [value], marker=_EXTREME, markersize=4.2, **points)


def _draw_deviation(axes, comparison: Comparison) -> None:
    places, deviation = comparison.deviations()
    top = float(np.abs(comparison.line(comparison.line.places)).max())
    extremes = [
        (found_at if at is None else at, found - value, tolerance)
        for sign, at, value, tolerance in comparison.extremes
        for found_at, found in (comparison.line.extremum(sign),)
    ]
    largest = max([*np.abs(deviation), *(abs(size) for _, size, _ in extremes)], default=0.0)
    is_round_off = largest <= _ROUND_OFF * top
    words = "off by round-off" if is_round_off else f"off by {style.format_number(largest)} m/s"
    if comparison.tolerance is not None:
        words += f" (tolerance {style.format_number(comparison.tolerance)})"
    axes.set_title(words, fontsize=8, pad=4)
    if is_round_off:
        axes.set_yticks([])
        return
    marker = "o-" if comparison.exact is not None else "o"
    axes.plot(places, deviation, marker, color=style.ERROR_COLOUR, markersize=3, linewidth=0.9)
    for at, size, tolerance in extremes:
        axes.errorbar(
            [at], [size], yerr=tolerance, fmt=_EXTREME, color=style.ERROR_COLOUR, markersize=4,
            elinewidth=0.8, capsize=2,
        )
    axes.axhline(0, color=style.MUTED, linewidth=0.7)
    limit = 1.15 * max([largest, *(abs(size) + tolerance for _, size, tolerance in extremes)])
    if comparison.tolerance is not None and comparison.tolerance < 5 * largest:
        limit = max(limit, 1.15 * comparison.tolerance)
        for sign in (-1, 1):
            axes.axhline(sign * comparison.tolerance, color=style.MUTED, linewidth=0.8, linestyle="--")
    axes.set_ylim(-limit, limit)
    axes.yaxis.set_major_locator(MaxNLocator(4, symmetric=True))
    # A common factor above the axis would push the title into the panel above.
    axes.yaxis.set_major_formatter(
        FuncFormatter(lambda value, _: ("\u2212" if value < 0 else "") + style.format_number(abs(value)))
    )


def _legend(found: list[Comparison]) -> list[tuple[str, str, str]]:
    """Entries (marker, label, colour) of what the panels hold."""
    entries = []
    if any(comparison.exact is None for comparison in found):
        entries.append(("\u2014", "run", style.RUN_COLOUR))
    if any(len(comparison.points) for comparison in found):
        entries.append(("\u25cb", "expected", style.INK))
    if any(comparison.extremes for comparison in found):
        entries.append(("\u25c7", "expected extreme", style.INK))
    if any(comparison.exact is not None for comparison in found):
        entries += [("\u25cb", "run", style.RUN_COLOUR), ("\u2014", "exact", style.INK)]
    return entries


def profiles_figure(run: Run, snapshot: Snapshot):
    """Figure; None if the scene expects no velocity along a line at the time of the snapshot."""
    found = comparisons(run, snapshot)
    if not found:
        return None
    columns = min(len(found), _MAX_COLUMNS)
    cell = (_LEFT + _WIDTH + _RIGHT, _ABOVE + _VALUES + _BETWEEN + _DEVIATION + _BELOW)
    width, height = columns * cell[0], -(-len(found) // columns) * cell[1] + _HEADING
    figure = plt.figure(figsize=(width, height))
    counts = " x ".join(str(count) for count in cell_counts(run) if count > 1)
    caption = f"{counts} cells, t = {snapshot.time:.4g} s{failure_caption(run.result)}"
    legend = _legend(found)
    needed = max(style.subtitle_width(figure, caption), style.heading_width(figure, run.name, legend))
    width = max(width, needed)
    figure.set_figwidth(width)
    for k, comparison in enumerate(found):
        left = _LEFT + (k % columns) * cell[0]
        bottom = height - _HEADING - (k // columns + 1) * cell[1] + _BELOW
        lower = figure.add_axes((left / width, bottom / height, _WIDTH / width, _DEVIATION / height))
        bottom += _DEVIATION + _BETWEEN
        upper = figure.add_axes((left / width, bottom / height, _WIDTH / width, _VALUES / height))
        _draw_values(upper, comparison)
        _draw_deviation(lower, comparison)
        upper.set_title(_velocity(comparison.component), pad=5)
        lower.set_xlabel(_place(run, comparison))
        faces = run.mesh[AXES[comparison.along]].values
        for panel in (upper, lower):
            panel.set_xlim(faces[0], faces[-1])
            panel.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
        upper.tick_params(labelbottom=False)
    style.heading(figure, run.name, caption, legend)
    return figure
