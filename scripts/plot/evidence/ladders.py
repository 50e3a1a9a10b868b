"""Sections on ladders: predicted and measured time of each rung, and the error."""

from markupsafe import Markup

from .. import html_page, style
from ..style import plt
from .perf_record import BACKENDS, Machine, Record
from .section import Picture, Section, Table

_MEASURED, _PREDICTED = ("measured", style.PALETTE[0]), ("predicted before", style.PALETTE[4])


def ladder_figure(title: str, machine: Machine, records: list[Record]):
    """Figure of predicted and measured time per rung on a logarithmic axis, the first rung at the top."""
    details = f"{records[0].unit.removeprefix('s ')}, size {records[0].facts['cells']}; {machine.name}"
    legend = [("\u25cf", *_MEASURED), ("\u25cb", *_PREDICTED)]
    figure, axis = plt.subplots()
    names = [record.facts["rung"] for record in records]
    left = 0.3 + max(style.text_width(figure, name, 8) for name in names)
    height = 1.1 + 0.26 * len(records)
    width = max(left + 4.4, style.heading_width(figure, title, legend), style.subtitle_width(figure, details))
    figure.set_size_inches(width, height)
    figure.subplots_adjust(left=left / width, right=1 - 0.25 / width, bottom=0.5 / height, top=1 - 0.6 / height)
    for place, record in enumerate(records):
        predicted, measured = 1e6 * record.facts["predicted_s"], 1e6 * record.median
        axis.plot([predicted, measured], [place, place], color=style.MUTED, linewidth=0.6)
        axis.plot(predicted, place, "o", color=_PREDICTED[1], markerfacecolor="white", markersize=4.5)
        axis.plot(measured, place, "o", color=_MEASURED[1], markersize=4.5)
    axis.set_yticks(range(len(names)), names)
    axis.set_ylim(len(names) - 0.5, -0.5)
    axis.set_xscale("log")
    style.set_log_ticks(axis.xaxis)
    axis.set_xlabel("\u00b5s")
    style.heading(figure, title, details, legend)
    return figure


def ladder_table(records: list[Record]) -> Table:
    """Rungs in their order."""
    columns = [
        ("rung", False), ("predicted (\u00b5s)", True), ("bound", False), ("measured (\u00b5s)", True), ("95 %", True),
        ("faster than the first", True), ("error", True),
    ]
    rows = []
    for record in records:
        low, high = (html_page.format_number(1e6 * end) for end in record.interval)
        rows.append(
            [
                record.facts["rung"], html_page.format_number(1e6 * record.facts["predicted_s"]),
                record.facts["predicted_bound"], html_page.format_number(1e6 * record.median), Markup("{} .. {}").format(low, high),
                html_page.format_number(records[0].median / record.median), html_page.format_number(record.error),
            ]
        )
    return Table(columns, rows)


def sections(machine: Machine, records: list[Record]) -> list[Section]:
    """One section per ladder and backend."""
    found = []
    groups: dict[tuple[str, str, int], list[Record]] = {}
    for record in records:
        groups.setdefault((record.facts["ladder"], record.facts["backend"], record.facts["cells"]), []).append(record)
    for (ladder, backend, _), own in groups.items():
        title = f"Ladder {ladder}, {BACKENDS.get(backend, backend)}"
        picture = Picture(
            f"ladder-{ladder}_{backend}_{machine.slug}",
            lambda title=title, own=own: ladder_figure(title, machine, own),
            f"{title}: predicted and measured time of each of {len(own)} rungs",
        )
        note = "Predicted from counted work and measured ceilings, before the rung was timed. The error is relative to the reference."
        command = f"drogue-perf ladder {ladder} --backend {backend} --out FILE.jsonl"
        found.append(Section(title, command, own, [picture], [ladder_table(own)], [note]))
    return found
