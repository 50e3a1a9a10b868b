"""Sections on the cost of a step or batch, compared with goals and hand-written programs."""

import re
from dataclasses import dataclass

from markupsafe import Markup

from .. import html_page
from ..flow import goals as flow_goals
from ..gas import goals as gas_goals
from ..options import goals as options_goals
from ..springs import goals as springs_goals
from .goal import (
    BATCH_US, CELL_NS, EFFICIENCY, FLIGHT_MS, HIGHER_IS_BETTER, OPTION_RATE, OPTION_US, RATE, SPEED_UP,
    STEP_US, TIME_RATIO, VERTEX_NS, Goal,
)
from .perf_record import BACKENDS, Record
from .section import Cell, Section, Table, format_cells

_NAMES = BACKENDS | {"dense-loop": "dense loop, one core", "scatter-loop": "loop that scatters, one core"}


@dataclass(frozen=True)
class _Kind:
    """Labels, units and goals of a kind of record."""

    title: str
    mesh: str
    per_mesh: tuple[str, str]  # time and rate
    goals: tuple[Goal, ...] = ()
    time: str = STEP_US
    scales: tuple[float, float] = (1e9, 1e-9)  # of time and rate
    errors: bool = False  # whether the table has a column of errors


_SPRINGS = "vertices", (VERTEX_NS, "G vertex-steps/s"), springs_goals.GOALS
_BATCH = {"time": BATCH_US, "scales": (1e6, 1.0), "errors": True}
_KINDS = {
    "gas-step": _Kind("A step", "cells", (CELL_NS, RATE), gas_goals.GOALS),
    "flow-step": _Kind("A step", "cells", (CELL_NS, RATE), flow_goals.GOALS, errors=True),
    "parachute-flight": _Kind(
        "A C-9 that opens", "cells", ("ns per cell and ms of flight", "G cells ms/s"), flow_goals.FLIGHT_GOALS, FLIGHT_MS,
        errors=True,
    ),
    "springs-step": _Kind("A step", *_SPRINGS),
    "springs-contact": _Kind("A step in contact", *_SPRINGS),
    "options": _Kind("A batch", "options", (OPTION_US, OPTION_RATE), options_goals.GOALS, **_BATCH),
    "options-surface": _Kind("Surfaces of strikes and maturities", "options", (OPTION_US, OPTION_RATE), **_BATCH),
    "options-cos": _Kind("A batch by cosine series", "options", (OPTION_US, OPTION_RATE), **_BATCH),
    "tridiagonal": _Kind("Tridiagonal systems", "systems", ("\u00b5s per system", "systems/s"), **_BATCH),
}
_TOO_EASY = 2.0  # factor by which a goal is met from which on it was too easy
_Estimate = tuple[float, float, float]  # median, lower and upper end of the 95 % interval


def _seconds(record: Record) -> _Estimate:
    return record.median, *record.interval


def _scale(values: _Estimate, factor: float) -> _Estimate:
    return tuple(factor * value for value in values)


def _ratio(numerator: _Estimate, denominator: _Estimate) -> _Estimate:
    """Quotient of two estimates; its interval contains all quotients of values in both intervals."""
    return numerator[0] / denominator[0], numerator[1] / denominator[2], numerator[2] / denominator[1]


def vector_bits(record: Record) -> int | None:
    """Width of the vector registers of a host build, from its facts or compiler flags; None if unknown."""
    if isinstance(record.facts.get("vector_bits"), int):
        return record.facts["vector_bits"]
    flags = str(record.provenance.get("flags", ""))
    width = re.search(r"prefer-vector-width=(\d+)", flags)
    if width:
        return int(width[1])
    if re.search(r"x86-64-v4|avx512", flags):
        return 512
    return 256 if re.search(r"x86-64-v3|avx2", flags) else None


def measured(goal: Goal, record: Record, compared: Record | None) -> _Estimate | None:
    """Value of the measure of a goal; `compared` is the record of its compared case in the same run.

    Returns None if the goal compares with a case that the run lacks.
    """
    seconds, cells = _seconds(record), record.facts["cells"]
    if goal.measure in (STEP_US, BATCH_US, FLIGHT_MS):
        return _scale(seconds, 1e6)
    if goal.measure in (CELL_NS, VERTEX_NS):
        return _scale(seconds, 1e9 / cells)
    if goal.measure in (RATE, OPTION_RATE):
        return _ratio(((1e-9 if goal.measure == RATE else 1.0) * cells,) * 3, seconds)
    if compared is None:
        return None
    if goal.measure == TIME_RATIO:
        return _ratio(seconds, _seconds(compared))
    faster = _ratio(_seconds(compared), seconds)
    if goal.measure == SPEED_UP:
        return faster
    return _scale(faster, 1.0 / record.threads)


def verdict(goal: Goal, value: float) -> str:
    """Verdict on a median: `goal met`, `stretch met`, either `N times over`, or `missed by N %`."""

    def meets(limit: float) -> bool:
        return value >= limit if goal.measure in HIGHER_IS_BETTER else value <= limit

    for words, limit in (("stretch met", goal.stretch), ("goal met", goal.goal)):
        if limit is not None and meets(limit):
            times = value / limit if goal.measure in HIGHER_IS_BETTER else limit / value
            return f"{words} {times:.0f} times over" if times >= _TOO_EASY else words
    miss = 100 * abs(value / goal.goal - 1)
    return f"missed by {miss:.0f} %" if miss >= 1 else f"missed by {miss:.1g} %"


