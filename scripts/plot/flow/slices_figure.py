"""Figures of a flow in a plane: one panel per quantity, with streamlines, in true proportion; and its animation."""

from dataclasses import dataclass

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator

from .. import style
from ..checks import check_caption
from ..movie_file import drawn_frames
from ..run_directory import Snapshot, evenly_spaced
from ..style import plt
from .plane import AXES, Plane
from .quantities import Quantity
from .sheets import sheet_section
from .streamlines import Streamlines

MAX_FRAMES = 60
_DPI = 100
_BRIGHT = 99.5  # percentile of the values at the ends of a colour scale
_MOVIE_COLOURS = 96  # of a colour map, since a GIF has 256 with those of the text
_ONE_SIGN = 0.02  # part of the largest size up to which values of the other sign do not count
# Inches.
_LONG, _AREA = 4.6, 6.0  # longest edge of a panel, and its area at most
_LEFT, _KEY, _KEY_GAP, _KEY_LABELS = 0.62, 0.11, 0.08, 0.62
_ABOVE, _BELOW, _HEADING = 0.3, 0.45, 0.5
_SHAPE = 1.5  # width over height that a figure of several panels comes nearest to
_EMPTY = 0.7  # logarithm of the width over height that an empty place among the panels counts as much as


@dataclass(frozen=True)
class View:
    """A plane and the quantities to draw in it."""

    plane: Plane
    quantities: list[Quantity]

    def caption(self, snapshot: Snapshot) -> str:
        """Cells, place of a slice, time (s) and the first check of the run."""
        check = check_caption(self.plane.run.result)
        return f"{self.plane.description}, t = {snapshot.time:.4g} s{check}"


def colour_scale(quantity: Quantity, values: np.ndarray) -> tuple[Normalize, str, str]:
    """Range, name of the colour map, and which of its ends (`neither`, `min`, `max`, `both`) are exceeded.

    Values of both signs get a diverging map that is symmetric about 0. A few extreme values lie beyond the range.
    """
    finite = values[np.isfinite(values)]
    if not finite.size:
        return Normalize(0, 1), "viridis", "neither"
    least, largest = float(finite.min()), float(finite.max())
    size = max(abs(least), abs(largest))
    if largest - least <= 1e-9 * size:  # round-off must not look like variation
        margin = 0.1 * size or 1.0
        return Normalize(least - margin, largest + margin), "viridis", "neither"
    if quantity.is_deviation or (least < -_ONE_SIGN * size and largest > _ONE_SIGN * size):
        high = style.scale_end(np.abs(finite), _BRIGHT, size, 0.0)
        low, name = -high, "RdBu_r"
    else:
        middle = float(np.median(finite))
        low, high = style.scale_end(finite, 100 - _BRIGHT, least, middle), style.scale_end(finite, _BRIGHT, largest, middle)
        name = "viridis"
    margin = 0.02 * (high - low)  # a range exceeded by this little is widened instead
    low, high = (least if low - margin <= least else low), (largest if largest <= high + margin else high)
    if name == "RdBu_r":
        high = max(-low, high)
        low = -high
    ends = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}
    return Normalize(low, high), name, ends[least < low, largest > high]


def _panel_size(extent) -> tuple[float, float]:
    """Width and height of a panel in the proportion of the plane, inches."""
    width, height = extent[1] - extent[0], extent[3] - extent[2]
    scale = min(_LONG / max(width, height), np.sqrt(_AREA / (width * height)))
    return scale * width, scale * height


def draw_slice(axes, key, plane: Plane, quantity: Quantity, snapshots: list[Snapshot], colours: int):
    """Draws a quantity of the last snapshot in a plane with its colour bar in the axes `key`; returns the image.

    The colour scale fits all `snapshots`.
    """
    every = np.concatenate([plane.at(snapshot).cut(quantity.values(snapshot)).ravel() for snapshot in snapshots])
    norm, name, ends = colour_scale(quantity, every)
    image = axes.imshow(
        plane.at(snapshots[-1]).pixels(quantity.values(snapshots[-1])), origin="lower", extent=plane.extent, aspect="auto",
        cmap=plt.get_cmap(name, colours), norm=norm, interpolation="nearest",
    )
    axes.grid(False)
    axes.set_title(style.axis_label(quantity.label, quantity.units), pad=5)
    right, up = plane.across
    axes.set_xlabel(style.axis_label(AXES[right], "m"), labelpad=2)
    axes.set_ylabel(style.axis_label(AXES[up], "m"), labelpad=2)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
    colorbar = axes.figure.colorbar(image, cax=key, extend=ends, extendfrac=0.04)
    colorbar.outline.set_visible(False)
    return image


