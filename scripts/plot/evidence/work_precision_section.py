"""Work-precision sections: a figure per problem, and the times in which each scheme reaches the same errors."""

from markupsafe import Markup

from .. import html_page
from .perf_record import BACKENDS, Machine, Record
from .scheme_families import family_of
from .scheme_family import SchemeFamily
from .section import Cell, Picture, Section, Table
from .work_precision import (
    Curve, TimeToError, target_errors, best_scheme, competitor_of, curves, scheme_of, speed_up, time_to_error,
    faster_range, reference_curve,
)
from .work_precision_figure import solution_figure


def _bounded(time: TimeToError, text: str) -> str:
    """Text with the sign of the bound in front."""
    return Markup("{} {}").format(time.bound, text) if time.bound else text


def _factor(gain: TimeToError | None) -> Cell:
    """Cell of a speed-up; empty for a bound that does not decide which of the two is faster."""
    if gain is None or (gain.bound == ">" and gain.seconds < 1) or (gain.bound == "<" and gain.seconds > 1):
        return Cell("")
    return Cell(_bounded(gain, html_page.format_number(gain.seconds)), "good" if gain.seconds > 1 else "")


def _wins(other: Curve | None, own: Curve) -> Cell:
    """Cell with the errors at which a curve is faster than the competitor on its backend."""
    if other is None or other is own:
        return Cell("")
    where, error = faster_range(other.points, own.points)
    if where == "below":
        return Cell(Markup("below {}").format(html_page.format_number(error)), "good")
    words = {"everywhere": "all that both reach", "nowhere": "none", "": "none in common"}[where]
    return Cell(words, "good" if where == "everywhere" else "")


def _row(curve: Curve, all_curves: list[Curve], errors: list[float]) -> list[Cell | str]:
    other, meshes = competitor_of(all_curves, curve.scheme.backend), curve.points[:, 0]
    order = "" if curve.order is None else f"{curve.order:.2f}"
    row = [BACKENDS.get(curve.scheme.backend, curve.scheme.backend), curve.scheme.name]
    row += [f"{meshes[0]:.0f}\u2013{meshes[-1]:.0f}" if len(meshes) > 1 else f"{meshes[0]:.0f}", order]
    for error in errors:
        own = time_to_error(curve.points, error)
        gain = speed_up(time_to_error(other.points, error), own) if other and other is not curve else None
        row += [_bounded(own, html_page.format_seconds(own.seconds)), _factor(gain)]
    return [*row, _wins(other, curve)]


def _table(shown: list[Curve], all_curves: list[Curve], errors: list[float], title: str, folded: bool) -> Table:
    columns = [("backend", False), ("scheme", False), (all_curves[0].scheme.family.mesh_unit, True), ("order", True)]
    for error in errors:
        columns += [(Markup("to {}").format(html_page.format_number(error)), True), ("factor", True)]
    columns.append(("faster at errors", False))
    # A scheme without the competitor on its backend has no factor, nor has one that misses the error.
    return Table(columns, [_row(curve, all_curves, errors) for curve in shown], title=title, folded=folded)


def _failures(records: list[Record]) -> list[str]:
    """A line per scheme, backend and status, with the meshes and the first message."""
    meshes: dict[tuple, list[int]] = {}
    messages = {}
    for record in records:
        scheme = scheme_of(record)
        key = scheme.name, scheme.backend, record.facts["status"]
        mesh = scheme.family.mesh_unit
        meshes.setdefault(key, []).append(record.facts["cells"])
        messages.setdefault(key, str(record.facts.get("message") or "").rstrip("."))
    return [
        f"{name}, {BACKENDS.get(backend, backend)}, {', '.join(map(str, sorted(meshes[key])))} {mesh}: {status}"
        + (f" ({messages[key]})" if messages[key] else "")
        for key in meshes
        for name, backend, status in [key]
    ]