def _applies_to(goal: Goal, record: Record) -> bool:
    """Whether a goal applies to the machine and build of a record.

    Goals for host cores do not apply to CUDA builds, whose host backends are not vectorised.
    """
    if goal.case != record.case or goal.gpu not in record.machine.gpu:
        return False
    if goal.gpu:
        return True
    if "nvcc" in str(record.provenance.get("compiler", "")):
        return False
    return goal.vector_bits in (0, vector_bits(record) or goal.vector_bits)


def _case_label(goal: Goal, record: Record) -> str:
    mesh = f"{format_cells(record.facts['cells'])} {_KINDS[record.kind].mesh}"
    words = f"{_NAMES.get(record.facts['backend'], record.facts['backend'])}, {mesh}"
    if record.facts["variant"]:
        words += f", {record.facts['variant']}"
    if goal.vector_bits and vector_bits(record) is None:
        words += f" (if its vectors have {goal.vector_bits} bits)"
    if goal.measure == EFFICIENCY:
        return f"{words}, against {record.threads} times one core"
    return f"{words}, against {_short(goal.compared_case)}" if goal.compared_case else words


def _short(case: str) -> str:
    """Case name without its kind."""
    return case.partition("/")[2]


def _format_interval(values: _Estimate) -> str:
    return Markup("{} [{} .. {}]").format(*(html_page.format_number(value) for value in values))


def _goal_row(goal: Goal, record: Record, by_case: dict[tuple, Record]) -> list[Cell | str]:
    values = measured(goal, record, by_case.get((goal.compared_case, *record.run_id)))
    if values is None:
        interval, result = "", f"{_short(goal.compared_case)} is not in the same run"
    else:
        words = verdict(goal, values[0])
        interval, result = _format_interval(values), Cell(words, "bad" if words.startswith("missed") else "good")
    limits = ("" if limit is None else html_page.format_number(limit) for limit in (goal.probe, goal.goal, goal.stretch))
    return [_case_label(goal, record), goal.measure, interval, *limits, result]


def goal_table(records: list[Record]) -> Table | None:
    """Table of all goals that apply to the records, which are of one kind; None if there is none."""
    by_case = {(record.case, *record.run_id): record for record in records}
    goals = _KINDS[records[0].kind].goals
    rows = [_goal_row(goal, record, by_case) for goal in goals for record in records if _applies_to(goal, record)]
    columns = ["what", "measure", "measured", "probe", "goal", "stretch", "verdict"]
    note = (
        "Measured: median and its 95 % interval. Probe: a small hand-written CUDA program, which is no part of this "
        "project. The verdict is that of the median; a goal that is met several times over was too easy to state anything."
    )
    numeric = {"measured", "probe", "goal", "stretch"}
    return (Table([(name, name in numeric) for name in columns], rows, "Against the goals", note) if rows else None)


def _traffic_bound(record: Record, bandwidths: dict[str, float]) -> str:
    """Time per unit of the mesh that the bytes of a step need at the bandwidth of the memory; empty if unknown."""
    speed, moved = bandwidths.get(record.facts["backend"]), record.facts.get("bytes")
    if speed is None or moved is None:
        return ""
    return html_page.format_number(_KINDS[record.kind].scales[0] * moved / speed / record.facts["cells"])


def step_table(records: list[Record], bandwidths: dict[str, float] | None = None) -> Table:
    """Table of times and rates; records are of one kind. `bandwidths`: of the memory, B/s, by backend."""
    kind, rows = _KINDS[records[0].kind], []
    for record in records:
        seconds, cells = _seconds(record), record.facts["cells"]
        row = [_NAMES.get(record.facts["backend"], record.facts["backend"]), record.facts["variant"], html_page.format_grouped(cells)]
        row += [_format_interval(_scale(seconds, 1e6)), html_page.format_number(kind.scales[0] * seconds[0] / cells)]
        row += [html_page.format_number(kind.scales[1] * cells / seconds[0])]
        row += [html_page.format_number(record.error)] if kind.errors else []
        rows.append(row + ([_traffic_bound(record, bandwidths)] if bandwidths else []))
    columns = [("backend", False), ("variant", False), (kind.mesh, True)]
    columns += [(name, True) for name in (kind.time, *kind.per_mesh, *(["error"] if kind.errors else []))]
    columns += [("memory traffic alone", True)] if bandwidths else []
    return Table(columns, rows, f"What {kind.title[0].lower()}{kind.title[1:]} cost{'s' if kind.title[:2] == 'A ' else ''}")


def sections(records: list[Record], bandwidths: dict[str, float] | None = None) -> list[Section]:
    """One section on records of one kind, none without records. `bandwidths` as for `step_table`."""
    if not records:
        return []
    order = list(_NAMES)

    def place(record: Record) -> tuple:
        backend = record.facts["backend"]
        return order.index(backend) if backend in order else len(order), record.facts["cells"], record.facts["variant"]

    ordered, kind = sorted(records, key=place), records[0].kind
    tables = [table for table in (step_table(ordered, bandwidths), goal_table(ordered)) if table]
    return [Section(_KINDS[kind].title, f"drogue-perf run --filter ^{kind}/ --out FILE.jsonl", ordered, tables=tables)]
