"""Picture of work and precision: error against time to solution, a column a backend."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import style
from .evidence_solution import Curve
from .options_marks import Mark
from .perf_record import BACKENDS, Machine
from .solution_family import Family
from .style import plt

# line, marker, how the key shows them, by the place of a second setting in its family
_LINES = (("-", "o", "\u2014\u25cb"), ("--", "v", "\u2013 \u2013 \u25bd"))
_OTHER_LINE = (":", "s", "\u2026\u25a1")
_PANEL_WIDTH, _SCHEMES_HEIGHT, _SETTINGS_HEIGHT = 2.75, 2.5, 2.0  # inches of an axes
_LEFT, _BOTTOM, _HEADING, _GAP, _RIGHT, _BETWEEN_ROWS = 0.95, 0.45, 0.72, 0.2, 0.15, 0.62
_TICKS = 0.16  # what the labels of an axis of its own take


def _colour(family: Family, word: str) -> str:
    if word == family.competitor:
        return style.INK
    return _place_colour(list(family.names), word)


def _place_colour(known: list[str], word: str) -> str:
    return style.PALETTE[known.index(word) % len(style.PALETTE)] if word in known else style.MUTED


def _line(family: Family, second: str) -> tuple[str, str, str]:
    known = list(family.seconds)
    return _LINES[known.index(second)] if second in known else _OTHER_LINE


def _draw(axes, curve: Curve, colour: str, line: str, marker: str) -> None:
    axes.plot(
        curve.points[:, 1], curve.points[:, 2], line + marker, color=colour, markersize=3.6, markerfacecolor="white",
        markeredgewidth=0.9, linewidth=1.2, zorder=3 if curve.scheme.is_competitor else 2,
    )  # fmt: skip


def _draw_scheme(axes, curve: Curve) -> None:
    scheme = curve.scheme
    _draw(axes, curve, _colour(scheme.family, scheme.word), "--" if scheme.is_competitor else "-", "o")


def _draw_variant(axes, curve: Curve) -> None:
    family, (first, second, *_) = curve.scheme.family, curve.scheme.settings
    line, marker, _ = _line(family, second)
    _draw(axes, curve, _place_colour(list(family.firsts), first), line, marker)


def _column_of(mark: Mark, columns: list[str]) -> str | None:
    """The backend beside which a mark stands; what is no GPU's may stand in the first column."""
    if mark.on in columns:
        return mark.on
    return None if mark.on == "cuda" else columns[0]


def _draw_marks(axes, marks: list[Mark]) -> None:
    for mark in marks:
        x, y = zip(*mark.points)
        axes.plot(x, y, ":D", color=style.MUTED, markersize=3.4, linewidth=0.8, zorder=1)
        # Of several points above the first, of one below it.
        shift, side = (5, "bottom") if len(x) > 1 else (-5, "top")
        axes.annotate(
            mark.label, mark.points[0], (0, shift), textcoords="offset points", ha="center", va=side, fontsize=6.5,
            color=style.MUTED, bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.85},
        )  # fmt: skip


def _scheme_key(curves: list[Curve]) -> list[tuple[str, str, str]]:
    family, present = curves[0].scheme.family, {curve.scheme.word for curve in curves}
    ordered = [word for word in family.names if word in present] + sorted(present - set(family.names))
    return [
        (
            "\u2013 \u2013" if word == family.competitor else "\u2014",
            family.names.get(word, word),
            _colour(family, word),
        )
        for word in ordered
    ]


def _variant_key(curves: list[Curve]) -> list[tuple[str, str, str]]:
    """Colours of the first settings, lines of the second; of a setting that does not vary nothing."""
    if not curves:
        return []
    family = curves[0].scheme.family
    firsts, seconds = (list(dict.fromkeys(curve.scheme.settings[axis] for curve in curves)) for axis in range(2))
    key = [
        ("\u2014", family.words.get(word, word), _place_colour(list(family.firsts), word))
        for word in firsts
        if len(firsts) > 1
    ]
    for word in seconds if len(seconds) > 1 else ():
        key.append((_line(family, word)[2], family.seconds.get(word, word), style.INK))
    return key


