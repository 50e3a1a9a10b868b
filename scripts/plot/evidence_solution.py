"""Work and precision of an app: curves of error against time, and how long each takes to reach an error."""

from dataclasses import dataclass

import numpy as np

from .perf_record import BACKENDS, Record
from .solution_family import Family, family_of
from .study_figure import observed_order


@dataclass(frozen=True)
class Scheme:
    """Where and with what a problem was solved; `word` is a key of the family's names."""

    family: Family
    backend: str
    word: str
    settings: tuple[str, ...]

    @property
    def is_competitor(self) -> bool:
        return bool(self.family.competitor) and self.word == self.family.competitor

    @property
    def is_usual(self) -> bool:
        return self.is_competitor or not any(self.settings) or self.settings == self.family.usual

    @property
    def row(self) -> str:
        """The setting whose values have a row of panels each, where there is such."""
        return self.settings[2] if len(self.settings) > 2 else ""

    @property
    def name(self) -> str:
        """Name, and the settings that are not the usual ones."""
        usual = zip(self.settings, self.family.usual)
        words = self.family.words
        changed = [words.get(word, word) for word, wanted in usual if word != wanted and not self.is_usual]
        return ", ".join([self.family.names.get(self.word, self.word), *changed])


@dataclass(frozen=True)
class Curve:
    """`points` are (cells, seconds, error) by rising mesh."""

    scheme: Scheme
    points: np.ndarray

    @property
    def order(self) -> float | None:
        return observed_order(self.points, 2 if self.scheme.word in self.scheme.family.planar else 1)


@dataclass(frozen=True)
class Reach:
    """Seconds to an error: `>` where the finest mesh still misses it, `<` where the coarsest one already has it."""

    seconds: float
    bound: str = ""


def scheme_of(record: Record) -> Scheme:
    family, facts = family_of(record), record.facts
    word = "z2" if facts[family.fact] == "z" and facts.get("weno_power", 1) == 2 else facts[family.fact]
    settings = tuple(facts.get(name) or ("double" if name == "precision" else "") for name in family.settings)
    return Scheme(family, facts["backend"], word, settings)


def curves(records: list[Record]) -> list[Curve]:
    """One a scheme and backend, in the order of the backends and of the names; an error of 0 has no logarithm."""
    points: dict[Scheme, list[tuple[float, float, float]]] = {}
    for record in records:
        if record.error > 0:
            points.setdefault(scheme_of(record), []).append((record.facts["cells"], record.median, record.error))

    def place(scheme: Scheme):
        order = list(BACKENDS), list(scheme.family.names)
        known = (
            list_.index(word) if word in list_ else 99 for list_, word in zip(order, (scheme.backend, scheme.word))
        )
        words = list(scheme.family.words)
        settings = ((words.index(word) if word in words else len(words), word) for word in scheme.settings)
        return *known, not scheme.is_usual, tuple(settings)

    return [Curve(scheme, np.array(sorted(points[scheme]))) for scheme in sorted(points, key=place)]


def time_to_error(points: np.ndarray, error: float) -> Reach:
    """Where the curve first meets an error, on straight lines between the meshes' logarithms."""
    _, seconds, errors = points.T
    reached = np.flatnonzero(errors <= error)
    if not len(reached):
        return Reach(seconds[-1], ">")
    first = reached[0]
    if first == 0:
        return Reach(seconds[0], "" if errors[0] == error else "<")
    ends = slice(first - 1, first + 1)
    # Errors fall along the curve, interpolation wants them to rise.
    at = np.interp(np.log(error), np.log(errors[ends])[::-1], np.log(seconds[ends])[::-1])
    return Reach(float(np.exp(at)))


def speed_up(other: Reach, own: Reach) -> Reach | None:
    """How many times as long the other takes; None where both are bounds that say nothing together."""
    turned = {"": "", "<": ">", ">": "<"}[own.bound]
    bounds = {other.bound, turned} - {""}
    if len(bounds) == 2:
        return None
    return Reach(other.seconds / own.seconds, bounds.pop() if bounds else "")


def competitor_of(found: list[Curve], backend: str) -> Curve | None:
    return next((c for c in found if c.scheme.is_competitor and c.scheme.backend == backend), None)


def yardstick(found: list[Curve]) -> Curve | None:
    """The curve whose errors the others are asked for: the competitor's, else the first usual one."""
    usual = [curve for curve in found if curve.scheme.is_usual]
    return next((c for c in usual if c.scheme.is_competitor), usual[0] if usual else None)


def asked_errors(found: list[Curve]) -> list[float]:
    """Three errors, falling: those that the family names, else of the yardstick's middle and finest mesh, and half-way
    in logarithms to the least of all.

    Where nothing is below the yardstick its coarsest mesh is the third.
    """
    stick = yardstick(found)
    if stick is None:
        return []
    if stick.scheme.family.errors:
        return list(stick.scheme.family.errors)
    errors = stick.points[:, 2]
    least = min(curve.points[:, 2].min() for curve in found if curve.scheme.is_usual)
    third = np.sqrt(errors[-1] * least) if least < 0.9 * errors[-1] else errors[0]
    return sorted({float(errors[len(errors) // 2]), float(errors[-1]), float(third)}, reverse=True)


def best_scheme(found: list[Curve]) -> str | None:
    """The scheme, among those with variants, that first reaches the yardstick's finest error on its backend.

    Where none does: the one with the least error.
    """
    stick = yardstick(found)
    varied = {curve.scheme.word for curve in found if not curve.scheme.is_usual}
    rivals = [
        curve
        for curve in found
        if curve.scheme.is_usual and curve.scheme.word in varied and curve.scheme.backend == stick.scheme.backend
    ]

    def place(curve: Curve):
        reach = time_to_error(curve.points, stick.points[-1, 2])
        return (1, curve.points[:, 2].min()) if reach.bound == ">" else (0, reach.seconds)

    return min(rivals, key=place).scheme.word if rivals else None


def wins_below(other: np.ndarray, own: np.ndarray) -> tuple[str, float | None]:
    """Where the points of a curve are faster than another's: ("below", error), ("everywhere" | "nowhere", None) or ("", None).

    Asked at the errors that both curves hold; "" where they hold none in common.
    """
    low = max(points[:, 2].min() for points in (other, own))
    high = min(points[0, 2] for points in (other, own))
    if low >= high:
        return "", None
    errors = np.geomspace(high, low, 400)
    # The ends as they are: a rounding beyond them would be off the curves.
    errors[0], errors[-1] = high, low
    wins = [time_to_error(own, e).seconds < time_to_error(other, e).seconds for e in errors]
    if all(wins):
        return "everywhere", None
    if not wins[-1]:
        return "nowhere", None
    last_loss = max(index for index, win in enumerate(wins) if not win)
    return "below", float(errors[last_loss + 1])
