"""Evenly spaced streamlines of the velocity in a plane, which start at the same places at all times.

Places x, y in the plane are complex numbers x + iy, m, and so are velocities.
"""

from dataclasses import dataclass

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from ..run_directory import Snapshot
from .plane import Plane

# Inches.
_SPACING = 0.14
_STEP = 0.03  # of the integration along a line
_SHORTEST = 0.5
_ARROW, _ARROW_DISTANCE = 0.04, 1.2  # half a length, and distance along a line
_STILL = 1e-3  # part of the largest speed at which a line ends
_Z_ORDER = 2.2  # above the image, below bodies, cloth and its lines
_PLASTIC = 1.32471795724474602596  # root of x^3 = x + 1


@dataclass(frozen=True)
class Line:
    """Points (n) of a streamline, the index of its seed among them, and the number of the seed in its window."""

    points: np.ndarray
    start: int
    seed: int


class Window:
    """Part of a plane, (left, right, lower, upper end), in rectangles of about `spacing` that one line at most enters.

    Each has a seed. The first `rim` seeds are those along the sides, for lines with even distances where they enter;
    all others follow in an order that spreads them at any time (the R2 sequence of M. Roberts, 2018).
    """

    def __init__(self, ends: tuple[float, float, float, float], spacing: float):
        self._low, self._size = complex(ends[0], ends[2]), (ends[1] - ends[0], ends[3] - ends[2])
        self._columns, self._rows = (max(1, round(length / spacing)) for length in self._size)
        self.diagonal = np.hypot(self._size[0] / self._columns, self._size[1] / self._rows)
        count = self._columns * self._rows
        row, column = np.divmod(np.arange(count), self._columns)
        is_rim = (row == 0) | (row == self._rows - 1) | (column == 0) | (column == self._columns - 1)
        sequence = np.arange(1, 8 * count + 1)[:, None] / _PLASTIC ** np.array([1, 2]) % 1
        visited, first = np.unique(self._number(*sequence.T), return_index=True)
        order = np.full(count, len(sequence))
        order[visited] = first
        order[is_rim] = -1
        x, y = (column + 0.5) / self._columns * self._size[0], (row + 0.5) / self._rows * self._size[1]
        self.seeds = (self._low + x + 1j * y)[np.argsort(order, kind="stable")]
        self.rim = int(is_rim.sum())
        self.longest = sum(self._size)  # of the part of a line on one side of its seed, m

    def _number(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Numbers of the rectangles at parts x and y, 0 to 1, of the width and height."""
        row, column = np.minimum(y * self._rows, self._rows - 1), np.minimum(x * self._columns, self._columns - 1)
        return row.astype(int) * self._columns + column.astype(int)

    def _parts(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places as parts of the width and height."""
        return (points.real - self._low.real) / self._size[0], (points.imag - self._low.imag) / self._size[1]

    def rectangles(self, points: np.ndarray) -> np.ndarray:
        """Numbers of the rectangles in which points of the window lie."""
        return self._number(*self._parts(points))

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Whether points lie in the window."""
        x, y = self._parts(points)
        return (x >= 0) & (x <= 1) & (y >= 0) & (y <= 1)


class Direction:
    """Direction of a velocity (rows, columns) between cell centres x and y with even distances, bilinear."""

    def __init__(self, x: np.ndarray, y: np.ndarray, velocity: np.ndarray):
        self._first, self._spacing = (x[0], y[0]), (x[1] - x[0], y[1] - y[0])
        self._rows, self._columns = velocity.shape
        self._velocity = velocity.ravel()
        speed = np.abs(self._velocity)
        self._still = _STILL * np.max(speed[np.isfinite(speed)], initial=0)

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Unit numbers at points; 0 where the flow is still or not finite."""
        x = np.clip((points.real - self._first[0]) / self._spacing[0], 0, self._columns - 1)
        y = np.clip((points.imag - self._first[1]) / self._spacing[1], 0, self._rows - 1)
        column, row = np.minimum(x.astype(int), self._columns - 2), np.minimum(y.astype(int), self._rows - 2)
        x, y, corner = x - column, y - row, row * self._columns + column
        low = self._velocity[corner] * (1 - x) + self._velocity[corner + 1] * x
        corner += self._columns
        high = self._velocity[corner] * (1 - x) + self._velocity[corner + 1] * x
        velocity = low * (1 - y) + high * y
        speed = np.abs(velocity)
        return np.divide(velocity, speed, out=np.zeros_like(velocity), where=speed > self._still)


def _trace(direction: Direction, window: Window, seeds: np.ndarray, step: float) -> list[np.ndarray]:
    """Points of the lines from all `seeds` along the velocity, then of those against it, as far as the window."""
    most = int(window.longest / step)
    points, step = np.concatenate((seeds, seeds)), np.repeat((step, -step), len(seeds))
    going = np.arange(len(points))
    paths, counts = np.empty((len(points), most + 1), complex), np.ones(len(points), int)
    paths[:, 0] = points
    for k in range(1, most + 1):
        # The midpoint rule, of second order.
        change = step * direction(points + 0.5 * step * direction(points))
        points = points + change
        stays = window.holds(points) & (change != 0)
        points, step, going = points[stays], step[stays], going[stays]
        if not len(going):
            break
        paths[going, k] = points
        counts[going] = k + 1
    return [path[:count] for path, count in zip(paths, counts)]


def _free_part(rectangles: np.ndarray, taken: np.ndarray, most: float) -> int:
    """Number of points, of a path through `rectangles`, before it enters a taken one, or one for the second time.

    More than `most` points in one rectangle circle there, and do not count either.
    """
    entries = np.flatnonzero(np.diff(rectangles, prepend=-1))
    entered = rectangles[entries]
    ends = taken[entered]
    ends[0] = False  # the path starts there
    again = np.ones(len(entered), bool)
    again[np.unique(entered, return_index=True)[1]] = False
    ends |= again | (np.diff(entries, append=len(rectangles)) > most)
    return int(entries[ends.argmax()]) if ends.any() else len(rectangles)


def evenly_spaced_lines(direction: Direction, window: Window, step: float, shortest: float) -> list[Line]:
    """Streamlines with rectangles of their own, as those of Matplotlib have them; `shortest`: least length, m.

    The order of the seeds is fixed, so that lines differ between two times as far as the flow does.
    """
    own, taken = window.rectangles(window.seeds), np.zeros(len(window.seeds), bool)
    most, lines = 1.5 * window.diagonal / step, []
    for seeds in np.split(np.arange(len(own)), [window.rim]):
        free = seeds[~taken[own[seeds]]]
        paths = _trace(direction, window, window.seeds[free], step)
        for seed, ahead, behind in zip(free, paths, paths[len(free) :]):
            if taken[own[seed]]:
                continue
            entered, left = window.rectangles(ahead), window.rectangles(behind)
            after = _free_part(entered, taken, most)
            taken[entered[:after]] = True
            before = _free_part(left, taken, most)
            if (after + before) * step < shortest:
                taken[entered[:after]] = False
                continue
            taken[left[:before]] = True
            points = np.concatenate((behind[1:before][::-1], ahead[: max(after, 1)]))
            lines.append(Line(points, max(before - 1, 0), int(seed)))
    return lines


class Streamlines:
    """White streamlines with arrows in axes that show a part of a plane in true proportion, at one time."""

    def __init__(self, axes, plane: Plane):
        ends = axes.axis()
        self._plane = plane
        self._scale = (ends[1] - ends[0]) / (axes.get_position().width * axes.figure.get_figwidth())  # m per inch
        self._window = Window(ends, _SPACING * self._scale)
        self._lines = LineCollection([], colors="white", linewidths=0.6, zorder=_Z_ORDER)
        self._arrows = PolyCollection([], facecolors="white", edgecolors="none", zorder=_Z_ORDER)
        for item in (self._lines, self._arrows):
            axes.add_collection(item, autolim=False)

    def show(self, snapshot: Snapshot) -> None:
        """Replaces the lines by those at the time of a snapshot; there are none if the plane is a line of cells."""
        x, y = self._plane.centres
        if min(len(x), len(y)) < 2:
            return
        velocity = snapshot.fields["velocity"].values
        right, up = (self._plane.cut(velocity[..., axis]) for axis in self._plane.across)
        direction = Direction(x, y, right + 1j * up)
        lines = evenly_spaced_lines(direction, self._window, _STEP * self._scale, _SHORTEST * self._scale)
        self._lines.set_segments([np.stack((line.points.real, line.points.imag), axis=-1) for line in lines])
        self._arrows.set_verts([head for line in lines for head in self._heads(line)])

    def _heads(self, line: Line) -> list[np.ndarray]:
        """Triangles (3, 2), m, at fixed distances from the seed, which alternate along the rim."""
        distance = round(_ARROW_DISTANCE / _STEP)
        offset = distance // 4 * (1 + 2 * (line.seed % 2)) if line.seed < self._window.rim else 0
        heads = []
        for k in range((line.start + offset) % distance, len(line.points) - 1, distance):
            if k > 0:
                along = line.points[k + 1] - line.points[k - 1]
                along *= _ARROW * self._scale / abs(along)
                corners = line.points[k] + along * np.array([1, -1 + 0.7j, -1 - 0.7j])
                heads.append(np.stack((corners.real, corners.imag), axis=-1))
        return heads
