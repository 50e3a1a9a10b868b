"""Exact or reference solution of a gas run as a function of time."""

import numpy as np

from ..expression import evaluate
from ..run_directory import Run, Snapshot
from .riemann import State, sample

WENO_NAMES = {"js": "WENO-JS", "z": "WENO-Z", "m": "WENO-M", "teno5": "TENO5"}
GAS_FIELDS = ("rho", "u", "p")


class ExactSolution:
    """Exact or reference solution of a gas run; `name` is its label in a legend."""

    def __init__(self, name: str, at, drawn_x=None):
        self.name = name
        self._at = at
        self._drawn_x = drawn_x

    def at(self, time: float, x: np.ndarray) -> dict[str, np.ndarray]:
        """Values at the points x (m) by field name; empty if the solution is unknown at `time` (s)."""
        return self._at(time, x)

    def curve(self, time: float, x: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Points (m) that resolve the corners of the solution, and the values there."""
        points = np.linspace(x[0], x[-1], 4001) if self._drawn_x is None else self._drawn_x
        return points, self.at(time, points)


def _riemann(run: Run) -> ExactSolution:
    problem = run.scene["initial"]["riemann"]
    gamma = run.scene.get("gas", {}).get("gamma", 1.4)
    left, right = (State(*(float(problem[side][name]) for name in GAS_FIELDS)) for side in ("left", "right"))
    x0 = problem.get("x0", 0.0)

    def at(time, x):
        # At t = 0 the similarity variable is plus or minus infinity.
        xi = (x - x0) / time if time > 0 else np.where(x < x0, -np.inf, np.inf)
        return dict(zip(GAS_FIELDS, sample(np.nan_to_num(xi, posinf=1e300, neginf=-1e300), left, right, gamma)))

    return ExactSolution("exact", at)


def _advection(run: Run) -> ExactSolution:
    expressions = run.scene["initial"]["expression"]
    start, end = run.scene.get("mesh", {}).get("domain", [-1.0, 1.0])
    constants = {"t": 0.0, "dx": (end - start) / np.size(run.mesh["x"].values)}
    speed = float(evaluate(expressions["u"], x=np.array(start), **constants))

    def at(time, x):
        origin = start + np.mod(x - speed * time - start, end - start)
        return {name: evaluate(expressions[name], x=origin, **constants) for name in GAS_FIELDS}

    return ExactSolution("exact", at)


def _reference(run: Run) -> ExactSolution:
    reference = run.reference
    final = run.snapshots[-1].time

    def at(time, x):
        if time != final:
            return {}
        return {name: np.interp(x, reference.x, item.values) for name, item in reference.fields.items()}

    scheme = f"{WENO_NAMES.get(reference.scheme, reference.scheme)}, " if reference.scheme else ""
    return ExactSolution(f"reference: {scheme}{reference.cells} cells", at, reference.x)


def exact_solution(run: Run) -> ExactSolution | None:
    """Solution that the scene is verified against; None if none is known."""
    wanted = run.scene.get("verify", {}).get("exact", "")
    initial = run.scene.get("initial", {})
    if run.reference and run.snapshots and wanted in ("", "reference"):
        return _reference(run)
    if wanted == "advection" and "expression" in initial:
        return _advection(run)
    boundary = run.scene.get("boundary", {})
    outflow = all(boundary.get(side, "outflow") == "outflow" for side in ("left", "right"))
    if "riemann" in initial and wanted in ("", "riemann") and outflow:
        return _riemann(run)
    return None


def pointwise_errors(run: Run, snapshot: Snapshot, exact: ExactSolution | None) -> dict[str, np.ndarray]:
    """Signed errors at the cell centres by field name, for the fields whose exact values are known."""
    if exact is None:
        return {}
    values = exact.at(snapshot.time, run.mesh["x"].values)
    return {
        name: item.values - values[name]
        for name, item in snapshot.fields.items()
        if name in values and item.values.shape == values[name].shape
    }
