"""Section on scaling: times of a step by number of threads or ranks, and the efficiency against one."""

from .. import html_page
from .perf_record import BACKENDS, Record
from .section import Section, Table


def _units(record: Record) -> tuple[str, int]:
    """Kind and number of the units of a record."""
    if "/ranks/" in record.case:
        return "ranks", record.facts["ranks"]
    return "threads", record.facts["threads"]


def _curve(record: Record) -> tuple:
    """Key that the records of one curve share; the size of weak scaling grows along it."""
    mode = record.facts.get("scaling", "strong")
    size = record.facts["cells"] if mode == "strong" else 0
    return record.case.split("/")[1], mode, _units(record)[0], record.facts["backend"], size


def _share(record: Record, name: str) -> str:
    """Time of a fact over that of a step; empty without the fact."""
    time = record.facts.get(name)
    return f"{100 * time / record.median:.0f} %" if time else ""


def sections(records: list[Record]) -> list[Section]:
    """One section on all curves, none without records. Efficiencies need a record of one unit."""
    if not records:
        return []
    one = {_curve(record): record.median for record in records if _units(record)[1] == 1}
    rows = []
    for record in sorted(records, key=lambda record: (*_curve(record), _units(record)[1])):
        kernel, mode, kind, backend, _ = _curve(record)
        count, first = _units(record)[1], one.get(_curve(record))
        share = first and (first / record.median if mode == "weak" else first / record.median / count)
        rows.append(
            [
                kernel, BACKENDS.get(backend, backend), mode, html_page.format_grouped(record.facts["cells"]),
                f"{count} {kind if count > 1 else kind[:-1]}", html_page.format_number(1e6 * record.median),
                f"{100 * share:.0f} %" if share else "", *(_share(record, name) for name in ("messages_s", "model_s")),
            ]
        )
    columns = [("kernel", False), ("backend", False), ("scaling", False), ("size", True), ("units", True)]
    columns += [("us", True), ("efficiency", True), ("messages", True), ("messages by model", True)]
    note = "Strong scaling keeps the size, weak scaling the size per unit."
    if any("messages_s" in record.facts for record in records):
        note += " Messages: their time alone over that of a step, measured, and by latency and bandwidth."
    command = "drogue-perf table scaling --app APP [--over ranks] [--weak] --out FILE.jsonl"
    return [Section("Scaling", command, records, tables=[Table(columns, rows, "Time by number of units", note)])]
