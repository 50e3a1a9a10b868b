"""docs/lessons/tables.md: the ladders as recorded in docs/evidence/ladders/*.jsonl."""

import sys

from .forms import EVIDENCE, passed, table

HEAD = """# Ladders as measured

Written by `scripts/publish_records.py --tables` from the records in `docs/evidence/ladders/`, which
`drogue-perf ladder NAME --backend B --out FILE` wrote. Microseconds; "predicted" is computed from counted work and
measured ceilings before the rung is timed; "faster" compares with the first rung. Pictures are those of
`drogue-plot docs/evidence/ladders`.
"""


def microseconds(seconds):
    """Four digits without an exponent."""
    value = 1e6 * seconds
    return f"{value:.0f}" if value >= 1000 else f"{value:.4g}"


def picture(record):
    """Picture of a ladder as `drogue-plot docs/evidence/ladders` names it, half as large as its pixels."""
    ladder, backend = record.facts["ladder"], record.facts["backend"]
    file = f"ladders/ladder-{ladder}_{backend}_{record.machine.slug}.png"
    if not (EVIDENCE / file).is_file():
        sys.exit(f"docs/evidence/{file} is missing: start drogue-plot docs/evidence/ladders")
    words = f"Ladder {ladder} on {backend}: predicted and measured time"
    return f'<img width="440" alt="{words}"\n     src="../evidence/{file}">\n'


def section(file):
    """Heading, table and picture of a file of records."""
    records = passed(file)
    first = records[0]
    facts = first.facts
    rows = [[f"`{record.facts['rung']}`", microseconds(record.facts["predicted_s"]), record.facts["predicted_bound"],
             microseconds(record.median), f"[{' .. '.join(map(microseconds, record.interval))}]",
             f"{first.median / record.median:.2f}", f"{record.error:.2g}"] for record in records]
    return "\n".join([
        f"\n## `{facts['ladder']}` on {facts['backend']}\n",
        f"{first.device(facts['backend'] == 'cuda')}, {first.run_id[0][:10]}, size {facts['cells']}, {first.unit.removeprefix('s ')} "
        f"([record](../evidence/ladders/{file.name}))\n",
        *table(["rung", "predicted", "bound", "measured", "95 % interval", "faster", "error"], rows, (0, 2, 4)), "", picture(first),
    ])


def page():
    """Text of the page."""
    return HEAD + "".join(section(file) for file in sorted((EVIDENCE / "ladders").glob("*.jsonl")))
