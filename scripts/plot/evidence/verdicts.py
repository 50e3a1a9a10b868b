"""Verdicts on records against a baseline, as drogue-perf report --baseline writes them."""

import json
from pathlib import Path
from typing import NamedTuple

from .. import html_page
from .section import Cell, Table

# Changes come first.
_ORDER = ["SLOWER", "ERROR-CHANGED", "FASTER", "AMBIGUOUS", "SAME", "NOT-COMPARABLE"]
_CLASSES = {"SLOWER": "bad", "ERROR-CHANGED": "bad", "FASTER": "good"}
_MOST_OPEN_ROWS = 200


class Verdicts(NamedTuple):
    """Table of the cases with the facts above it."""

    old: str
    new: str
    summary: str
    table: Table


def _row(case: dict) -> list[Cell | str]:
    number = case["ratio"] is not None
    interval = number and case["low"] is not None
    return [
        Cell(case["case"], "case"),
        Cell(case["verdict"], _CLASSES.get(case["verdict"], "")),
        f"{case['ratio']:.3f}" if number else "",
        f"{case['low']:.3f} .. {case['high']:.3f}" if interval else "",
        html_page.format_seconds(case["old_s"]) if number else "",
        html_page.format_seconds(case["new_s"]) if number else "",
        case["unit"].removeprefix("s ") if number else case["reason"],
    ]


def read(file: Path) -> Verdicts:
    """The verdicts of a file."""
    document = json.loads(file.read_text(encoding="utf-8"))
    cases = sorted(document["cases"], key=lambda case: _ORDER.index(case["verdict"]))
    columns = [
        ("case", False), ("verdict", False), ("times as long", True), ("95 % interval", True), ("old", True), ("new", True),
        ("of", False),
    ]
    folded = len(cases) > _MOST_OPEN_ROWS
    table = Table(columns, [_row(case) for case in cases], title="Cases" if folded else "", folded=folded)
    return Verdicts(document["old"], document["new"], document["summary"], table)
