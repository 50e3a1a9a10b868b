"""Sections on tables 5.7 and 5.8 of [Shi]: its times for batches beside those of this machine."""

from dataclasses import dataclass

from .. import html_page, style
from ..evidence.perf_record import BACKENDS, Machine, Record
from ..evidence.section import Picture, Section, Table
from ..style import plt

_PARTS = {"h2d": "host to device", "compute": "compute", "d2h": "device to host", "total": "total"}
_CURVES = {
    "cpu": ("[Shi], CPU", style.MUTED, "--s"), "gpu": ("[Shi], GPU", style.INK, "--o"),
    "seed": ("its scheme, here", style.PALETTE[1], "-o"),
    "pide": ("ours, two solves for an error", style.PALETTE[0], "-o"),
}
_PANELS = {"one option": "intervals of the mesh", "128 intervals": "options"}


@dataclass(frozen=True)
class _Row:
    """Row of the table: parts of the time, us, and the error if it is known."""

    options: int
    mesh: int
    source: str
    parts: dict[str, float]
    error: float | None = None
    memory: str = ""


def _thesis_rows(record: Record) -> list[_Row]:
    """Rows of the CPU and GPU times of [Shi] that a record carries."""
    thesis, place = record.facts.get("thesis") or {}, (record.facts["cells"], record.facts["mesh"])
    times = {name: float(value) for name, value in thesis.items() if isinstance(value, int | float)}
    rows = [_Row(*place, "cpu", {"total": times["cpu_us"]})] if "cpu_us" in times else []
    if "total_us" in times:
        rows.append(_Row(*place, "gpu", {part: times[f"{part}_us"] for part in _PARTS if f"{part}_us" in times}))
    return rows


def transfer_rows(records: list[Record]) -> list[_Row]:
    """Rows by increasing batch and mesh: the times of [Shi], then those of its scheme and of ours here."""
    found = {}
    for record in records:
        facts = record.facts
        parts = {part: 1e6 * facts[f"{part}_s"] for part in _PARTS if part != "total"} | {"total": 1e6 * record.median}
        own = _Row(facts["cells"], facts["mesh"], facts["method"], parts, record.error, facts.get("memory", ""))
        for row in [*_thesis_rows(record), own]:
            found[row.options, row.mesh, row.source, row.memory] = row
    order = list(_CURVES)
    return sorted(found.values(), key=lambda row: (row.options, row.mesh, order.index(row.source), row.memory))


def transfers_figure(title: str, machine: Machine, records: list[Record]):
    """Figure of total time against the mesh of one option, and against the batch size, on logarithmic axes."""
    rows, details = transfer_rows(records), f"from host to host; {machine.name}"
    figure, axes = plt.subplots(1, 2, sharey=True)
    legend = [
        ("\u2013 \u2013" if line.startswith("--") else "\u2014", words, colour)
        for words, colour, line in _CURVES.values()
    ]
    width = max(6.6, style.heading_width(figure, title, legend), style.subtitle_width(figure, details))
    height = 3.3
    figure.set_size_inches(width, height)
    for panel, (name, across) in zip(axes, _PANELS.items()):
        single = name == "one option"
        for source, (_, colour, line) in _CURVES.items():
            # The pinned one of both kinds of memory, which sorts after the pageable one.
            points = {
                row.mesh if single else row.options: 1e-6 * row.parts["total"]
                for row in rows
                if row.source == source and (row.options == 1 if single else row.mesh == 128)
            }
            if points:
                panel.plot(
                    *zip(*points.items()), line, color=colour, markersize=3.6, markerfacecolor="white", linewidth=1.2
                )
        panel.set_xscale("log", base=2)
        panel.set_yscale("log")
        panel.xaxis.set_major_formatter(lambda value, _: f"{value:.0f}")
        style.set_log_ticks(panel.yaxis)
        panel.set_title(name, pad=4)
        panel.set_xlabel(across)
    axes[0].set_ylabel("time (s)")
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.5 / height), w_pad=1.2)
    style.heading(figure, title, details, legend)
    return figure


def transfers_table(records: list[Record]) -> Table:
    """Parts and total, us, with the factor over the GPU of [Shi] and the error."""
    columns = [("options", True), ("intervals", True), ("", False), ("memory", False)]
    columns += [(f"{words} (\u00b5s)", True) for words in _PARTS.values()]
    columns += [("times as fast as its GPU", True), ("error", True)]
    rows, shown = transfer_rows(records), []
    printed = {(row.options, row.mesh): row.parts["total"] for row in rows if row.source == "gpu"}
    for row in rows:
        parts = [html_page.format_number(row.parts[part]) if part in row.parts else "" for part in _PARTS]
        thesis = printed.get((row.options, row.mesh))
        gain = (
            html_page.format_number(thesis / row.parts["total"])
            if thesis and row.source in ("seed", "pide")
            else ""
        )
        error = "" if row.error is None else html_page.format_number(row.error)
        place = [html_page.format_grouped(row.options), html_page.format_grouped(row.mesh)]
        shown.append([*place, _CURVES[row.source][0], row.memory, *parts, gain, error])
    return Table(columns, shown)


def sections(machine: Machine, records: list[Record]) -> list[Section]:
    """One section per backend."""
    found = []
    for backend in dict.fromkeys(record.facts["backend"] for record in records):
        own = [record for record in records if record.facts["backend"] == backend]
        title = f"Tables 5.7 and 5.8, {BACKENDS.get(backend, backend)}"
        picture = Picture(
            f"options-transfers_{backend}_{machine.slug}",
            lambda title=title, own=own: transfers_figure(title, machine, own),
            f"{title}: time against the mesh of one option and against the number of options",
        )
        notes = [
            "Parts and total are medians of their own: they need not add up. Times of [Shi] (the dissertation "
            "that README.md cites) are those of a Quadro 6000; its first copy of a single option holds the start of CUDA. Its "
            "scheme takes as many steps as intervals, ours a fourth of them, on two grids. Errors: the largest of "
            "five known prices over the strike."
        ]
        command = "drogue-perf table transfers --app options --out FILE.jsonl"
        found.append(Section(title, command, own, [picture], [transfers_table(own)], notes))
    return found
