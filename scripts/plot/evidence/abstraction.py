"""Section on the cost of Kokkos: kernels beside the same algorithms written in CUDA."""

from .. import html_page
from .perf_record import Record
from .section import Section, Table

_LARGEST_RATIO, _GOAL_CELLS = 1.05, 1_000_000
_LAUNCHES = {"plain": "one by one", "graph": "in a graph"}


def _verdict(record: Record) -> str:
    """Verdict on the goal, which holds for large sizes: the interval of the ratio decides."""
    low, high = record.facts.get("ratio_low"), record.facts.get("ratio_high")
    if record.facts["cells"] < _GOAL_CELLS or low is None or high is None:
        return ""
    if high <= _LARGEST_RATIO:
        return "met"
    return "missed" if low > _LARGEST_RATIO else "undecided"


def _row(kokkos: Record, hand_written: Record) -> list[str]:
    facts, kernel = kokkos.facts, kokkos.case.split("/")[2]
    ratio = [facts.get(name) for name in ("ratio", "ratio_low", "ratio_high")]
    known = None not in ratio
    return [
        kernel, html_page.format_grouped(facts["cells"]), _LAUNCHES.get(facts["launches"], facts["launches"]),
        html_page.format_number(1e6 * kokkos.median), html_page.format_number(1e6 * hand_written.median),
        f"{ratio[0]:.3f} [{ratio[1]:.3f} .. {ratio[2]:.3f}]" if known else "",
        html_page.format_number(kokkos.error) if kokkos.error is not None else "", _verdict(kokkos),
    ]


def sections(records: list[Record]) -> list[Section]:
    """One section on the pairs of records, none without a pair."""
    by_case = {record.case: record for record in records}
    pairs = []
    for record in records:
        other = by_case.get(record.case.removesuffix("/kokkos") + "/hand-written")
        if record.facts["version"] == "kokkos" and other is not None:
            pairs.append((record, other))
    if not pairs:
        return []
    pairs.sort(key=lambda pair: (pair[0].case.split("/")[2], pair[0].facts["launches"], pair[0].facts["cells"]))
    columns = [("kernel", False), ("size", True), ("launches", False), ("Kokkos, us per step", True), ("CUDA", True)]
    columns += [("ratio and its interval", True), ("difference", True), (f"goal: at most {_LARGEST_RATIO}", False)]
    note = "The same algorithm, layout and block size. The goal holds from a million cells or vertices."
    table = Table(columns, [_row(*pair) for pair in pairs], "Time in Kokkos over time in CUDA", note)
    command = "drogue-perf table abstraction --app APP --out FILE.jsonl"
    return [Section("Cost of Kokkos", command, [record for pair in pairs for record in pair], tables=[table])]
