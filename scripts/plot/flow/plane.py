"""Plane through the cells of a flow: the whole of a two-dimensional run, or a slice of a three-dimensional one."""

from dataclasses import dataclass

import numpy as np

from ..failure import USAGE, Failure
from ..run_directory import Run, Snapshot

AXES = "xyz"
_MOST_PLACES = 2000  # along an axis of a stretched grid


def is_flow(run: Run) -> bool:
    """Whether the run has fields on the cells of a flow grid."""
    return bool(run.snapshots) and all(axis in run.mesh for axis in AXES)


def cell_counts(run: Run) -> tuple[int, int, int]:
    """Cells along x, y and z."""
    return tuple(len(run.mesh[axis].values) - 1 for axis in AXES)


def is_uniform(faces: np.ndarray) -> bool:
    """Whether the cells between faces have one width."""
    widths = np.diff(faces)
    return bool(np.ptp(widths) <= 1e-9 * widths.max())


def _equal_cells(faces: np.ndarray) -> int:
    """Cells of the least width along an axis."""
    return min(round(np.ptp(faces) / np.diff(faces).min()), _MOST_PLACES)


def dimension(run: Run) -> int:
    """Number of axes with more than one cell."""
    return sum(count > 1 for count in cell_counts(run))


@dataclass(frozen=True)
class Plane:
    """Layer `index` of the cells along axis `normal` (0, 1 or 2); x or y points right, y or z upwards."""

    run: Run
    normal: int
    index: int

    def at(self, snapshot: Snapshot) -> "Plane":
        """The plane at the time of a snapshot: this one, unless it moves."""
        return self

    @property
    def across(self) -> tuple[int, int]:
        """Axes that point right and upwards."""
        return tuple(axis for axis in range(3) if axis != self.normal)

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, lower and upper end of the domain in the plane, m."""
        right, up = (self.run.mesh[AXES[axis]].values for axis in self.across)
        return right[0], right[-1], up[0], up[-1]

    @property
    def centres(self) -> tuple[np.ndarray, np.ndarray]:
        """Cell centres along the axes that point right and upwards, m."""
        faces = (self.run.mesh[AXES[axis]].values for axis in self.across)
        return tuple((f[1:] + f[:-1]) / 2 for f in faces)

    @property
    def place(self) -> float:
        """Place of the plane on its axis, m."""
        faces = self.run.mesh[AXES[self.normal]].values
        return float(faces[self.index] + faces[self.index + 1]) / 2

    @property
    def description(self) -> str:
        """Number of cells, and the place of the slice (m) in a three-dimensional run."""
        counts = cell_counts(self.run)
        if dimension(self.run) < 3:
            return f"{' x '.join(str(counts[axis]) for axis in self.across)} cells"
        return f"{' x '.join(map(str, counts))} cells, {AXES[self.normal]} = {self.place:.4g} m"

    def cut(self, values: np.ndarray) -> np.ndarray:
        """Values (nx, ny, nz) in the plane, as rows from bottom to top."""
        return np.take(values, self.index, axis=self.normal).T

    def pixels(self, values: np.ndarray) -> np.ndarray:
        """The same as pixels of one size: the cells, or on a stretched axis the cell at the centre of each pixel."""
        rows = self.cut(values)
        for axis, along in zip(self.across, (1, 0)):
            faces = self.run.mesh[AXES[axis]].values
            if not is_uniform(faces):
                count = _equal_cells(faces)
                centres = faces[0] + (np.arange(count) + 0.5) / count * np.ptp(faces)
                rows = np.take(rows, np.searchsorted(faces, centres) - 1, axis=along)
        return rows

    def equidistant(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Equidistant places right and upwards, m, as near as cells of the least width, and values there, linear between centres."""
        rows, places = self.cut(values), []
        for axis, along, centres in zip(self.across, (1, 0), self.centres):
            faces = self.run.mesh[AXES[axis]].values
            if is_uniform(faces):
                places.append(centres)
                continue
            places.append(np.linspace(centres[0], centres[-1], _equal_cells(faces)))
            rows = np.apply_along_axis(lambda line, to=places[-1], at=centres: np.interp(to, at, line), along, rows)
        return *places, rows


def cell_at(faces: np.ndarray, place: float) -> int:
    """Number of the cell along an axis that holds `place`, m, or is nearest to it; the upper end belongs to the last cell."""
    return int(np.clip(np.searchsorted(faces, place, side="right") - 1, 0, len(faces) - 2))


def _default_normal(counts: tuple[int, int, int]) -> int:
    """Last axis with one cell, else z."""
    return next((axis for axis in (2, 1, 0) if counts[axis] == 1), 2)


def plane_of(run: Run, wanted: str = "") -> Plane:
    """Plane named `AXIS` (through the middle) or `AXIS=PLACE`; by default normal to z or to an axis with one cell.

    Raises Failure (USAGE) for another form, a place outside the domain, or a slice that would be a line.
    """
    counts = cell_counts(run)
    axis, equals, place = (part.strip() for part in (wanted or AXES[_default_normal(counts)]).partition("="))
    if axis not in AXES or len(axis) != 1:
        raise Failure(USAGE, f"--slice {wanted} names no axis: it is x, y or z, or one with a place, z=0.5.")
    normal = AXES.index(axis)
    if dimension(run) < 3 and counts[normal] > 1:
        flat = AXES[_default_normal(counts)]
        raise Failure(USAGE, f"--slice {wanted} of a two-dimensional run is a line: its plane is {flat}.")
    if not equals:
        return Plane(run, normal, counts[normal] // 2)
    faces = run.mesh[axis].values
    try:
        value = float(place)
    except ValueError:
        raise Failure(USAGE, f"--slice {wanted}: '{place}' is no number.") from None
    if not faces[0] <= value <= faces[-1]:
        raise Failure(USAGE, f"--slice {wanted} is outside the domain, {axis} = {faces[0]:g} to {faces[-1]:g} m.")
    return Plane(run, normal, cell_at(faces, value))
