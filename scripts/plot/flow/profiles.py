"""Velocities of a flow along lines, beside those that its scene expects there at the end of the run."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..expression import evaluate
from ..run_directory import Run, Snapshot
from .plane import AXES, cell_counts

_POINTS = 2001  # of a curve
_VARIES = 1e-9  # variation relative to the largest velocity below which an exact velocity is constant


class SampledLine:
    """Velocities at ascending places, m, interpolated by cubic polynomials; needs four values."""

    def __init__(self, places: np.ndarray, values: np.ndarray):
        self._places, self._values = places, values

    def __call__(self, at: np.ndarray) -> np.ndarray:
        """Values at places `at`; the outermost polynomials hold beyond the ends."""
        at = np.asarray(at, dtype=float)
        start = np.clip(np.searchsorted(self._places, at, side="right") - 2, 0, len(self._values) - 4)
        x = [self._places[start + k] for k in range(4)]
        total = 0.0
        for k in range(4):
            weight = np.ones_like(at)
            for other in {0, 1, 2, 3} - {k}:
                weight = weight * (at - x[other]) / (x[k] - x[other])
            total = total + weight * self._values[start + k]
        return total

    @property
    def places(self) -> np.ndarray:
        """Places of the values."""
        return self._places

    @property
    def curve(self) -> tuple[np.ndarray, np.ndarray]:
        """Places that resolve the line, and the values there."""
        places = np.linspace(self._places[0], self._places[-1], _POINTS)
        return places, self(places)

    def extremum(self, sign: int) -> tuple[float, float]:
        """Place and value of the largest (sign 1) or the least (sign -1) velocity."""
        places, values = self.curve
        top = int(np.argmax(sign * values))
        return float(places[top]), float(values[top])


@dataclass(frozen=True)
class Comparison:
    """One velocity component along a line, and the expected one: points and extremes, or an exact solution.

    `points` holds (place, velocity); `extremes` holds (sign, place or None, velocity, tolerance).
    """

    line: SampledLine
    component: int
    along: int
    through: tuple[float, float, float]  # a point of the line, m
    points: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))
    extremes: tuple[tuple[int, float | None, float, float], ...] = ()
    exact: Callable[[np.ndarray], np.ndarray] | None = None
    tolerance: float | None = None  # of the points, or of the largest error, m/s

    def deviations(self) -> tuple[np.ndarray, np.ndarray]:
        """Places of the expected points, else of the cells, and there the velocity less the expected one."""
        if self.exact is not None:
            places = self.line.places
            return places, self.line(places) - self.exact(places)
        return self.points[:, 0], self.line(self.points[:, 0]) - self.points[:, 1]


def _neighbours(faces: np.ndarray, place: float, is_periodic: bool) -> list[tuple[int, float]]:
    """Cells whose centres enclose a place, with their weights of linear interpolation."""
    count, length = len(faces) - 1, faces[-1] - faces[0]
    if count == 1:
        return [(0, 1.0)]
    centres = (faces[1:] + faces[:-1]) / 2
    if is_periodic:
        place = faces[0] + (place - faces[0]) % length
        centres = np.concatenate(([centres[-1] - length], centres, [centres[0] + length]))
    lower = int(np.clip(np.searchsorted(centres, place, side="right") - 1, 0, len(centres) - 2))
    weight = float(np.clip((place - centres[lower]) / (centres[lower + 1] - centres[lower]), 0.0, 1.0))
    first = lower - 1 if is_periodic else lower
    return [(first % count, 1 - weight), ((first + 1) % count, weight)]


def sample(run: Run, snapshot: Snapshot, component: int, along: int, through) -> SampledLine | None:
    """Velocity component on the line through a point; None for fewer than four cells or undefined values."""
    values = snapshot.fields["velocity"].values[..., component]
    boundary = run.scene.get("grid", {}).get("boundary", {})
    for axis in range(3):
        if axis == along:
            continue
        faces = run.mesh[AXES[axis]].values
        is_periodic = boundary.get(AXES[axis]) in ("periodic", ["periodic", "periodic"])
        # The axis stays, with one cell, so that the others keep their numbers.
        values = sum(
            weight * values.take([cell], axis=axis)
            for cell, weight in _neighbours(faces, through[axis], is_periodic)
        )
    faces = run.mesh[AXES[along]].values
    values = values.ravel()
    if len(values) < 4 or not np.isfinite(values).all():
        return None
    return SampledLine((faces[1:] + faces[:-1]) / 2, values)


def _published(run: Run, snapshot: Snapshot) -> list[Comparison]:
    """Comparisons with the points and extremes of verify.profile."""
    found = []
    for profile in run.scene.get("verify", {}).get("profile", []):
        component, along = AXES.index(profile["component"]), AXES.index(profile["along"])
        line = sample(run, snapshot, component, along, profile["through"])
        if line is None:
            continue
        extremes = tuple(
            (sign, profile[name].get("at"), profile[name]["value"], profile[name]["tolerance"])
            for name, sign in (("minimum", -1), ("maximum", 1))
            if name in profile
        )
        points = np.array(profile.get("points", []), dtype=float).reshape(-1, 2)
        tolerance = profile.get("tolerance") if len(points) else None
        found.append(
            Comparison(line, component, along, tuple(profile["through"]), points, extremes, tolerance=tolerance)
        )
    return found


def _exact(run: Run, snapshot: Snapshot) -> list[Comparison]:
    """Comparisons with verify.exact along the middle cells, where the exact velocity varies."""
    verify = run.scene.get("verify", {})
    if not verify.get("exact"):
        return []
    counts = cell_counts(run)
    centres = [(faces[1:] + faces[:-1]) / 2 for faces in (run.mesh[axis].values for axis in AXES)]
    # A line through cell centres needs no interpolation across it.
    middle = tuple(float(places[count // 2]) for places, count in zip(centres, counts))
    widths = [np.diff(run.mesh[axis].values) for axis in AXES]

    def velocity(component, along):
        """Mean over the two faces across a component, as the velocity at the centre of a cell is."""
        text = verify["exact"][AXES[component]]

        def at(places):
            point = {axis: np.full(np.shape(places), middle[k]) for k, axis in enumerate(AXES)}
            point[AXES[along]] = np.asarray(places, dtype=float)
            centre = point[AXES[component]]
            half = 0.5 * np.interp(centre, centres[component], widths[component])
            faces = (point | {AXES[component]: centre + side * half} for side in (-1, 1))
            return 0.5 * sum(evaluate(text, t=snapshot.time, **face) for face in faces)

        return at

    candidates = [(component, along) for along in range(3) if counts[along] > 1 for component in range(3)]
    values = {pair: velocity(*pair)(centres[pair[1]]) for pair in candidates}
    largest = max(float(np.abs(item).max()) for item in values.values())
    found = []
    for component, along in candidates:
        line = sample(run, snapshot, component, along, middle)
        if line is not None and np.ptp(values[component, along]) > _VARIES * largest:
            tolerance = verify.get("linf_velocity")
            exact = velocity(component, along)
            found.append(Comparison(line, component, along, middle, exact=exact, tolerance=tolerance))
    return found


def comparisons(run: Run, snapshot: Snapshot) -> list[Comparison]:
    """Lines of [verify]; none before the end of the run, for which their velocities are stated."""
    end = run.scene.get("run", {}).get("end_time")
    if "velocity" not in snapshot.fields or end is None or abs(snapshot.time - end) > 1e-9 * end:
        return []
    return _published(run, snapshot) + _exact(run, snapshot)
