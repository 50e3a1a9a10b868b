"""Section of the steps: what each costs, and how that stands against the goals and the hand-written programs."""

import re
from dataclasses import dataclass

from markupsafe import Markup

from . import gas_goals, options_goals, page, springs_goals
from .evidence_section import Cell, Section, Table, cells_text
from .gas_goals import (
    CELL_NS,
    EFFICIENCY,
    HIGHER_IS_BETTER,
    OPTION_RATE,
    RATE,
    SPEED_UP,
    STEP_US,
    TIME_RATIO,
    VERTEX_NS,
    Goal,
)
from .options_goals import BATCH_US, OPTION_US
from .perf_record import BACKENDS, Record

_NAMES = BACKENDS | {"dense-loop": "dense loop, one core", "scatter-loop": "loop that scatters, one core"}


@dataclass(frozen=True)
class _Kind:
    """How a page calls the steps of a kind of record."""

    title: str
    mesh: str
    per_mesh: tuple[str, str]  # time and rate
    goals: tuple[Goal, ...] = ()
    time: str = STEP_US
    scales: tuple[float, float] = (1e9, 1e-9)  # of time and rate
    errors: bool = False  # whether a column tells them: they depend on the variant


_OF_SPRINGS = "vertices", (VERTEX_NS, "G vertex-steps/s"), springs_goals.GOALS
_OF_BATCH = {"time": BATCH_US, "scales": (1e6, 1.0), "errors": True}
_KINDS = {
    "gas-step": _Kind("A step", "cells", (CELL_NS, RATE), gas_goals.GOALS),
    "springs-step": _Kind("A step", *_OF_SPRINGS),
    "springs-contact": _Kind("A step in contact", *_OF_SPRINGS),
    "options": _Kind("A batch", "options", (OPTION_US, OPTION_RATE), options_goals.GOALS, **_OF_BATCH),
    "tridiagonal": _Kind("Tridiagonal systems", "systems", ("\u00b5s a system", "systems/s"), **_OF_BATCH),
}
_Interval = tuple[float, float, float]  # median, low, high


def _seconds(record: Record) -> _Interval:
    return record.median, *record.interval


def _scaled(values: _Interval, factor: float) -> _Interval:
    return tuple(factor * value for value in values)


def _over(numerator: _Interval, denominator: _Interval) -> _Interval:
    """Quotient with the widest interval that those of both allow."""
    return numerator[0] / denominator[0], numerator[1] / denominator[2], numerator[2] / denominator[1]


def vector_bits(record: Record) -> int | None:
    """Width of the vectors that a host build may use, from its facts or flags; None where neither tells."""
    if isinstance(record.facts.get("vector_bits"), int):
        return record.facts["vector_bits"]
    flags = str(record.provenance.get("flags", ""))
    width = re.search(r"prefer-vector-width=(\d+)", flags)
    if width:
        return int(width[1])
    if re.search(r"x86-64-v4|avx512", flags):
        return 512
    return 256 if re.search(r"x86-64-v3|avx2", flags) else None


def measured(goal: Goal, record: Record, beside: Record | None) -> _Interval | None:
    """The measure of a goal with its interval; None where it wants a case that is not in the same run."""
    seconds, cells = _seconds(record), record.facts["cells"]
    if goal.measure in (STEP_US, BATCH_US):
        return _scaled(seconds, 1e6)
    if goal.measure in (CELL_NS, VERTEX_NS):
        return _scaled(seconds, 1e9 / cells)
    if goal.measure in (RATE, OPTION_RATE):
        return _over(((1e-9 if goal.measure == RATE else 1.0) * cells,) * 3, seconds)
    if beside is None:
        return None
    if goal.measure == TIME_RATIO:
        return _over(seconds, _seconds(beside))
    faster = _over(_seconds(beside), seconds)
    if goal.measure == SPEED_UP:
        return faster
    return _scaled(faster, 1.0 / record.threads)


def verdict(goal: Goal, value: float) -> str:
    """`goal met`, `stretch met` or `missed by N %`, of the median."""

    def reaches(tolerance: float) -> bool:
        return value >= tolerance if goal.measure in HIGHER_IS_BETTER else value <= tolerance

    if goal.stretch is not None and reaches(goal.stretch):
        return "stretch met"
    if reaches(goal.goal):
        return "goal met"
    miss = 100 * abs(value / goal.goal - 1)
    return f"missed by {miss:.0f} %" if miss >= 1 else f"missed by {miss:.1g} %"


