"""Cloth, lines and payloads of the canopies in a run directory of drogue-parachute."""

from dataclasses import dataclass

import numpy as np

from ..flow.plane import AXES, Plane, cell_at
from ..flow.sheets import section
from ..run_directory import Run, Snapshot


def has_canopies(run: Run) -> bool:
    """Whether the run has the positions of canopies."""
    return "triangles" in run.canopy_mesh and all("position" in snapshot.canopy for snapshot in run.snapshots)


@dataclass(frozen=True)
class Canopies:
    """All canopies of a run that has them."""

    run: Run

    @property
    def triangles(self) -> np.ndarray:
        """Vertices (n, 3) of the triangles of the cloth."""
        return self.run.canopy_mesh["triangles"].values

    @property
    def line_ends(self) -> np.ndarray:
        """Vertices that are no part of the cloth: payloads, and the points where lines meet risers."""
        return np.setdiff1d(np.arange(len(self.run.canopy_mesh["vertices"].values)), self.triangles)

    @property
    def payloads(self) -> np.ndarray:
        """Vertices that are no part of the cloth, and from which no riser leads to another one."""
        strings = self.run.canopy_mesh["strings"].values
        risers = strings[np.isin(strings, self.line_ends).all(axis=1)]
        return np.setdiff1d(self.line_ends, risers[:, 0])

    @property
    def lines(self) -> np.ndarray:
        """Vertex pairs (n, 2) of the suspension lines and risers."""
        strings = self.run.canopy_mesh["strings"].values
        return strings[np.isin(strings, self.line_ends).any(axis=1)]

    @property
    def stress_units(self) -> str | None:
        """Unit of the von Mises stress; None if the run does not have it."""
        stress = self.run.snapshots[-1].canopy.get("von_mises")
        return None if stress is None else stress.units

    def positions(self, snapshot: Snapshot) -> np.ndarray:
        """Positions (n, 3) of all vertices, m."""
        return snapshot.canopy["position"].values

    def stress(self, snapshot: Snapshot) -> np.ndarray:
        """Von Mises stress of the triangles."""
        return snapshot.canopy["von_mises"].values

    def bounds(self, snapshots: list[Snapshot]) -> tuple[np.ndarray, np.ndarray]:
        """Lowest and highest coordinates of all vertices, m."""
        every = np.concatenate([self.positions(snapshot) for snapshot in snapshots])
        return every.min(axis=0), every.max(axis=0)

    def parts(self) -> list[np.ndarray]:
        """Vertices of the cloth of each canopy."""
        label, former = np.arange(len(self.run.canopy_mesh["vertices"].values)), None
        while former is None or np.any(label != former):
            former = label.copy()
            np.minimum.at(label, self.triangles, label[self.triangles].min(axis=1, keepdims=True))
            label = label[label]
        cloth = np.unique(self.triangles)
        return [cloth[label[cloth] == first] for first in np.unique(label[cloth])]

    def section(self, snapshot: Snapshot, axis: int, place: float) -> np.ndarray:
        """Segments (n, 2, 3) in which the triangles meet the plane at `place` on an axis, m."""
        return section(self.positions(snapshot)[self.triangles], axis, place)


@dataclass(frozen=True, eq=False)
class MovingPlane(Plane):
    """Plane that moves along its normal with the middle of the cloth of one canopy, `vertices`, if that is more than a cell away."""

    vertices: np.ndarray

    def at(self, snapshot: Snapshot) -> Plane:
        middle = snapshot.canopy["position"].values[self.vertices, self.normal].mean()
        faces = self.run.mesh[AXES[self.normal]].values
        is_near = abs(middle - self.place) <= faces[self.index + 1] - faces[self.index]
        return Plane(self.run, self.normal, self.index if is_near else cell_at(faces, middle))


def plane_through_canopy(canopies: Canopies, plane: Plane) -> MovingPlane:
    """Plane parallel to `plane` through the canopy that is nearest to it in the first snapshot."""
    start = canopies.positions(canopies.run.snapshots[0])[:, plane.normal]
    nearest = min(canopies.parts(), key=lambda vertices: abs(start[vertices].mean() - plane.place))
    return MovingPlane(plane.run, plane.normal, plane.index, nearest)
