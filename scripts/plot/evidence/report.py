"""One page of all records of a folder: samples of every case, then the sections of every mini-app."""

import tempfile
from dataclasses import replace
from pathlib import Path
from statistics import median

from markupsafe import Markup

from .. import html_page
from ..program import at_signal
from . import page
from .perf_record import STATED, Machine, Record
from .records import Evidence
from .section import Cell, Section, Table
from .verdicts import read as read_verdicts

MOST_BYTES = 5_000_000  # of a page
MOST_STRIPS = 1000  # cases whose samples are drawn: a strip takes half a kilobyte
MOST_ROWS = 5000  # records that have rows of their own, of a third of a kilobyte; failed ones always do
_MOST_OPEN_ROWS = 200  # of a table that is not folded
_FEW_ROWS = 50  # of a table of a page that is too large otherwise
_WIDTH, _HEIGHT, _MARGIN = 180, 16, 3
_APPS = {
    "gas": "Gas dynamics", "springs": "Cloth and strings", "options": "Options", "flow": "Flow and parachutes",
    "ladder": "Ladders", "machine": "Machine and occupancy",
}


def strip(samples: tuple[float, ...]) -> str:
    """SVG of the samples of a case on a line from zero to twice the median, the later half of them darker.

    A sample beyond twice the median is drawn at the right end.
    """
    middle, half = median(samples), (len(samples) + 1) // 2
    place = [_MARGIN + (_WIDTH - 2 * _MARGIN) * min(sample / (2 * middle), 1.0) for sample in samples]
    dots = "".join(
        f'<path class="{name}" d="{"".join(f"M{x:.1f} {_HEIGHT / 2:g}h0" for x in part)}"/>'
        for name, part in (("early", place[:half]), ("late", place[half:]))
        if part
    )
    words = f"{len(samples)} samples from {html_page.format_seconds(min(samples))} to {html_page.format_seconds(max(samples))}"
    return Markup(
        f'<svg class="strip" role="img" aria-label="{words}" width="{_WIDTH}" height="{_HEIGHT}">'
        f'<path d="M{_MARGIN} {_HEIGHT / 2:g}H{_WIDTH - _MARGIN}M{_WIDTH / 2:g} 2V{_HEIGHT - 2}"/>{dots}</svg>'
    )


def _row(record: Record, drawn: bool) -> list[Cell | str]:
    # A wrong result has no time.
    timed = [] if record.check == "failed" else record.samples
    interval = record.interval or (min(timed), max(timed)) if timed else None
    return [
        Cell(f"{record.case}, cold caches" if record.cold_caches else record.case, "case"),
        html_page.format_seconds(median(timed)) if timed else Cell("none"),
        f"{html_page.format_seconds(interval[0])} .. {html_page.format_seconds(interval[1])}" if interval else "",
        record.unit.removeprefix("s "),
        html_page.format_number(record.error) if record.error is not None else "not finite",
        Cell(record.check, "good" if record.check == "passed" else "bad"),
        *([Cell(strip(timed)) if timed else ""] if drawn else []),
    ]


def samples_table(records: list[Record], drawn: bool) -> Table:
    """All records of a machine, one a row, failed ones included; `drawn`: with their samples. Many rows are folded."""
    columns = [
        ("case", False), ("median", True), ("interval", True), ("of", False), ("error", True), ("check", False),
        *([("samples, 0 to twice the median", False)] if drawn else []),
    ]
    note = "" if drawn else f"Samples are drawn for up to {MOST_STRIPS} records."
    folded = len(records) > _MOST_OPEN_ROWS
    return Table(columns, [_row(record, drawn) for record in records], title="Records" if folded else "", note=note, folded=folded)


