"""Sections of work and precision: a picture a problem, and the times in which every scheme reaches the same errors."""

from markupsafe import Markup

from . import page
from .evidence_section import Cell, Picture, Section, Table
from .evidence_solution import (
    Curve,
    Reach,
    asked_errors,
    best_scheme,
    competitor_of,
    curves,
    scheme_of,
    speed_up,
    time_to_error,
    wins_below,
    yardstick,
)  # fmt: skip
from .evidence_solution_figure import solution_figure
from .perf_record import BACKENDS, Machine, Record
from .solution_family import Family, family_of


def _bounded(reach: Reach, text: str) -> str:
    return Markup("{} {}").format(reach.bound, text) if reach.bound else text


def _factor(gain: Reach | None) -> Cell:
    """A bound that leaves open which of the two is faster is left out."""
    if gain is None or (gain.bound == ">" and gain.seconds < 1) or (gain.bound == "<" and gain.seconds > 1):
        return Cell("")
    return Cell(_bounded(gain, page.number(gain.seconds)), "good" if gain.seconds > 1 else "")


def _wins(other: Curve | None, own: Curve) -> Cell:
    """In words where a curve beats the competitor of its backend."""
    if other is None or other is own:
        return Cell("")
    where, error = wins_below(other.points, own.points)
    if where == "below":
        return Cell(Markup("below {}").format(page.number(error)), "good")
    words = {"everywhere": "all that both reach", "nowhere": "none", "": "none in common"}[where]
    return Cell(words, "good" if where == "everywhere" else "")


def _row(curve: Curve, found: list[Curve], errors: list[float]) -> list[Cell | str]:
    other, meshes = competitor_of(found, curve.scheme.backend), curve.points[:, 0]
    order = "" if curve.order is None else f"{curve.order:.2f}"
    row = [BACKENDS.get(curve.scheme.backend, curve.scheme.backend), curve.scheme.name]
    row += [f"{meshes[0]:.0f}\u2013{meshes[-1]:.0f}" if len(meshes) > 1 else f"{meshes[0]:.0f}", order]
    for error in errors:
        own = time_to_error(curve.points, error)
        gain = speed_up(time_to_error(other.points, error), own) if other and other is not curve else None
        row += [_bounded(own, page.seconds(own.seconds)), _factor(gain)]
    return [*row, _wins(other, curve)]


def _table(shown: list[Curve], found: list[Curve], errors: list[float], title: str, folded: bool) -> Table:
    columns = [("backend", False), ("scheme", False), (found[0].scheme.family.mesh, True), ("order", True)]
    for error in errors:
        columns += [(Markup("to {}").format(page.number(error)), True), ("factor", True)]
    columns.append(("faster at errors", False))
    if not any(curve.scheme.is_competitor for curve in found):
        columns = [column for column in columns if column[0] not in ("factor", "faster at errors")]
        rows = [_without_factors(_row(curve, found, errors)) for curve in shown]
    else:
        rows = [_row(curve, found, errors) for curve in shown]
    return Table(columns, rows, title=title, folded=folded)


def _without_factors(row: list) -> list:
    return row[:4] + row[4:-1:2]


def _failures(records: list[Record]) -> list[str]:
    """A line for each scheme, backend and status, with the meshes and the first message."""
    meshes: dict[tuple, list[int]] = {}
    messages = {}
    for record in records:
        scheme = scheme_of(record)
        key = scheme.name, scheme.backend, record.facts["status"]
        mesh = scheme.family.mesh
        meshes.setdefault(key, []).append(record.facts["cells"])
        messages.setdefault(key, str(record.facts.get("message") or "").rstrip("."))
    return [
        f"{name}, {BACKENDS.get(backend, backend)}, {', '.join(map(str, sorted(meshes[key])))} {mesh}: {status}"
        + (f" ({messages[key]})" if messages[key] else "")
        for key in meshes
        for name, backend, status in [key]
    ]


