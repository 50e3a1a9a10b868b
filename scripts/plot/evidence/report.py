"""One page of all records of a folder: samples of every case, then the sections of every mini-app."""

import tempfile
from pathlib import Path
from statistics import median

from markupsafe import Markup

from .. import html_page
from . import page
from .perf_record import Machine, Record
from .records import Evidence
from .section import Cell, Table

MOST_STRIPS = 1000  # cases whose samples are drawn: a strip takes half a kilobyte, and a page less than 5 MB
_WIDTH, _HEIGHT, _MARGIN = 180, 16, 3
_APPS = {
    "gas": "Gas dynamics", "springs": "Cloth and strings", "options": "Options", "flow": "Flow and parachutes",
}  # fmt: skip


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
        record.case,
        html_page.format_seconds(median(timed)) if timed else Cell("none"),
        f"{html_page.format_seconds(interval[0])} .. {html_page.format_seconds(interval[1])}" if interval else "",
        record.unit.removeprefix("s "),
        Cell(strip(timed)) if timed and drawn else "",
        html_page.format_number(record.error) if record.error is not None else "not finite",
        Cell(record.check, "good" if record.check == "passed" else "bad"),
    ]


def samples_table(records: list[Record], drawn: bool) -> Table:
    """All records of a machine, one a row, failed ones included; `drawn`: with their samples."""
    columns = [
        ("case", False), ("median", True), ("interval", True), ("of", False), ("samples, 0 to twice the median", False),
        ("error", True), ("check", False),
    ]  # fmt: skip
    note = "" if drawn else f"Samples are drawn for up to {MOST_STRIPS} records."
    return Table(columns, [_row(record, drawn) for record in records], note=note)


def _by_machine(records: list[Record]) -> dict[Machine, list[Record]]:
    found: dict[Machine, list[Record]] = {}
    for record in records:
        found.setdefault(record.machine, []).append(record)
    return found


def write(evidence: Evidence, file: Path, dpi: int) -> Path:
    """Writes the page, which refers to no other file; returns its path. Raises Failure (IO_ERROR)."""
    drawn = len(evidence.everything) <= MOST_STRIPS
    machines = [(machine, samples_table(own, drawn)) for machine, own in _by_machine(evidence.everything).items()]
    with tempfile.TemporaryDirectory() as folder:
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
        dates = sorted({record.run_id[0] for record in evidence.everything} - {""})
        return html_page.write(
            file, "evidence/report.html.j2", pictures.filters, machines=machines, apps=apps, dates=dates,
            notes=page.notes(evidence), folder=evidence.folder.resolve().name, count=len(evidence.everything),
        )  # fmt: skip