@dataclass(frozen=True)
class _Row:
    """One row of panels: what stands above it at the left and at the right, what it draws, its height in inches."""

    title: str
    key: list[tuple[str, str, str]]
    curves: list[Curve]
    draw: Callable
    height: float


def _rows(title: str, found: list[Curve], best: str | None) -> list[_Row]:
    usual = [curve for curve in found if curve.scheme.is_usual]
    rows = [_Row(title, _scheme_key(usual), usual, _draw_scheme, _SCHEMES_HEIGHT)]
    variants = [curve for curve in found if best and curve.scheme.word == best]
    for of_row in dict.fromkeys(curve.scheme.row for curve in variants):
        drawn = [curve for curve in variants if curve.scheme.row == of_row]
        family = drawn[0].scheme.family
        of_third = family.rows.get(of_row, family.words.get(of_row, of_row))
        words = ", ".join(filter(None, (family.names.get(best, best), of_third)))
        rows.append(_Row(words, _variant_key(variants), drawn, _draw_variant, _SETTINGS_HEIGHT))
    return rows


def _make_room(figure, rows: list[_Row], axes, details: str, between: float) -> list[float]:
    """Sizes a figure for its panels, keys and heading; returns the top of every row's axes as a share of the height."""
    columns = axes.shape[1]
    keys = [style.titled_key_width(figure, row.title, row.key) for row in rows]
    panels = _LEFT + (_PANEL_WIDTH + _GAP) * columns - _GAP + _RIGHT
    width = max(panels, style.details_width(figure, details), *keys)
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


def solution_figure(problem: str, machine: Machine, found: list[Curve], best: str | None, threads: str):
    """All schemes with the usual settings above, below it the settings of the best scheme, a row a precision.

    Wants a curve with the usual settings; with `best` None there are no other rows.
    """
    family = found[0].scheme.family
    title = family.problems.get(problem, problem)
    rows = _rows(title, found, best)
    columns = list(dict.fromkeys(curve.scheme.backend for row in rows for curve in row.curves))
    # What others reach may be far off: the settings keep a scale of their own.
    marks = [mark for mark in family.marks if mark.problem == problem]
    figure, axes = plt.subplots(
        len(rows), len(columns), sharex="row" if marks else True, sharey="row", squeeze=False
    )
    details = f"{family.usual_words}; {machine.name}"
    tops = _make_room(figure, rows, axes, details, _BETWEEN_ROWS + (_TICKS if marks else 0.0))
    for row, of_row in zip(rows, axes):
        for panel_axes, backend in zip(of_row, columns):
            for curve in row.curves:
                if curve.scheme.backend == backend:
                    row.draw(panel_axes, curve)
            if row is rows[0]:
                _draw_marks(panel_axes, [mark for mark in marks if _column_of(mark, columns) == backend])
            panel_axes.set_title(BACKENDS.get(backend, backend) + (threads if backend == "openmp" else ""), pad=4)
            panel_axes.set_xscale("log")
            panel_axes.set_yscale("log")
    if len(rows) > 2:
        # All settings on one scale, so that they can be compared.
        limits = [limit for of_row in axes[1:] for limit in of_row[0].get_ylim()]
        for of_row in axes[1:]:
            of_row[0].set_ylim(min(limits), max(limits))
        widths = [limit for of_row in axes[1:] for panel_axes in of_row for limit in panel_axes.get_xlim()]
        for panel_axes in axes[1:].flat if marks else ():
            panel_axes.set_xlim(min(widths), max(widths))
    for panel_axes in axes.flat:
        style.mark_logarithm(panel_axes.yaxis)
        style.mark_logarithm(panel_axes.xaxis)
    for panel_axes in axes[:, 0]:
        panel_axes.set_ylabel(family.error_titles.get(problem, "error"))
    for panel_axes in axes[-1]:
        panel_axes.set_xlabel(family.time)
    figure.align_ylabels(axes[:, 0])
    style.heading(figure, title, details, rows[0].key)
    width, height = figure.get_size_inches()
    for row, top in list(zip(rows, tops))[1:]:
        y = top + (_BETWEEN_ROWS - 0.17) / height
        figure.text(0.1 / width, y, row.title, fontsize=9, fontweight="bold", va="top")
        style.curve_key(figure, y, row.key)
    return figure
