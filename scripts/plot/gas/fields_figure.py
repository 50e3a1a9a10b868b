"""Figures of a gas run: fields with exact solution and pointwise error, and space-time maps."""

from dataclasses import dataclass

import numpy as np
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import MaxNLocator, NullFormatter

from .. import style
from ..checks import check_label, failure_caption
from ..run_directory import Run, Snapshot
from ..style import plt
from .exact_solution import WENO_NAMES, ExactSolution, pointwise_errors

_NORMS = {"rho": "density", "u": "velocity", "p": "pressure"}
_MAX_MARKERS = 250  # above this number of cells, markers would overlap and a line is drawn


@dataclass(frozen=True)
class View:
    """A run, the fields to draw, and the exact solution if one is known."""

    run: Run
    fields: list[str]
    exact: ExactSolution | None

    @property
    def x(self) -> np.ndarray:
        return self.run.mesh["x"].values

    @property
    def domain(self) -> tuple[float, float]:
        """Interval of the mesh: half a cell beyond the outermost cell centres."""
        half = 0.5 * (self.x[-1] - self.x[0]) / (len(self.x) - 1)
        return self.x[0] - half, self.x[-1] + half

    @property
    def has_markers(self) -> bool:
        return len(self.x) <= _MAX_MARKERS

    @property
    def x_label(self) -> str:
        return style.axis_label("x", self.run.mesh["x"].units or "m")


def scheme_name(scene: dict) -> str:
    """Display name of the reconstruction scheme of a scene."""
    scheme = scene.get("scheme", {})
    name = scheme.get("weno", "z")
    name = WENO_NAMES.get(name, name)
    return f"{name} (p = 2)" if name == "WENO-Z" and scheme.get("weno_power", 1) == 2 else name


def subtitle(view: View, time: float) -> str:
    """Scheme, number of cells, time (s), and the check that failed."""
    failed = failure_caption(view.run.result)
    return f"{scheme_name(view.run.scene)}, {len(view.x)} cells, t = {time:.4g} s{failed}"


def legend(view: View, shows_exact: bool) -> list[tuple[str, str, str]]:
    """Entries (marker, label, colour) of the run and, if shown, the exact solution."""
    entries = [("\u25cb" if view.has_markers else "\u2014", scheme_name(view.run.scene), style.RUN_COLOUR)]
    if shows_exact:
        entries.append(("\u2014", view.exact.name, style.INK))
    return entries


class FieldPanel:
    """Axes of one field: values of the run in front of the exact curve, if one is known."""

    def __init__(self, axes, view: View, name: str):
        self._view, self._name = view, name
        (self._exact,) = axes.plot([], [], color=style.INK, linewidth=0.9, zorder=2)
        if view.has_markers:
            (self._run,) = axes.plot(
                [], [], "o", color=style.RUN_COLOUR, markersize=2.8, markerfacecolor="white", markeredgewidth=0.8,
                zorder=3, clip_on=False,
            )
        else:
            (self._run,) = axes.plot([], [], color=style.RUN_COLOUR, linewidth=1.1, zorder=3)
        axes.set_title(style.axis_label(name, view.run.snapshots[-1].fields[name].units), pad=5)
        axes.set_xlim(*view.domain)
        axes.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))

    @property
    def artists(self):
        return [self._exact, self._run]

    def show(self, snapshot: Snapshot) -> None:
        """Replaces the drawn data by those of a snapshot."""
        view, name = self._view, self._name
        self._run.set_data(*style.decimate(view.x, snapshot.fields[name].values))
        if view.exact:
            x, values = view.exact.curve(snapshot.time, view.x)
            self._exact.set_data(*style.decimate(x, values[name]) if name in values else ([], []))


def _needs_log_scale(name: str, low: float, high: float) -> bool:
    """Whether positive values span three decades. Always false for velocity, which is a signed quantity."""
    return name != "u" and low > 0 and high >= 999 * low


_LEAST_EXACT = 1e-6  # of the largest value: in a vacuum an exact value may be 1e-80


def set_range(axes, name: str, arrays, exact=()) -> None:
    """Sets the vertical range to the values of `arrays` and of the arrays `exact`, but far below those of `arrays` they leave
    it; logarithmic if positive and spanning three decades.
    """
    low = min(float(np.nanmin(values)) for values in arrays)
    high = max(float(np.nanmax(values)) for values in (*arrays, *exact))
    least = min((float(np.nanmin(values)) for values in exact), default=low)
    low = min(low, max(least, _LEAST_EXACT * high) if 0 < least else least)
    if _needs_log_scale(name, low, high):
        axes.set_yscale("log")
        margin = (high / low) ** 0.06
        axes.set_ylim(low / margin, high * margin)
        return
    margin = 0.06 * (high - low)
    if high - low <= 1e-9 * max(abs(high), abs(low)):
        # A constant field gets a wide range, so that round-off does not look like variation.
        margin = 0.1 * abs(high) or 1.0
    axes.set_ylim(low - margin, high + margin)


