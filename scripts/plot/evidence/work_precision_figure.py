"""Work-precision figure: error against time to solution, one column of panels per backend."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .. import style
from ..style import plt
from .perf_record import BACKENDS, Machine
from .scheme_family import PublishedResult, SchemeFamily
from .work_precision import Curve

# Line style, marker and legend symbol, by the position of a second setting in its family.
_LINES = (("-", "o", "\u2014\u25cb"), ("--", "v", "\u2013 \u2013 \u25bd"))
_OTHER_LINE = (":", "s", "\u2026\u25a1")
_PANEL_WIDTH, _SCHEMES_HEIGHT, _SETTINGS_HEIGHT = 2.75, 2.5, 2.0  # of axes, inches
_LEFT, _BOTTOM, _HEADING, _GAP, _RIGHT, _BETWEEN_ROWS = 0.95, 0.45, 0.72, 0.2, 0.15, 0.62
_TICKS = 0.16  # height of the tick labels of a row with its own x axis, inches


def _colour(family: SchemeFamily, key: str) -> str:
    if key == family.competitor:
        return style.INK
    return _indexed_colour(list(family.scheme_names), key)


def _indexed_colour(known: list[str], name: str) -> str:
    return style.PALETTE[known.index(name) % len(style.PALETTE)] if name in known else style.MUTED


def _line(family: SchemeFamily, second: str) -> tuple[str, str, str]:
    known = list(family.line_settings)
    return _LINES[known.index(second)] if second in known else _OTHER_LINE


def _draw(axes, curve: Curve, colour: str, line: str, marker: str) -> None:
    axes.plot(
        curve.points[:, 1], curve.points[:, 2], line + marker, color=colour, markersize=3.6, markerfacecolor="white",
        markeredgewidth=0.9, linewidth=1.2, zorder=3 if curve.scheme.is_competitor else 2,
    )


def _draw_scheme(axes, curve: Curve) -> None:
    scheme = curve.scheme
    _draw(axes, curve, _colour(scheme.family, scheme.key), "--" if scheme.is_competitor else "-", "o")


def _draw_variant(axes, curve: Curve) -> None:
    family, (first, second, *_) = curve.scheme.family, curve.scheme.settings
    line, marker, _ = _line(family, second)
    _draw(axes, curve, _indexed_colour(list(family.colour_settings), first), line, marker)


def _column_of(result: PublishedResult, columns: list[str]) -> str | None:
    """Backend of the panel that shows a published result; host results may appear in the first column."""
    if result.backend in columns:
        return result.backend
    return None if result.backend == "cuda" else columns[0]


# Places of a label beside its point: shift in points, horizontal and vertical alignment.
_ABOVE, _BELOW = (0, 5, "center", "bottom"), (0, -5, "center", "top")
_PLACES = (_ABOVE, _BELOW, (6, 0, "left", "center"), (-6, 0, "right", "center"))


def _draw_published(axes, results: list[PublishedResult]) -> None:
    for result in results:
        x, y = zip(*result.points)
        axes.plot(x, y, ":D", color=style.MUTED, markersize=3.4, linewidth=0.8, zorder=1)
        text = axes.annotate(
            result.label, result.points[0], (0, 0), textcoords="offset points", fontsize=6.5, color=style.MUTED,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.85},
        )
        # Above the first of several points, below a single point, unless `_clear_labels` finds something there.
        _move(text, _ABOVE if len(x) > 1 else _BELOW)


def _move(text, place) -> None:
    text.xyann = place[:2]
    text.set_ha(place[2])
    text.set_va(place[3])


def _drawn_points(axes) -> np.ndarray:
    """Points along all lines of a panel, pixels."""
    found = []
    for line in axes.lines:
        ends = axes.transData.transform(np.column_stack(line.get_data()))
        found.append(ends)
        for first, second in zip(ends, ends[1:]):
            found.append(first + np.linspace(0, 1, 40)[:, None] * (second - first))
    return np.vstack(found) if found else np.zeros((0, 2))


def _clear_labels(axes) -> None:
    """Moves labels of published results to where they hide least: within the panel, off lines and other labels."""
    renderer, points, placed = axes.figure.canvas.get_renderer(), _drawn_points(axes), []

    def hidden(text) -> float:
        box, panel = text.get_window_extent(renderer), axes.bbox
        outside = box.x0 < panel.x0 or box.x1 > panel.x1 or box.y0 < panel.y0 or box.y1 > panel.y1
        inside = (points[:, 0] > box.x0) & (points[:, 0] < box.x1) & (points[:, 1] > box.y0) & (points[:, 1] < box.y1)
        return 1000 * outside + 100 * sum(box.overlaps(other) for other in placed) + int(inside.sum())

    for text in axes.texts:
        usual = (*text.xyann, text.get_ha(), text.get_va())
        costs = []
        for place in (usual, *_PLACES):
            _move(text, place)
            costs.append(hidden(text))
        _move(text, (usual, *_PLACES)[costs.index(min(costs))])
        placed.append(text.get_window_extent(renderer))


def _scheme_legend(curves: list[Curve]) -> list[tuple[str, str, str]]:
    family, present = curves[0].scheme.family, {curve.scheme.key for curve in curves}
    ordered = [word for word in family.scheme_names if word in present] + sorted(present - set(family.scheme_names))
    return [
        (
            "\u2013 \u2013" if word == family.competitor else "\u2014",
            family.scheme_names.get(word, word),
            _colour(family, word),
        )
        for word in ordered
    ]


def _variant_legend(curves: list[Curve]) -> list[tuple[str, str, str]]:
    """Legend of the colours (first setting) and line styles (second setting); omits settings that do not vary."""
    if not curves:
        return []
    family = curves[0].scheme.family
    firsts, seconds = (list(dict.fromkeys(curve.scheme.settings[axis] for curve in curves)) for axis in range(2))
    key = [
        ("\u2014", family.setting_labels.get(word, word), _indexed_colour(list(family.colour_settings), word))
        for word in firsts
        if len(firsts) > 1
    ]
    for word in seconds if len(seconds) > 1 else ():
        key.append((_line(family, word)[2], family.line_settings.get(word, word), style.INK))
    return key


@dataclass(frozen=True)
class _Row:
    """Row of panels: title, legend, curves, function that draws a curve, and height in inches."""

    title: str
    legend: list[tuple[str, str, str]]
    curves: list[Curve]
    draw: Callable
    height: float


def _rows(title: str, curves: list[Curve], best: str | None) -> list[_Row]:
    default = [curve for curve in curves if curve.scheme.has_default_settings]
    rows = [_Row(title, _scheme_legend(default), default, _draw_scheme, _SCHEMES_HEIGHT)]
    variants = [curve for curve in curves if best and curve.scheme.key == best]
    for of_row in dict.fromkeys(curve.scheme.row_setting for curve in variants):
        drawn = [curve for curve in variants if curve.scheme.row_setting == of_row]
        family = drawn[0].scheme.family
        of_third = family.row_labels.get(of_row, family.setting_labels.get(of_row, of_row))
        words = ", ".join(filter(None, (family.scheme_names.get(best, best), of_third)))
        rows.append(_Row(words, _variant_legend(variants), drawn, _draw_variant, _SETTINGS_HEIGHT))
    return rows


def _layout(figure, rows: list[_Row], axes, details: str, between: float) -> list[float]:
    """Sizes a figure for its panels, legends and heading; returns the top of each row as a fraction of the height."""
    columns = axes.shape[1]
    legends = [style.heading_width(figure, row.title, row.legend) for row in rows]
    panels = _LEFT + (_PANEL_WIDTH + _GAP) * columns - _GAP + _RIGHT
    width = max(panels, style.subtitle_width(figure, details), *legends)
    height = _HEADING + sum(row.height for row in rows) + between * (len(rows) - 1) + _BOTTOM
    figure.set_size_inches(width, height)
    panel = (width - _LEFT - _RIGHT - _GAP * (columns - 1)) / columns
    tops, top = [], height - _HEADING
    for row, of_row in zip(rows, axes):
        for column, panel_axes in enumerate(of_row):
            left = _LEFT + column * (panel + _GAP)
            panel_axes.set_position((left / width, (top - row.height) / height, panel / width, row.height / height))
        tops.append(top / height)
        top -= row.height + between
    return tops


def solution_figure(problem: str, machine: Machine, curves: list[Curve], best: str | None, threads: str):
    """Figure with all schemes at their default settings, and below it the settings of the scheme `best`.

    Requires a curve with default settings; if `best` is None, there are no rows for settings.
    """
    family = curves[0].scheme.family
    title = family.problems.get(problem, problem)
    rows = _rows(title, curves, best)
    columns = list(dict.fromkeys(curve.scheme.backend for row in rows for curve in row.curves))
    # Published results may be far away, so that the rows of settings have a scale of their own.
    published = [result for result in family.published if result.problem == problem]
    figure, axes = plt.subplots(
        len(rows), len(columns), sharex="row" if published else True, sharey="row", squeeze=False
    )
    details = f"{family.default_label}; {machine.name}"
    tops = _layout(figure, rows, axes, details, _BETWEEN_ROWS + (_TICKS if published else 0.0))
    for row, of_row in zip(rows, axes):
        for panel_axes, backend in zip(of_row, columns):
            for curve in row.curves:
                if curve.scheme.backend == backend:
                    row.draw(panel_axes, curve)
            if row is rows[0]:
                _draw_published(panel_axes, [result for result in published if _column_of(result, columns) == backend])
            panel_axes.set_title(BACKENDS.get(backend, backend) + (threads if backend == "openmp" else ""), pad=4)
            panel_axes.set_xscale("log")
            panel_axes.set_yscale("log")
    if len(rows) > 2:
        # A common scale makes all settings comparable.
        limits = [limit for of_row in axes[1:] for limit in of_row[0].get_ylim()]
        for of_row in axes[1:]:
            of_row[0].set_ylim(min(limits), max(limits))
        widths = [limit for of_row in axes[1:] for panel_axes in of_row for limit in panel_axes.get_xlim()]
        for panel_axes in axes[1:].flat if published else ():
            panel_axes.set_xlim(min(widths), max(widths))
    for panel_axes in axes.flat:
        style.set_log_ticks(panel_axes.yaxis)
        style.set_log_ticks(panel_axes.xaxis)
    for panel_axes in axes[:, 0]:
        panel_axes.set_ylabel(family.error_titles.get(problem, "error"))
    for panel_axes in axes[-1]:
        panel_axes.set_xlabel(family.time_label)
    for panel_axes in axes[0]:
        _clear_labels(panel_axes)
    figure.align_ylabels(axes[:, 0])
    style.heading(figure, title, details, rows[0].legend)
    width, height = figure.get_size_inches()
    for row, top in list(zip(rows, tops))[1:]:
        y = top + (_BETWEEN_ROWS - 0.17) / height
        figure.text(0.1 / width, y, row.title, fontsize=9, fontweight="bold", va="top")
        style.draw_legend(figure, y, row.legend)
    return figure
