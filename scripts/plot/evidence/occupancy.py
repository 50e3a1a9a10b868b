"""Section on the model of occupancy: Table 4.2 of [Shi], step kernels of gas, and profiled kernels."""

from .. import html_page
from .perf_record import Record
from .section import Cell, Section, Table

_LIMITS = ("registers", "shared_memory", "threads", "limit")
_MOST_OPEN_ROWS = 40  # of a table without contradictions that is not folded


def _percent(record: Record) -> str:
    return f"{100 * record.facts['occupancy']:.1f}"


def _beside(value, other) -> str:
    return f"{value} ({other})"


def _check(record: Record) -> Cell:
    return Cell(record.check, "good" if record.check == "passed" else "bad")


def printed_table(records: list[Record]) -> Table:
    """Table 4.2: computed numbers beside those printed."""
    names = {
        "shared_bytes": "shared B", "blocks_by_registers": "by registers", "blocks_by_shared_memory": "by shared B",
        "blocks_by_limit": "by limit", "blocks": "blocks", "threads_sm": "threads", "threads_device": "of the device",
    }
    rows = []
    for record in records:
        printed = record.facts["thesis"]
        row = [str(record.facts["block"])]
        row += [_beside(record.facts.get(name, ""), printed.get(name, "")) for name in names]
        rows.append([*row, _beside(_percent(record), printed.get("occupancy_percent", "")), _check(record)])
    columns = [("block", True), *((heading, True) for heading in names.values()), ("% full", True), ("check", False)]
    note = (
        "The flux kernel of [Shi] on compute capability 2.0, computed (printed). Shared B: bytes of shared memory. Blocks and "
        "threads: resident on a multiprocessor; % full: of the threads that it holds."
    )
    return Table(columns, rows, "Table 4.2", note)


def steps_table(architecture: str, records: list[Record]) -> Table:
    """Step kernels of gas by block size on an architecture."""
    columns = [
        ("block", True), ("slots", True), ("registers", True), ("shared B", True), ("by registers", True),
        ("by shared B", True), ("by threads", True), ("by limit", True), ("blocks", True), ("requested", True),
        ("% full", True), ("check", False),
    ]
    rows = []
    for record in records:
        facts = record.facts
        block = f"{facts['block']}, large mesh" if "large-mesh" in record.case else str(facts["block"])
        found = [block, str(facts.get("slots", "")), str(facts["registers"]), html_page.format_grouped(facts["shared_bytes"])]
        found += [str(facts[f"blocks_by_{limit}"]) for limit in _LIMITS]
        short = facts["blocks"] < facts.get("least_blocks", 0)
        found += [Cell(str(facts["blocks"]), "bad" if short else ""), str(facts.get("least_blocks", ""))]
        rows.append([*found, _percent(record), _check(record)])
    note = "Predicted from the launch bounds, which request a number of blocks on sm_90; elsewhere fewer blocks are no fault."
    return Table(columns, rows, f"The fused step of drogue-gas on {architecture}", note)


def _devices(records: list[Record]) -> str:
    """GPUs of profiled kernels in words. Older profiles do not state their name."""
    found = set()
    for record in records:
        facts = record.facts
        count = facts.get("threads_device", 0) // max(1, facts["threads_sm"])
        kind = f"{facts['architecture']}" + (f" with {count} multiprocessors" if count else "")
        found.add(f"{facts['device']} ({kind})" if "device" in facts else f"a GPU of architecture {kind}")
    return " and ".join(sorted(found))


def profile_table(records: list[Record]) -> Table:
    """Profiled kernels: resident blocks of the model beside those of ncu, contradictions first."""
    columns = [
        ("kernel", False), ("device", False), ("block", True), ("registers", True), ("shared B", True),
        ("model", True), ("ncu", True), ("mean", True), ("% full", True), ("limit", False),
        ("check", False),
    ]
    rows = []
    for record in sorted(records, key=lambda record: record.check != "failed"):
        facts, achieved = record.facts, record.facts.get("achieved", {})
        mean = achieved.get("mean_blocks")
        rows.append(
            [
                Cell(facts["kernel"].removeprefix("drogue::"), "case"), facts["architecture"], str(facts["block"]),
                str(facts["registers"]), html_page.format_grouped(facts["shared_bytes"]), str(facts["blocks"]),
                str(achieved.get("blocks", "")), f"{mean:.2f}" if isinstance(mean, int | float) else "",
                _percent(record), facts.get("limited_by", "").replace("shared_memory", "shared B"), _check(record),
            ]
        )
    note = (
        f"The kernels ran on {_devices(records)}; the processor in the title computed the model. Model and ncu: resident "
        "blocks, predicted and by ncu's limits of the launch; mean: by counters, of the largest launch. Contradictions come first."
    )
    is_right = all(record.check == "passed" for record in records)
    return Table(columns, rows, "Profiled kernels", note, is_right and len(rows) > _MOST_OPEN_ROWS)


def sections(records: list[Record]) -> list[Section]:
    """One section, none without records."""
    if not records:
        return []
    printed = [record for record in records if "thesis" in record.facts]
    profiled = [record for record in records if "kernel" in record.facts]
    of_gas: dict[str, list[Record]] = {}
    for record in records:
        if record not in printed and record not in profiled:
            of_gas.setdefault(record.facts["architecture"], []).append(record)
    tables = [printed_table(printed)] if printed else []
    tables += [steps_table(architecture, own) for architecture, own in of_gas.items()]
    tables += [profile_table(profiled)] if profiled else []
    right = sum(record.check == "passed" for record in profiled)
    notes = [f"{right} of {len(profiled)} profiled kernels are predicted to the block."] if profiled else []
    command = "drogue-perf table occupancy [--architecture NAME] [--profile FILE] --out FILE.jsonl"
    return [Section("Occupancy", command, records, tables=tables, notes=notes)]