def _format_checks(run: Run) -> str:
    """Values and tolerances of the checks that passed, for a figure without an error panel."""
    return "".join(
        f";  {check_label(check['name'])} {style.format_number(check['value'])} "
        f"(tolerance {style.format_number(check['tolerance'])})"
        for check in run.result.get("checks", [])
        if check["name"] != "conservation" and check["value"] is not None and check["passed"]
    )


def _error_title(run: Run, name: str) -> str:
    norm = f"l1_{_NORMS.get(name, name)}"
    value = run.result.get("errors", {}).get(norm)
    if value is None:
        return "|error|"
    tolerances = [check["tolerance"] for check in run.result.get("checks", []) if check["name"] == norm]
    # Columns are narrow.
    relation = r"$\leq$" if tolerances and value <= tolerances[0] else "$>$"
    tolerance = f" {relation} {style.format_number(tolerances[0])}" if tolerances else ""
    return rf"|error|,  $L_1$ = {style.format_number(value)}{tolerance}"


def _draw_error(axes, view: View, snapshot: Snapshot, name: str, error: np.ndarray, title: str) -> None:
    axes.set_title(title, fontsize=8, pad=4)
    size = np.abs(error)
    top = np.nanmax(size)
    if not top > 1e-12 * np.nanmax(np.abs(snapshot.fields[name].values)):
        words = f"round-off, {style.format_number(top)}" if top > 0 else "exactly 0"
        axes.set_yticks([])
        axes.text(0.5, 0.5, words, transform=axes.transAxes, ha="center", va="center", color=style.MUTED)
        return
    # The axis spans between two and eight decades.
    floor = np.clip(np.min(size[size > 0]), 1e-8 * top, 1e-2 * top)
    shown = np.where(size > 0, np.maximum(size, floor), np.nan)
    axes.plot(*style.decimate(view.x, shown), color=style.ERROR_COLOUR, linewidth=0.9)
    axes.set_yscale("log")
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_ylim(floor / 2, top * 3)


def fields_figure(view: View, snapshot: Snapshot):
    """Figure with one column per field: values above, and pointwise error below if the exact value is known."""
    error = pointwise_errors(view.run, snapshot, view.exact)
    shows_exact = any(name in error for name in view.fields)
    rows, heights = (2, [2.1, 1]) if shows_exact else (1, [1])
    columns = len(view.fields)
    height = 4.1 if shows_exact else 2.9
    width = max(3.5, 2.55 * columns + 0.4)
    figure, axes = plt.subplots(
        rows, columns, figsize=(width, height), sharex=True, squeeze=False, height_ratios=heights
    )
    final = snapshot is view.run.snapshots[-1]
    for column, name in enumerate(view.fields):
        FieldPanel(axes[0][column], view, name).show(snapshot)
        curve = view.exact.curve(snapshot.time, view.x)[1] if view.exact else {}
        set_range(axes[0][column], name, [snapshot.fields[name].values], [curve[name]] if name in curve else [])
        if name in error:
            title = _error_title(view.run, name) if final else "|error|"
            _draw_error(axes[1][column], view, snapshot, name, error[name], title)
        elif shows_exact:
            axes[1][column].set_axis_off()
        axes[-1][column].set_xlabel(view.x_label)
    words = subtitle(view, snapshot.time)
    if final and not shows_exact:
        words += _format_checks(view.run)
    # A single column may be narrower than the subtitle.
    figure.set_figwidth(max(width, style.subtitle_width(figure, words)))
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.48 / height), h_pad=0.6, w_pad=1.4)
    style.heading(figure, view.run.name, words, legend(view, shows_exact))
    return figure


def _edges(centres: np.ndarray) -> np.ndarray:
    """Cell edges from cell centres."""
    middle = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate([[2 * centres[0] - middle[0]], middle, [2 * centres[-1] - middle[-1]]])


def space_time_figure(view: View, name: str):
    """Map of a field over x and t."""
    snapshots = view.run.snapshots
    times = np.array([snapshot.time for snapshot in snapshots])
    values = np.array([snapshot.fields[name].values for snapshot in snapshots])
    stride = max(1, len(view.x) // 1600)
    x, values = view.x[::stride], values[:, ::stride]
    figure, axes = plt.subplots(figsize=(4.6, 3.6))
    edges = _edges(times)
    edges[0], edges[-1] = times[0], times[-1]
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    norm = LogNorm(low, high) if _needs_log_scale(name, low, high) else Normalize(low, high)
    image = axes.pcolormesh(_edges(x), edges, values, cmap="viridis", norm=norm, rasterized=True)
    axes.grid(False)
    item = snapshots[-1].fields[name]
    colorbar = figure.colorbar(image, ax=axes, pad=0.03, aspect=28)
    colorbar.outline.set_visible(False)
    colorbar.ax.set_title(style.axis_label(name, item.units), fontsize=8.5, pad=6, loc="center")
    axes.set_xlabel(view.x_label)
    axes.set_ylabel("time (s)")
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.48 / 3.6))
    words = f"{scheme_name(view.run.scene)}, {len(view.x)} cells{failure_caption(view.run.result)}"
    style.heading(figure, view.run.name, words)
    return figure
