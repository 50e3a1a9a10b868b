"""Times that the measured ceilings of a device allow a step at least, and the one that binds it."""

from typing import NamedTuple

from markupsafe import Markup

from .. import html_page
from .perf_record import BACKENDS, Machine, Record
from .section import Cell, Section, Table, format_cells

# Ceilings in units of work per second: fact of the record, words.
RATES = {
    "fp64": ("flops", "FP64 arithmetic"),
    "fp32": ("flops", "FP32 arithmetic"),
    "issue": ("instructions", "issue of instructions"),
    "memory": ("bytes", "memory, read and written"),
    "l3": ("bytes", "L3 cache, read and written"),
    "l2": ("bytes", "L2 cache, read and written"),
    "cache": ("bytes", "cache, read and written"),
}
_UNITS = {"flops": "FLOP/s", "bytes": "B/s", "instructions": "instructions/s"}
LATENCIES = {"launch": "launch of a kernel", "graph-node": "kernel in a graph"}  # s
# Kinds whose unit of work is a batch, each variant of which is another problem: their title, and what is not counted.
_BATCHES = {
    "options": ("Bounds of a batch", " Of puts the marches alone are counted, without the set-up of an option."),
    "tridiagonal": ("Bounds of tridiagonal systems", ""),
}
# A ceiling that explains less of the time binds nothing.
LEAST_SHARE = 1 / 3
_LEVELS = {"memory": "memory", "l3": "L3", "l2": "L2", "cache": "L1"}  # slowest first


def word(name: str, backend: str) -> str:
    """Words for a ceiling; the cache of a GPU is its second level, that of a core the first."""
    if name == "cache":
        return f"{'L2' if backend == 'cuda' else 'L1'} {RATES[name][1]}"
    return LATENCIES.get(name) or RATES[name][1]


def ceilings(records: list[Record]) -> dict[str, float]:
    """Measured ceilings: FLOP/s, B/s, instructions/s, and latencies in s."""
    found = {}
    for record in records:
        name = record.case.split("/")[1] if "/" in record.case else ""
        if name in LATENCIES:
            found[name] = record.median
        elif name in RATES and record.facts.get(RATES[name][0], 0) > 0:
            found[name] = record.facts[RATES[name][0]] / record.median
    return found


def backend_ceilings(records: list[Record], backend: str) -> tuple[dict[str, float], str]:
    """Ceilings of a backend of one machine, and a note on those of one core that stand for those of its threads, or nothing.

    Threads start and end together, which takes a part of a short measurement: of several, they reach no less than one.
    """
    tops, one = (ceilings([record for record in records if record.facts["backend"] == name]) for name in (backend, "serial"))
    slower = [name for name in RATES if backend == "openmp" and tops.get(name, one.get(name, 0)) < one.get(name, 0)]
    words = [f"{word(name, backend)}: {scaled(tops[name], _UNITS[RATES[name][0]])}" for name in slower]
    note = f"Measured with threads below one core, whose rate stands here: {'; '.join(words)}." if words else ""
    return tops | {name: one[name] for name in slower}, note


class Bound(NamedTuple):
    """Least time of a step by one ceiling, s."""

    name: str
    seconds: float


def launch_seconds(facts: dict, tops: dict[str, float]) -> float | None:
    """Time that the launches of a step take at least, s; None if they or their latency are unknown."""
    in_graph = facts.get("driver") in ("graph", "stages") and facts["backend"] == "cuda"
    latency = tops.get("graph-node" if in_graph else "launch")
    return facts["launches"] * latency if latency and facts.get("launches") else None


def _traffic(record: Record, tops: dict[str, float]) -> Bound | None:
    """Time of the bytes from the slowest level that is fast enough: data in a cache do not come from memory."""
    moved = record.facts.get("bytes", 0)
    found = [Bound(_LEVELS[name], moved / tops[name]) for name in _LEVELS if name in tops]
    if not moved or not found:
        return None
    bound = next((bound for bound in found if bound.seconds <= record.median), found[-1])
    return Bound("L2", bound.seconds) if bound.name == "L1" and record.facts["backend"] == "cuda" else bound


