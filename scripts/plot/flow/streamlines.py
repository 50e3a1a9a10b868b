"""Streamlines of the velocity in a plane, which start at the same places at all times."""

import numpy as np

from ..run_directory import Snapshot
from .plane import Plane

_SPACING = 0.14  # inches


class Streamlines:
    """White streamlines in axes that show a part of a plane in true proportion, at one time."""

    def __init__(self, axes, plane: Plane):
        self._axes, self._plane, self._items = axes, plane, []
        left, right, low, high = axes.axis()
        width, height = right - left, high - low
        scale = width / (axes.get_position().width * axes.figure.get_figwidth())  # m per inch
        columns, rows = (max(1, round(length / (_SPACING * scale))) for length in (width, height))
        # Matplotlib lets one line at most enter each of 30 x 30 rectangles of the plane, times this density.
        extent = plane.extent
        self._density = (columns / 30 * (extent[1] - extent[0]) / width, rows / 30 * (extent[3] - extent[2]) / height)
        x, y = (np.arange(columns) + 0.5) / columns, (np.arange(rows) + 0.5) / rows
        seeds = np.stack(np.meshgrid(left + x * width, low + y * height), axis=-1)
        # Lines from the sides come first, so that they have even distances where they enter.
        inner = np.zeros((rows, columns), bool)
        inner[1:-1, 1:-1] = True
        self._seeds = np.concatenate((seeds[~inner], seeds[inner]))

    def show(self, snapshot: Snapshot) -> None:
        """Replaces the lines; there are none if the velocity is zero or not finite, or the plane is a narrow strip."""
        for item in self._items:
            item.remove()
        self._items = []
        x, y = self._plane.centres
        if min(len(x), len(y)) < 2 or 30 * min(self._density) < 2:
            return
        velocity = snapshot.fields["velocity"].values
        plane = self._plane.at(snapshot)
        (x, y, u), (_, _, v) = (plane.equidistant(velocity[..., axis]) for axis in plane.across)
        if not (np.isfinite(u).all() and np.isfinite(v).all()) or not np.any(u) and not np.any(v):
            return
        inside = (self._seeds >= (x[0], y[0])) & (self._seeds <= (x[-1], y[-1]))
        limits, others = self._axes.axis(), len(self._axes.patches)
        drawn = self._axes.streamplot(
            x, y, u, v, color="white", linewidth=0.6, arrowsize=0.6, density=self._density,
            start_points=self._seeds[inside.all(axis=1)],
        )
        self._axes.axis(limits)
        self._items = [drawn.lines, *self._axes.patches[others:]]