def _explanation(all_curves: list[Curve], best: str | None) -> str:
    """Explanation of the table for the reader of the page."""
    reference = reference_curve(all_curves).scheme.name
    family = all_curves[0].scheme.family
    *but_last, last = (f"{100 * error:g} %" for error in family.target_errors or (0.0,))
    asked = (
        f"The errors asked for are {', '.join(but_last)} and {last}."
        if family.target_errors
        else f"The errors asked for are those of {reference} on its middle and its finest mesh, and one half-way, in "
        "logarithms, to the least error of all schemes (where none is smaller: that of its coarsest mesh)."
    )
    words = [
        f"{asked} They are met on straight lines between the meshes, in logarithms; > : the finest mesh still misses "
        f"the error, < : the coarsest has it already. Order: least squares of error against {family.mesh_unit}"
        + (", or edges along an axis." if family.planar_schemes else ".")
    ]
    words += [family.note] if family.note else []
    rival = family.scheme_names.get(family.competitor, "")
    holders = list(dict.fromkeys(curve.scheme.backend for curve in all_curves if curve.scheme.is_competitor))
    if holders:
        words.append(
            f"Factor: time of {rival} over time of the scheme, both on one backend; faster at errors: "
            "those at which it is above 1."
        )
    if holders and set(holders) != {curve.scheme.backend for curve in all_curves}:
        names = " and ".join(BACKENDS.get(name, name) for name in holders)
        words.append(f"{rival} runs on {names} only: {names} is compared with {names}, others have no factor.")
    if best:
        words.append(
            f"Of the schemes with other settings {family.scheme_names.get(best, best)}, which is drawn, is the first "
            f"to reach the finest error of {reference} or, where none does, has the least error."
        )
    return " ".join(words)


def _threads(records: list[Record]) -> str:
    counts = {record.threads for record in records if record.facts["backend"] == "openmp"}
    return f", {counts.pop()} threads" if len(counts) == 1 else ""


def _section(family: SchemeFamily, problem: str, machine: Machine, solved: list[Record], failed: list[Record]) -> Section:
    title = family.problems.get(problem, problem)
    all_curves = curves(solved)
    default = [curve for curve in all_curves if curve.scheme.has_default_settings]
    variants = [curve for curve in all_curves if not curve.scheme.has_default_settings]
    best, errors = best_scheme(all_curves), target_errors(all_curves)
    pictures, tables = [], []
    if default:
        words = f"Error against time to solution of {title}, one curve a scheme, one column a backend"
        pictures.append(Picture(f"solution_{problem}_{machine.slug}",
                                lambda: solution_figure(problem, machine, all_curves, best, _threads(solved)), words))
        tables.append(_table(default, all_curves, errors, "Time to reach an error", False))
        if variants:
            tables.append(_table(variants, all_curves, errors, "The same with other settings", True))
    notes = [_explanation(all_curves, best)] if default else []
    on_gpu = any(curve.scheme.backend == "cuda" for curve in all_curves)
    drawn = [r for r in family.published if r.problem == problem and (on_gpu or r.backend != "cuda")]
    notes += [f"{result.label}: {result.source}." for result in drawn]
    exact = sum(record.error <= 0 for record in solved)
    if exact:
        notes.append(f"{exact} runs without any error are not drawn.")
    return Section(f"{title}: error against time", family.command, solved + failed, pictures, tables, notes, _failures(failed))


def sections(machine: Machine, records: list[Record], failed: list[Record]) -> list[Section]:
    """One section per problem, in the order of the family."""
    every = records + failed
    if not every:
        return []
    family = family_of(every[0])
    problems = list(dict.fromkeys(record.facts["problem"] for record in every))
    order = list(family.problems)
    problems.sort(key=lambda name: order.index(name) if name in order else len(order))

    def of(problem: str, some: list[Record]) -> list[Record]:
        return [record for record in some if record.facts["problem"] == problem]

    return [_section(family, problem, machine, of(problem, records), of(problem, failed)) for problem in problems]