def _holds_for(goal: Goal, record: Record) -> bool:
    """True where the goal is one of this machine and build: the host backends of a CUDA build are not vectorised."""
    if goal.case != record.case or goal.gpu not in record.machine.gpu:
        return False
    if goal.gpu:
        return True
    if "nvcc" in str(record.provenance.get("compiler", "")):
        return False
    return goal.vector_bits in (0, vector_bits(record) or goal.vector_bits)


def _what(goal: Goal, record: Record) -> str:
    mesh = f"{cells_text(record.facts['cells'])} {_KINDS[record.kind].mesh}"
    words = f"{_NAMES.get(record.facts['backend'], record.facts['backend'])}, {mesh}"
    if record.facts["variant"]:
        words += f", {record.facts['variant']}"
    if goal.vector_bits and vector_bits(record) is None:
        words += f" (if its vectors have {goal.vector_bits} bits)"
    if goal.measure == EFFICIENCY:
        return f"{words}, against {record.threads} times one core"
    return f"{words}, against {_short(goal.beside)}" if goal.beside else words


def _short(case: str) -> str:
    """A case without its kind."""
    return case.partition("/")[2]


def _with_interval(values: _Interval) -> str:
    return Markup("{} [{} .. {}]").format(*(page.number(value) for value in values))


def _goal_row(goal: Goal, record: Record, of_run: dict[tuple, Record]) -> list[Cell | str]:
    tolerances = ["" if tolerance is None else page.number(tolerance) for tolerance in (goal.probe, goal.goal, goal.stretch)]
    values = measured(goal, record, of_run.get((goal.beside, *record.run)))
    if values is None:
        return [
            _what(goal, record),
            goal.measure,
            "",
            *tolerances,
            f"{_short(goal.beside)} is not in the same run",
        ]
    words = verdict(goal, values[0])
    return [
        _what(goal, record), goal.measure, _with_interval(values), *tolerances,
        Cell(words, "bad" if words.startswith("missed") else "good"),
    ]  # fmt: skip


def goal_table(records: list[Record]) -> Table | None:
    """Every goal whose case was recorded; None where there is none. Records are of one kind."""
    of_run = {(record.case, *record.run): record for record in records}
    goals = _KINDS[records[0].kind].goals
    rows = [_goal_row(goal, record, of_run) for goal in goals for record in records if _holds_for(goal, record)]
    columns = ["what", "measure", "measured", "probe", "goal", "stretch", "verdict"]
    note = (
        "Measured: median and its 95 % interval. Probe: a small hand-written CUDA program, which is no part of this "
        "project. The verdict is that of the median."
    )
    numeric = {"measured", "probe", "goal", "stretch"}
    return Table([(name, name in numeric) for name in columns], rows, "Against the goals", note) if rows else None


def step_table(records: list[Record]) -> Table:
    kind, rows = _KINDS[records[0].kind], []
    for record in records:
        seconds, cells = _seconds(record), record.facts["cells"]
        rows.append(
            [
                _NAMES.get(record.facts["backend"], record.facts["backend"]), record.facts["variant"],
                page.grouped(cells), _with_interval(_scaled(seconds, 1e6)),
                page.number(kind.scales[0] * seconds[0] / cells), page.number(kind.scales[1] * cells / seconds[0]),
                *([page.number(record.error)] if kind.errors else []),
            ]  # fmt: skip
        )
    columns = [("backend", False), ("variant", False), (kind.mesh, True)]
    columns += [(name, True) for name in (kind.time, *kind.per_mesh, *(["error"] if kind.errors else []))]
    return Table(columns, rows, f"What {kind.title[0].lower()}{kind.title[1:]} cost{'s' if kind.title[:2] == 'A ' else ''}")


def sections(records: list[Record]) -> list[Section]:
    """Of the records of one kind."""
    if not records:
        return []
    order = list(_NAMES)
    ordered = sorted(
        records,
        key=lambda record: (
            order.index(record.facts["backend"]) if record.facts["backend"] in order else len(order),
            record.facts["cells"],
            record.facts["variant"],
        ),
    )
    goals = goal_table(ordered)
    kind = records[0].kind
    command = f"drogue-perf run --filter ^{kind}/ --out FILE.jsonl"
    return [Section(_KINDS[kind].title, command, ordered, tables=[step_table(ordered)] + ([goals] if goals else []))]
