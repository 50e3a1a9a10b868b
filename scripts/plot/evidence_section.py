"""Parts of the evidence page: what a section shows, and how its cells are written."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

from .perf_record import Record


class Cell(NamedTuple):
    text: str
    css: str = ""


@dataclass(frozen=True)
class Table:
    """Columns are (heading, whether numbers stand in it); a folded table opens on a click."""

    columns: list[tuple[str, bool]]
    rows: list[list[Cell | str]]
    title: str = ""
    note: str = ""
    folded: bool = False


@dataclass(frozen=True)
class Picture:
    """A figure to be drawn under a name without suffix, and what a reader who cannot see it is told."""

    name: str
    draw: Callable
    words: str


@dataclass(frozen=True)
class Section:
    """One section of one machine; `records` are those that it shows, `command` what made them."""

    title: str
    command: str
    records: list[Record]
    pictures: list[Picture] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)

    @property
    def sources(self) -> list[str]:
        """Date, commit and compiler of every run whose records are shown."""
        lines = []
        for record in self.records:
            known = {
                name: str(record.provenance.get(name) or "") for name in ("date", "git", "compiler", "kokkos", "driver")
            }
            words = [known["date"].partition("T")[0] or "date unknown", f"commit {known['git'] or 'unknown'}"]
            words += [known["compiler"] or "compiler unknown"]
            words += [f"Kokkos {known['kokkos']}"] if known["kokkos"] else []
            words += [f"driver {known['driver']}"] if known["driver"] else []
            lines.append(", ".join(words))
        return list(dict.fromkeys(lines))


def cells_text(cells: int) -> str:
    """`1 M` for a mebi of cells as the rest of the documents writes it, else the number."""
    return f"{cells >> 20} M" if cells >= 1 << 20 and cells % (1 << 20) == 0 else str(cells)
