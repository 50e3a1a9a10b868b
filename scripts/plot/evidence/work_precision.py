"""Work-precision evaluation: curves of error against time, and the time that a scheme needs to an error."""

from dataclasses import dataclass

import numpy as np

from ..study_figure import observed_order
from .perf_record import BACKENDS, Record
from .scheme_families import family_of
from .scheme_family import SchemeFamily


@dataclass(frozen=True)
class Scheme:
    """Scheme with backend and settings; `key` is one of the scheme names of its family."""

    family: SchemeFamily
    backend: str
    key: str
    settings: tuple[str, ...]
    default_settings: tuple[str, ...]

    @property
    def is_competitor(self) -> bool:
        return bool(self.family.competitor) and self.key == self.family.competitor

    @property
    def has_default_settings(self) -> bool:
        return self.is_competitor or not any(self.settings) or self.settings == self.default_settings

    @property
    def row_setting(self) -> str:
        """Third setting, drawn by a row of panels; empty without one."""
        return self.settings[2] if len(self.settings) > 2 else ""

    @property
    def name(self) -> str:
        """Display name with the settings that differ from the default ones."""
        labels = self.family.setting_labels
        pairs = zip(self.settings, self.default_settings)
        changed = [
            labels.get(value, value)
            for value, default in pairs
            if value != default and not self.has_default_settings
        ]
        return ", ".join([self.family.scheme_names.get(self.key, self.key), *changed])


@dataclass(frozen=True)
class Curve:
    """Points (cells, seconds, error) of one scheme, by increasing mesh."""

    scheme: Scheme
    points: np.ndarray

    @property
    def order(self) -> float | None:
        """Observed order of convergence; None for fewer than three meshes."""
        return observed_order(self.points, 2 if self.scheme.key in self.scheme.family.planar_schemes else 1)


@dataclass(frozen=True)
class TimeToError:
    """Time to reach an error, s.

    `bound` is `>` if the finest mesh misses the error, `<` if the coarsest mesh is already below it, else empty.
    """

    seconds: float
    bound: str = ""


def scheme_of(record: Record) -> Scheme:
    """Scheme of a work-precision record."""
    family, facts = family_of(record), record.facts
    key = ("z2" if facts[family.scheme_fact] == "z" and facts.get("weno_power", 1) == 2 else facts[family.scheme_fact])
    settings = tuple(facts.get(name) or ("double" if name == "precision" else "") for name in family.settings)
    return Scheme(family, facts["backend"], key, settings, family.defaults_for(facts["problem"], facts["backend"]))


def curves(records: list[Record]) -> list[Curve]:
    """One curve per scheme and backend, in the order of BACKENDS and of the scheme names; omits errors of 0."""
    points: dict[Scheme, list[tuple[float, float, float]]] = {}
    for record in records:
        if record.error > 0:
            points.setdefault(scheme_of(record), []).append((record.facts["cells"], record.median, record.error))

    def sort_key(scheme: Scheme):
        order = list(BACKENDS), list(scheme.family.scheme_names)
        known = (
            names.index(name) if name in names else 99
            for names, name in zip(order, (scheme.backend, scheme.key))
        )
        labels = list(scheme.family.setting_labels)
        settings = ((labels.index(value) if value in labels else len(labels), value) for value in scheme.settings)
        return *known, not scheme.has_default_settings, tuple(settings)

    return [Curve(scheme, np.array(sorted(points[scheme]))) for scheme in sorted(points, key=sort_key)]


def time_to_error(points: np.ndarray, error: float) -> TimeToError:
    """Time at which a curve first reaches an error, by log-log interpolation between the meshes."""
    _, seconds, errors = points.T
    reached = np.flatnonzero(errors <= error)
    if not len(reached):
        return TimeToError(seconds[-1], ">")
    first = reached[0]
    if first == 0:
        return TimeToError(seconds[0], "" if errors[0] == error else "<")
    ends = slice(first - 1, first + 1)
    # np.interp requires increasing abscissae, but errors decrease along the curve.
    at = np.interp(np.log(error), np.log(errors[ends])[::-1], np.log(seconds[ends])[::-1])
    return TimeToError(float(np.exp(at)))


def speed_up(other: TimeToError, own: TimeToError) -> TimeToError | None:
    """Time of `other` over the time of `own`; None if the bounds of both do not bound the ratio."""
    inverted = {"": "", "<": ">", ">": "<"}[own.bound]
    bounds = {other.bound, inverted} - {""}
    if len(bounds) == 2:
        return None
    return TimeToError(other.seconds / own.seconds, bounds.pop() if bounds else "")


def competitor_of(all_curves: list[Curve], backend: str) -> Curve | None:
    """Curve of the competitor on a backend."""
    return next((c for c in all_curves if c.scheme.is_competitor and c.scheme.backend == backend), None)


def reference_curve(all_curves: list[Curve]) -> Curve | None:
    """Curve that defines the target errors: that of the competitor, else the first one with default settings."""
    default = [curve for curve in all_curves if curve.scheme.has_default_settings]
    return next((c for c in default if c.scheme.is_competitor), default[0] if default else None)


def target_errors(all_curves: list[Curve]) -> list[float]:
    """Three decreasing target errors.

    They are those of the family, else the errors of the reference curve on its middle and finest mesh, and the
    geometric mean of the latter and the least error of all. If no error is below that of the reference curve, the
    third one is the error of its coarsest mesh.
    """
    reference = reference_curve(all_curves)
    if reference is None:
        return []
    if reference.scheme.family.target_errors:
        return list(reference.scheme.family.target_errors)
    errors = reference.points[:, 2]
    least = min(curve.points[:, 2].min() for curve in all_curves if curve.scheme.has_default_settings)
    third = np.sqrt(errors[-1] * least) if least < 0.9 * errors[-1] else errors[0]
    return sorted({float(errors[len(errors) // 2]), float(errors[-1]), float(third)}, reverse=True)


def best_scheme(all_curves: list[Curve]) -> str | None:
    """Key of the scheme with variants that reaches the finest error of the reference curve first, on its backend.

    If none reaches it, the scheme with the least error; None without variants.
    """
    reference = reference_curve(all_curves)
    varied = {curve.scheme.key for curve in all_curves if not curve.scheme.has_default_settings}
    rivals = [
        curve
        for curve in all_curves
        if curve.scheme.has_default_settings
        and curve.scheme.key in varied
        and curve.scheme.backend == reference.scheme.backend
    ]

    def rank(curve: Curve):
        time = time_to_error(curve.points, reference.points[-1, 2])
        return (1, curve.points[:, 2].min()) if time.bound == ">" else (0, time.seconds)

    return min(rivals, key=rank).scheme.key if rivals else None


def faster_range(other: np.ndarray, own: np.ndarray) -> tuple[str, float | None]:
    """Errors at which the points `own` of a curve are reached faster than those of `other`.

    Returns ("below", error), ("everywhere", None), ("nowhere", None), or ("", None) if the curves have no errors in
    common.
    """
    low = max(points[:, 2].min() for points in (other, own))
    high = min(points[0, 2] for points in (other, own))
    if low >= high:
        return "", None
    errors = np.geomspace(high, low, 400)
    # Exact end points, since round-off could place them outside the curves.
    errors[0], errors[-1] = high, low
    wins = [time_to_error(own, e).seconds < time_to_error(other, e).seconds for e in errors]
    if all(wins):
        return "everywhere", None
    if not wins[-1]:
        return "nowhere", None
    last_loss = max(index for index, win in enumerate(wins) if not win)
    return "below", float(errors[last_loss + 1])
