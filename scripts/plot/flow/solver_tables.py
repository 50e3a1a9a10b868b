"""Sections on pressure solvers and on the memory of flow solvers."""

from .. import html_page
from ..evidence.perf_record import BACKENDS, Record
from ..evidence.section import Cell, Section, Table
from .goals import BYTES_PER_CELL

_NAMES = {"fft": "transforms", "diagonalization": "matrix products", "hypre-pfmg": "hypre PFMG"}

# Tolerances of cases whose names state none; `drogue-perf run` records no fact of it.
_USUAL_TOLERANCE = {"hypre-pfmg": 1e-10}


def _place(record: Record) -> int:
    """Place of the backend in tables; unknown ones stand last."""
    backend = record.facts["backend"]
    return list(BACKENDS).index(backend) if backend in BACKENDS else len(BACKENDS)


def _axes(record: Record) -> list[int]:
    """Cells per axis, from the case name."""
    return [int(word) for word in record.case.split("/")[2].split("x")]


def _pressure_row(record: Record) -> list[str]:
    _, backend, grid, solver, sides, *more = record.case.split("/")
    iterations = record.facts.get("iterations")
    tolerance = record.facts.get("tolerance", _USUAL_TOLERANCE.get(solver))
    if more and "tolerance" not in record.facts:
        tolerance = float(more[0])
    return [
        BACKENDS.get(backend, backend), grid, sides, _NAMES.get(solver, solver),
        "round-off" if tolerance is None else f"{tolerance:g}", html_page.format_number(1e3 * record.median),
        html_page.format_number(1e9 * record.median / record.facts["cells"]),
        "" if iterations is None else str(iterations), html_page.format_number(record.error),
    ]


def pressure_sections(records: list[Record]) -> list[Section]:
    """One section on the times of pressure solvers, none without records."""
    if not records:
        return []
    ordered = sorted(records, key=lambda record: (_place(record), record.facts["cells"],
                                                  record.case.split("/")[4], record.median))
    columns = [("backend", False), ("grid", False), ("sides", False), ("solver", False), ("tolerance", True),
               ("ms per solve", True), ("ns per cell", True), ("iterations", True), ("residual", True)]
    note = "Residual: the largest of a random right-hand side, over the largest term of the equation. hypre computes on the host."
    table = Table(columns, [_pressure_row(record) for record in ordered], "Time of a solve", note)
    return [Section("Pressure solvers", "drogue-perf table pressure --out FILE.jsonl", ordered, tables=[table])]


def _memory_row(record: Record) -> list[Cell | str]:
    cells = record.facts["cells"]
    backend = record.facts["backend"]
    found = [BACKENDS.get(backend, backend), "x".join(map(str, _axes(record))), record.facts["variant"]]
    for name in ("array_bytes", "driver_bytes"):
        value = record.facts.get(name)
        found.append("" if value is None else html_page.format_number(value / cells))
    return found


def memory_sections(records: list[Record]) -> list[Section]:
    """One section on the memory of flow solvers, none without records."""
    if not records:
        return []
    ordered = sorted(records, key=lambda record: (_place(record), record.facts["variant"], record.facts["cells"]))
    columns = [("backend", False), ("grid", False), ("case", False), ("arrays", True), ("driver", True)]
    goal, stretch = BYTES_PER_CELL
    note = (
        "Arrays: all Views, with ghost cells. Driver: what the GPU's driver counts, with the work areas of libraries. "
        f"Goal on 512x512x512 cells: {goal:g}, stretch {stretch:g}."
    )
    table = Table(columns, [_memory_row(record) for record in ordered], "Bytes per cell", note)
    return [Section("Memory", "drogue-perf table memory --out FILE.jsonl", ordered, tables=[table])]
