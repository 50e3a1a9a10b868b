"""Picture of work and precision: error against time to solution, a column a backend."""

from collections.abc import Callable
from dataclasses import dataclass

from . import style
from .evidence_solution import COMPETITOR, NAMES, Curve
from .perf_record import BACKENDS, Machine
from .study_figure import TITLES
from .style import plt

_SPLITTINGS = dict(zip(("lf-stencil", "lf-global", "lf-single"), style.PALETTE))
# line, marker, how the key shows them, name
_TIMES = {"ssprk3": ("-", "o", "\u2014\u25cb", "SSP-RK3"), "ssprk43": ("--", "v", "\u2013 \u2013 \u25bd", "SSPRK(4,3)")}
_OTHER_TIME = (":", "s", "\u2026\u25a1")
_PANEL_WIDTH, _SCHEMES_HEIGHT, _SETTINGS_HEIGHT = 2.75, 2.5, 2.0  # inches of an axes
_LEFT, _BOTTOM, _HEADING, _GAP, _RIGHT, _BETWEEN_ROWS = 0.95, 0.45, 0.72, 0.2, 0.15, 0.62


def _colour(weno: str) -> str:
    if weno == COMPETITOR:
        return style.INK
    names = list(NAMES)
    return style.PALETTE[names.index(weno) % len(style.PALETTE)] if weno in NAMES else style.MUTED


def _draw(axes, curve: Curve, colour: str, line: str, marker: str) -> None:
    axes.plot(
        curve.points[:, 1], curve.points[:, 2], line + marker, color=colour, markersize=3.6, markerfacecolor="white",
        markeredgewidth=0.9, linewidth=1.2, zorder=3 if curve.scheme.weno == COMPETITOR else 2,
    )  # fmt: skip


def _draw_scheme(axes, curve: Curve) -> None:
    _draw(axes, curve, _colour(curve.scheme.weno), "--" if curve.scheme.weno == COMPETITOR else "-", "o")


def _draw_variant(axes, curve: Curve) -> None:
    splitting, time_scheme, _ = curve.scheme.settings
    line, marker, *_ = _TIMES.get(time_scheme, _OTHER_TIME)
    _draw(axes, curve, _SPLITTINGS.get(splitting, style.MUTED), line, marker)


def _scheme_key(curves: list[Curve]) -> list[tuple[str, str, str]]:
    present = {curve.scheme.weno for curve in curves}
    ordered = [weno for weno in NAMES if weno in present] + sorted(present - set(NAMES))
    return [
        ("\u2013 \u2013" if weno == COMPETITOR else "\u2014", NAMES.get(weno, weno), _colour(weno)) for weno in ordered
    ]


def _variant_key(curves: list[Curve]) -> list[tuple[str, str, str]]:
    """Colours of the splittings, lines of the time schemes; of a setting that does not vary nothing."""
    splittings, times = (list(dict.fromkeys(curve.scheme.settings[axis] for curve in curves)) for axis in range(2))
    key = [("\u2014", word, _SPLITTINGS.get(word, style.MUTED)) for word in splittings if len(splittings) > 1]
    for word in times if len(times) > 1 else ():
        _, _, shown, name = _TIMES.get(word, (*_OTHER_TIME, word))
        key.append((shown, name, style.INK))
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
    variants = [curve for curve in found if best and curve.scheme.weno == best]
    for precision in dict.fromkeys(curve.scheme.precision for curve in variants):
        drawn = [curve for curve in variants if curve.scheme.precision == precision]
        words = f"{NAMES.get(best, best)}, {precision} precision"
        rows.append(_Row(words, _variant_key(variants), drawn, _draw_variant, _SETTINGS_HEIGHT))
    return rows


def _make_room(figure, rows: list[_Row], axes, details: str) -> list[float]:
    """Sizes a figure for its panels, keys and heading; returns the top of every row's axes as a share of the height."""
    columns = axes.shape[1]
    keys = [style.titled_key_width(figure, row.title, row.key) for row in rows]
    panels = _LEFT + (_PANEL_WIDTH + _GAP) * columns - _GAP + _RIGHT
    width = max(panels, style.details_width(figure, details), *keys)
    height = _HEADING + sum(row.height for row in rows) + _BETWEEN_ROWS * (len(rows) - 1) + _BOTTOM
    figure.set_size_inches(width, height)
    panel = (width - _LEFT - _RIGHT - _GAP * (columns - 1)) / columns
    tops, top = [], height - _HEADING
    for row, of_row in zip(rows, axes):
        for column, panel_axes in enumerate(of_row):
            left = _LEFT + column * (panel + _GAP)
            panel_axes.set_position((left / width, (top - row.height) / height, panel / width, row.height / height))
        tops.append(top / height)
        top -= row.height + _BETWEEN_ROWS
    return tops


def solution_figure(title: str, machine: Machine, found: list[Curve], best: str | None, threads: str):
    """All schemes with the usual settings above, below it the settings of the best scheme, a row a precision.

    Wants a curve with the usual settings; with `best` None there are no other rows.
    """
    rows = _rows(title, found, best)
    columns = list(dict.fromkeys(curve.scheme.backend for row in rows for curve in row.curves))
    figure, axes = plt.subplots(len(rows), len(columns), sharex=True, sharey="row", squeeze=False)
    details = f"lf-stencil, SSP-RK3, double precision; {machine.name}"
    tops = _make_room(figure, rows, axes, details)
    for row, of_row in zip(rows, axes):
        for panel_axes, backend in zip(of_row, columns):
            for curve in row.curves:
                if curve.scheme.backend == backend:
                    row.draw(panel_axes, curve)
            panel_axes.set_title(BACKENDS.get(backend, backend) + (threads if backend == "openmp" else ""), pad=4)
            panel_axes.set_xscale("log")
            panel_axes.set_yscale("log")
    if len(rows) > 2:
        # Both precisions on one scale, so that they can be compared.
        limits = [limit for of_row in axes[1:] for limit in of_row[0].get_ylim()]
        for of_row in axes[1:]:
            of_row[0].set_ylim(min(limits), max(limits))
    for panel_axes in axes.flat:
        style.mark_logarithm(panel_axes.yaxis)
        style.mark_logarithm(panel_axes.xaxis)
    for panel_axes in axes[:, 0]:
        panel_axes.set_ylabel(TITLES["l1_density"])
    for panel_axes in axes[-1]:
        panel_axes.set_xlabel("time to solution (s)")
    figure.align_ylabels(axes[:, 0])
    style.heading(figure, title, details, rows[0].key)
    width, height = figure.get_size_inches()
    for row, top in list(zip(rows, tops))[1:]:
        y = top + (_BETWEEN_ROWS - 0.17) / height
        figure.text(0.1 / width, y, row.title, fontsize=9, fontweight="bold", va="top")
        style.curve_key(figure, y, row.key)
    return figure
