"""Counts of work in records that a later version of the program corrected: bounds from them are wrong."""

from dataclasses import replace

from .perf_record import Record

_COUNTS = ("flops", "bytes", "instructions")
_KINDS = ("flow-step", "gas-step", "springs-step", "options", "tridiagonal")
_LARGEST_DIFFERENCE = 0.02  # of the counts of a case; they do not depend on the machine


def _differs(record: Record, latest: Record) -> bool:
    pairs = [(record.facts[name], latest.facts[name]) for name in _COUNTS if {name} <= record.facts.keys() & latest.facts.keys()]
    return any(abs(count - now) > _LARGEST_DIFFERENCE * now for count, now in pairs)


def without_outdated_counts(records: list[Record]) -> tuple[list[Record], list[Record]]:
    """The records, without the counts that the latest record of the case on any machine contradicts, and those that lost theirs."""
    latest: dict[str, Record] = {}
    for record in records:
        if record.kind in _KINDS and record.facts.keys() & set(_COUNTS) and (record.case not in latest or record.run_id >= latest[record.case].run_id):
            latest[record.case] = record
    outdated = [record for record in records if record.case in latest and _differs(record, latest[record.case])]
    lost = {id(record) for record in outdated}
    return [
        replace(record, facts={name: fact for name, fact in record.facts.items() if name not in _COUNTS}) if id(record) in lost else record
        for record in records
    ], outdated
