"""Parts of a page of records: sections, tables, cells and pictures."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from .perf_record import Record


class Cell(NamedTuple):
    """Text of a table cell with a CSS class."""

    text: str
    css_class: str = ""


@dataclass(frozen=True)
class Table:
    """Table with columns (heading, whether numeric); a folded table opens on a click."""

    columns: list[tuple[str, bool]]
    rows: list[list[Cell | str]]
    title: str = ""
    note: str = ""
    folded: bool = False

    def without_empty_columns(self) -> "Table":
        """The table without the columns that have no word in any row."""
        kept = [k for k in range(len(self.columns)) if not self.rows or any(self._text(row[k]) for row in self.rows)]
        return replace(self, columns=[self.columns[k] for k in kept], rows=[[row[k] for k in kept] for row in self.rows])

    @staticmethod
    def _text(value: "Cell | str") -> str:
        return str(value.text if isinstance(value, Cell) else value)


@dataclass(frozen=True)
class Picture:
    """Figure, drawn on demand by `draw()`, with a file name without suffix and an alternative text."""

    name: str
    draw: Callable
    alt_text: str


@dataclass(frozen=True)
class Section:
    """Section of one machine; `command` is the command that wrote its `records`."""

    title: str
    command: str
    records: list[Record]
    pictures: list[Picture] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)

    @property
    def sources(self) -> list[str]:
        """Date, commit and compiler of each run whose records are shown."""
        lines = []
        for record in self.records:
            known = {
                name: str(record.provenance.get(name) or "")
                for name in ("date", "git", "compiler", "kokkos", "driver")
            }
            words = [known["date"].partition("T")[0] or "date unknown", f"commit {known['git'] or 'unknown'}"]
            words += [known["compiler"] or "compiler unknown"]
            words += [f"Kokkos {known['kokkos']}"] if known["kokkos"] else []
            words += [f"driver {known['driver']}"] if known["driver"] else []
            lines.append(", ".join(words))
        return list(dict.fromkeys(lines))


def format_cells(cells: int) -> str:
    """Number of cells, in units of 2^20 (`M`) where it is a multiple."""
    return f"{cells >> 20} M" if cells >= 1 << 20 and cells % (1 << 20) == 0 else str(cells)