def bounds(record: Record, tops: dict[str, float]) -> list[Bound]:
    """Bounds that are known: arithmetic, issue, traffic and launches."""
    facts, found = record.facts, []
    if facts.get("flops") and "fp64" in tops:
        found.append(Bound("FP64", facts["flops"] / tops["fp64"]))
    if facts.get("instructions") and "issue" in tops:
        found.append(Bound("issue", facts["instructions"] / tops["issue"]))
    traffic, launches = _traffic(record, tops), launch_seconds(facts, tops)
    found += [traffic] if traffic else []
    return found + ([Bound("launches", launches)] if launches else [])


def _verdict(record: Record, found: list[Bound]) -> str:
    """The largest bound with its share of the time, or why there is none."""
    if not found:
        return "no work is counted"
    largest = max(found, key=lambda bound: bound.seconds)
    share = largest.seconds / record.median
    words = Markup("{}, {} %").format(largest.name, html_page.format_number(100 * share))
    if share >= LEAST_SHARE:
        return words
    # Where work is not counted, or its ceiling not measured, something other than latencies may take the time.
    if not {"FP64", "issue"} <= {bound.name for bound in found}:
        return Markup("none of those known ({})").format(words)
    inside = " within one launch" if record.facts.get("driver") == "persistent" else ""
    return Markup("none: latencies{} ({})").format(inside, words)


def bounds_table(steps: list[Record], tops: dict[str, float]) -> Table | None:
    """Table of the default variants whose work is counted, of batches all, by increasing size; None without them."""
    rows, kind = [], steps[0].kind if steps else ""
    for record in sorted(steps, key=lambda record: record.facts["cells"]):
        if kind not in _BATCHES and record.facts["variant"] not in ("", "periodic", "tunnel"):
            continue
        found = bounds(record, tops)
        if not found and "driver" not in record.facts:
            continue
        at = {bound.name: html_page.format_number(1e6 * bound.seconds) for bound in found}
        traffic = next((Markup("{} ({})").format(at[level], level) for level in ("memory", "L3", "L2", "L1") if level in at), "")
        rows.append(
            [
                f"{format_cells(record.facts['cells'])} {record.facts['variant']}".strip(),
                html_page.format_number(1e6 * record.median), *(at.get(name, "") for name in ("FP64", "issue")),
                traffic, at.get("launches", ""), _verdict(record, found),
            ]
        )
    if not rows:
        return None
    unit = "batch" if kind in _BATCHES else "step"
    columns = [("size", True), (f"us per {unit}", True), ("FP64", True), ("issue", True), ("traffic", True)]
    columns += [("launches", True), ("binding ceiling, its share", False)]
    note = (
        "Least times in us: counted work over the measured ceiling, launches times their latency. "
        "Traffic counts each array of a kernel once, from the slowest level that is fast enough."
    )
    return Table(columns, rows, f"What binds a {unit}", note + _BATCHES.get(kind, ("", ""))[1])


def ceiling_table(tops: dict[str, float], backend: str, note: str = "") -> Table:
    """Table of the measured ceilings with a note."""
    rows: list[list[Cell | str]] = []
    for name, (fact, _) in RATES.items():
        if name in tops:
            rows.append([word(name, backend), scaled(tops[name], _UNITS[fact])])
    for name in LATENCIES:
        if name in tops:
            rows.append([word(name, backend), Markup("{} us").format(html_page.format_number(1e6 * tops[name]))])
    return Table([("ceiling", False), ("measured", True)], rows, note=note)


def scaled(value: float, unit: str) -> str:
    """Rate with the prefix T or G."""
    prefix, factor = ("T", 1e12) if value >= 1e12 else ("G", 1e9)
    return f"{value / factor:.3g} {prefix}{unit}"


def sections(machine: Machine, measured: list[Record], steps: list[Record]) -> list[Section]:
    """One section per backend with ceilings and counted steps, for mini-apps without a roofline."""
    found = []
    for backend in dict.fromkeys(record.facts["backend"] for record in measured):
        own = [record for record in measured if record.facts["backend"] == backend and record.machine == machine]
        beside = [record for record in steps if record.facts["backend"] == backend]
        tops, note = backend_ceilings([record for record in measured if record.machine == machine], backend)
        table = bounds_table(beside, tops) if tops else None
        if table is None:
            continue
        kind = beside[0].kind
        command = f"drogue-perf run --filter '^(ceiling|{kind})/' --out FILE.jsonl"
        title = f"{_BATCHES.get(kind, ('Bounds of a step', ''))[0]}, {BACKENDS.get(backend, backend)}"
        found.append(Section(title, command, own + beside, tables=[table, ceiling_table(tops, backend, note)]))
    return found