def summary_table(records: list[Record]) -> Table:
    """Records of a machine by kind, backend and variant instead of by case."""
    groups: dict[tuple[str, str], list[Record]] = {}
    for record in records:
        groups.setdefault((record.kind, str(record.facts.get("backend", ""))), []).append(record)
    columns = [
        ("kind", False), ("backend", False), ("records", True), ("failed", True), ("least median", True),
        ("largest median", True), ("largest error", True),
    ]
    rows = []
    for (kind, backend), own in groups.items():
        medians = [median(record.samples) for record in own if record.samples and record.check == "passed"]
        errors = [record.error for record in own if record.error is not None]
        rows.append(
            [
                kind, backend, html_page.format_grouped(len(own)),
                html_page.format_grouped(sum(record.check == "failed" for record in own)),
                html_page.format_seconds(min(medians)) if medians else "", html_page.format_seconds(max(medians)) if medians else "",
                html_page.format_number(max(errors)) if errors else "not finite",
            ]
        )
    return Table(columns, rows, note="records.csv, which drogue-perf report writes beside this page, lists every record.")


def _samples_tables(records: list[Record], count: int) -> list[Table]:
    """Tables of a machine whose records are among `count` on the page."""
    if count <= MOST_ROWS:
        return [samples_table(records, count <= MOST_STRIPS)]
    failed = [record for record in records if record.check == "failed"][:_FEW_ROWS]
    return [summary_table(records), *([samples_table(failed, False)] if failed else [])]


def _shortened(section: Section) -> Section:
    """The section with few rows in each table."""

    def short(table: Table) -> Table:
        hidden = len(table.rows) - _FEW_ROWS
        if hidden <= 0:
            return table
        note = f"{table.note} {hidden} more rows are left out to keep the page below 5 MB.".strip()
        return replace(table, rows=table.rows[:_FEW_ROWS], note=note)

    failures = section.failures[:_FEW_ROWS]
    if len(section.failures) > _FEW_ROWS:
        failures.append(f"and {len(section.failures) - _FEW_ROWS} more")
    return replace(section, tables=[short(table) for table in section.tables], failures=failures)


def _by_machine(records: list[Record]) -> dict[Machine, list[Record]]:
    found: dict[Machine, list[Record]] = {}
    for record in records:
        found.setdefault(record.machine, []).append(record)
    return found


def write(evidence: Evidence, file: Path, dpi: int, verdicts: Path | None = None) -> Path:
    """Writes the page, which refers to no other file; returns its path. Raises Failure (IO_ERROR).

    `verdicts`: a file of verdicts against a baseline, which the page then begins with.
    """
    count = len(evidence.everything)
    timed = [record for record in evidence.everything if record.kind not in STATED]
    machines = [(machine, _samples_tables(own, count)) for machine, own in _by_machine(timed).items()]
    temporary = tempfile.TemporaryDirectory()
    at_signal.append(temporary.cleanup)
    with temporary as folder:
        pictures = page.Pictures(Path(folder), dpi)
        apps = []
        for app in evidence.apps:
            sections = page.machine_sections(app, evidence.for_app(app))
            sections = [(machine, found) for machine, found in sections if found]
            for _, found in sections:
                for section in found:
                    for picture in section.pictures:
                        list(pictures.save(picture))
            if sections:
                apps.append((app, _APPS.get(app, app), sections))
        values = {
            "machines": machines, "dates": sorted({record.run_id[0][:10] for record in evidence.everything} - {""}),
            "notes": page.notes(evidence), "folder": evidence.folder.resolve().name, "count": count,
            "drawn": count <= MOST_STRIPS, "verdicts": read_verdicts(verdicts) if verdicts else None,
        }
        written = html_page.write(file, "evidence/report.html.j2", pictures.filters, apps=apps, **values)
        if written.stat().st_size < MOST_BYTES:
            return written
        apps = [(app, name, [(machine, [_shortened(s) for s in found]) for machine, found in sections])
                for app, name, sections in apps]
        return html_page.write(file, "evidence/report.html.j2", pictures.filters, apps=apps, **values)