def _explanation(found: list[Curve], best: str | None) -> str:
    """What the table says and what it compares with what."""
    stick = yardstick(found).scheme.name
    family = found[0].scheme.family
    *but_last, last = (f"{100 * error:g} %" for error in family.errors or (0.0,))
    asked = (
        f"The errors asked for are {', '.join(but_last)} and {last}."
        if family.errors
        else f"The errors asked for are those of {stick} on its middle and its finest mesh, and one half-way, in "
        "logarithms, to the least error of all schemes (where none is smaller: that of its coarsest mesh)."
    )
    words = [
        f"{asked} They are met on straight lines between the meshes, in logarithms; > : the finest mesh still misses "
        f"the error, < : the coarsest has it already. Order: least squares of error against {family.mesh}"
        + (", or edges along an axis." if family.planar else ".")
    ]
    words += [family.note] if family.note else []
    rival = family.names.get(family.competitor, "")
    holders = list(dict.fromkeys(curve.scheme.backend for curve in found if curve.scheme.is_competitor))
    if holders:
        words.append(
            f"Factor: time of {rival} over time of the scheme, both on one backend; faster at errors: "
            "those at which it is above 1."
        )
    if holders and set(holders) != {curve.scheme.backend for curve in found}:
        names = " and ".join(BACKENDS.get(name, name) for name in holders)
        words.append(
            f"{rival} runs on {names} only: {names} is compared with {names}, others have no factor."
        )
    if best:
        words.append(
            f"Of the schemes with other settings {family.names.get(best, best)}, which is drawn, is the first to reach "
            f"the finest error of {stick} or, where none does, has the least error."
        )
    return " ".join(words)


def _threads(records: list[Record]) -> str:
    counts = {record.threads for record in records if record.facts["backend"] == "openmp"}
    return f", {counts.pop()} threads" if len(counts) == 1 else ""


def _section(
    family: Family, problem: str, machine: Machine, solved: list[Record], unsolved: list[Record]
) -> Section:
    title = family.problems.get(problem, problem)
    found = curves(solved)
    usual = [curve for curve in found if curve.scheme.is_usual]
    variants = [curve for curve in found if not curve.scheme.is_usual]
    best, errors = best_scheme(found), asked_errors(found)
    pictures, tables = [], []
    if usual:
        pictures.append(
            Picture(
                f"solution_{problem}_{machine.slug}",
                lambda: solution_figure(problem, machine, found, best, _threads(solved)),
                f"Error against time to solution of {title}, one curve a scheme, one column a backend",
            )
        )
        tables.append(_table(usual, found, errors, "Time to reach an error", False))
        if variants:
            tables.append(_table(variants, found, errors, "The same with other settings", True))
    notes = [_explanation(found, best)] if usual else []
    on_gpu = any(curve.scheme.backend == "cuda" for curve in found)
    drawn = [mark for mark in family.marks if mark.problem == problem and (on_gpu or mark.on != "cuda")]
    notes += [f"{mark.label}: {mark.source}." for mark in drawn]
    exact = sum(record.error <= 0 for record in solved)
    if exact:
        notes.append(f"{exact} runs without any error are not drawn.")
    return Section(
        f"{title}: error against time", family.command, solved + unsolved, pictures, tables, notes, _failures(unsolved)
    )


def sections(machine: Machine, records: list[Record], unsolved: list[Record]) -> list[Section]:
    """One for each problem, in the order of the family."""
    every = records + unsolved
    if not every:
        return []
    family = family_of(every[0])
    problems = list(dict.fromkeys(record.facts["problem"] for record in every))
    order = list(family.problems)
    problems.sort(key=lambda name: order.index(name) if name in order else len(order))
    return [
        _section(
            family,
            problem,
            machine,
            [record for record in records if record.facts["problem"] == problem],
            [record for record in unsolved if record.facts["problem"] == problem],
        )
        for problem in problems
    ]
