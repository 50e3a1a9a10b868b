#!/usr/bin/env python3
"""Writes docs/lessons/tables.md: the ladders as recorded in docs/evidence/ladders/*.jsonl.

  scripts/lesson_tables.py [--check]     --check: writes nothing, exit code 1 if the page differs from the records
"""

import json
import pathlib
import re
import sys

from device_name import device_name

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/lessons/tables.md"
HEAD = """# Ladders as measured

Written by `scripts/lesson_tables.py` from the records in `docs/evidence/ladders/`, which
`drogue-perf ladder NAME --backend B --out FILE` wrote. Microseconds; "predicted" is computed from counted work and
measured ceilings before the rung is timed; "faster" compares with the first rung. Pictures are those of
`drogue-plot docs/evidence/ladders`.
"""


def microseconds(seconds):
    """Four digits without an exponent."""
    value = 1e6 * seconds
    return f"{value:.0f}" if value >= 1000 else f"{value:.4g}"


def picture(facts, machine):
    """Picture of a ladder as `drogue-plot docs/evidence/ladders` names it, half as large as its pixels."""
    slug = re.sub("[^a-z0-9]+", "-", machine.lower()).strip("-")
    file = f"ladders/ladder-{facts['ladder']}_{facts['backend']}_{slug}.png"
    if not (ROOT / "docs/evidence" / file).is_file():
        sys.exit(f"docs/evidence/{file} is missing: start drogue-plot docs/evidence/ladders")
    words = f"Ladder {facts['ladder']} on {facts['backend']}: predicted and measured time"
    return f'<img width="440" alt="{words}"\n     src="../evidence/{file}">\n'


def table(file):
    """Heading, table and picture of a file of records."""
    records = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    for record in records:
        if record["check"] != "passed":
            sys.exit(f"{file}: {record['case']} failed its check")
    facts, here = records[0]["facts"], records[0]["provenance"]
    machine = device_name(here, facts["backend"] == "cuda")
    lines = [f"\n## `{facts['ladder']}` on {facts['backend']}\n",
             f"{machine}, {here['date'][:10]}, size {facts['cells']}, {records[0]['unit'].removeprefix('s ')} "
             f"([record](../evidence/ladders/{file.name}))\n",
             "| rung | predicted | bound | measured | 95 % interval | faster | error |", "|---|---:|---|---:|---|---:|---:|"]
    first = records[0]["median"]
    for record in records:
        low, high = record["interval"]
        lines.append(f"| `{record['facts']['rung']}` | {microseconds(record['facts']['predicted_s'])} | "
                     f"{record['facts']['predicted_bound']} | {microseconds(record['median'])} | "
                     f"[{microseconds(low)} .. {microseconds(high)}] | {first / record['median']:.2f} | {record['error']:.2g} |")
    return "\n".join([*lines, "", picture(facts, machine)])


def page():
    """Text of the page."""
    return HEAD + "".join(table(file) for file in sorted((ROOT / "docs/evidence/ladders").glob("*.jsonl")))


def main():
    if sys.argv[1:] == ["--check"]:
        if PAGE.read_text(encoding="utf-8") != page():
            sys.exit("docs/lessons/tables.md differs from its records; run scripts/lesson_tables.py")
        return
    if sys.argv[1:]:
        sys.exit(__doc__)
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