class SheetOutline:
    """Bodies and flags where a plane cuts them, as black lines."""

    def __init__(self, axes, plane: Plane):
        self._plane = plane
        self._lines = LineCollection([], colors="black", linewidth=1.2, zorder=2.6, capstyle="round")
        if plane.run.sheet_meshes:
            axes.add_collection(self._lines, autolim=False)

    def show(self, snapshot: Snapshot) -> None:
        """Replaces the lines by those at the time of a snapshot."""
        plane = self._plane.at(snapshot)
        segments = sheet_section(plane.run, snapshot, plane.normal, plane.place)
        self._lines.set_segments(segments[..., list(plane.across)])


class SlicesFigure:
    """Figure that shows one snapshot at a time; colour scales fit all `snapshots`."""

    def __init__(self, view: View, snapshots: list[Snapshot], colours: int = 256):
        self._view, self._colours = view, colours
        self._images, self._streamlines = [], []
        width, height = _panel_size(view.plane.extent)
        cell = (_LEFT + width + _KEY_GAP + _KEY + _KEY_LABELS, _ABOVE + height + _BELOW)
        count = len(view.quantities)

        def misfit(columns):
            rows = -(-count // columns)
            shape = columns * cell[0] / (rows * cell[1])
            return abs(np.log(shape / _SHAPE)) + _EMPTY * (rows * columns - count)

        columns = min(range(1, count + 1), key=misfit)
        rows = -(-count // columns)
        longest = max((view.caption(snapshot) for snapshot in snapshots), key=len)
        size = (columns * cell[0], rows * cell[1] + _HEADING)
        self.figure = plt.figure(figsize=size, dpi=_DPI)
        # A narrow plane may be narrower than the subtitle.
        size = (max(size[0], style.subtitle_width(self.figure, longest)), size[1])
        self.figure.set_figwidth(size[0])
        for k, quantity in enumerate(view.quantities):
            left = _LEFT + (k % columns) * cell[0]
            bottom = size[1] - _HEADING - (k // columns) * cell[1] - _ABOVE - height

            def inches(x, y, w, h):
                return self.figure.add_axes((x / size[0], y / size[1], w / size[0], h / size[1]))

            panel = inches(left, bottom, width, height)
            self._add_panel(panel, inches(left + width + _KEY_GAP, bottom, _KEY, height), quantity, snapshots)
        self._caption = style.heading(self.figure, view.plane.run.name, "")

    def _add_panel(self, axes, key, quantity: Quantity, snapshots: list[Snapshot]) -> None:
        image = draw_slice(axes, key, self._view.plane, quantity, snapshots, self._colours)
        self._images.append((quantity, image, SheetOutline(axes, self._view.plane)))
        if quantity.name == "speed":
            self._streamlines.append(Streamlines(axes, self._view.plane))

    def show(self, snapshot: Snapshot) -> None:
        """Replaces the drawn data by those of a snapshot."""
        for quantity, image, outline in self._images:
            outline.show(snapshot)
            image.set_data(self._view.plane.pixels(quantity.values(snapshot)))
        for streamlines in self._streamlines:
            streamlines.show(snapshot)
        self._caption.set_text(self._view.caption(snapshot))


def slices_figure(view: View, snapshot: Snapshot):
    """Figure of one snapshot."""
    drawing = SlicesFigure(view, [snapshot])
    drawing.show(snapshot)
    return drawing.figure


def frames(view: View):
    """Generator of frames, (height, width, 3) bytes each, of at most MAX_FRAMES evenly spaced snapshots."""
    chosen = evenly_spaced(view.plane.run.snapshots, MAX_FRAMES)
    return drawn_frames(SlicesFigure(view, chosen, _MOVIE_COLOURS), chosen)
