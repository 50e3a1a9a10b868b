"""Sections on transfers: times of copies and computation, in [Shi] and on this machine."""

from dataclasses import dataclass

import numpy as np

from .. import html_page, style
from ..style import plt
from .perf_record import BACKENDS, Machine, Record
from .section import Picture, Section, Table

_THESIS = "[Shi]"
_PARTS = {"h2d": "host to device", "compute": "compute", "d2h": "device to host"}
_NAMES = _PARTS | {"total": "total"}
_COLOURS = dict(zip(_PARTS, (style.PALETTE[5], style.PALETTE[0], style.PALETTE[4])))
_OURS, _ITS_SCHEME = "ours", "its scheme"
_CORE_COLOURS = {_THESIS: style.MUTED, _ITS_SCHEME: style.PALETTE[1], _OURS: style.PALETTE[0]}


@dataclass(frozen=True)
class _Kind:
    """Labels of the transfers of a mini-app; `prefix` makes the file names of pictures unique."""

    app: str
    prefix: str
    mesh: str
    source: str
    panels: str
    table: str
    note: str
    unit: str
    compared: bool  # whether a step of [Shi] does the same work


_KINDS = {
    "gas-transfers": _Kind(
        app="gas",
        prefix="transfers",
        mesh="cells",
        source="scheme and memory",
        panels="[Shi], its scheme and ours with pageable and with pinned memory",
        table="5.5",
        note="Its scheme copies the state to the device and the fluxes back in each of three stages; ours keeps the state "
        "on the device for 20 steps between two copies.",
        unit="\u00b5s per step",
        compared=True,
    ),
    "springs-transfers": _Kind(
        app="springs", prefix="springs-transfers", mesh="vertices", source="between two copies",
        panels="[Shi], and of each number of steps between two copies", table="5.6",
        note="Its steps took a number of substeps that is not recorded, so that no ratio to it means anything.",
        unit="\u00b5s from host to host", compared=False,
    ),
    "parachute-transfers": _Kind(
        app="parachute", prefix="parachute-transfers", mesh="cells", source="between two copies",
        panels="each number of steps between two copies", table="", note="", unit="\u00b5s per step",
        compared=False,
    ),
}
_PANELS_IN_A_ROW = 3


def _source(record: Record) -> str:
    """Scheme and kind of host memory, or number of steps between two copies, and memory if it is not pageable."""
    steps, memory = record.facts.get("substeps"), record.facts.get("memory", "pageable")
    if steps is None:
        return f"{_OURS}, {memory}" if record.facts.get("method") == "ours" else memory
    words = f"{steps} step" + ("s" if steps > 1 else "")
    return words if memory == "pageable" else f"{words}, {memory}"


def sources(records: list[Record]) -> list[str]:
    """Sources in the order of panels: [Shi], its scheme before ours, pageable before pinned memory, few steps before many."""

    def place(record: Record) -> tuple:
        facts = record.facts
        return facts.get("method", "") == "ours", facts.get("memory", ""), facts.get("substeps", 0)

    return [_THESIS, *dict.fromkeys(_source(record) for record in sorted(records, key=place))]


def times(records: list[Record]) -> dict[tuple[int, str], dict[str, float]]:
    """Parts and total of the time per step and, where known, computation on one core (`cpu`), us, by (mesh, source)."""
    found = {}
    for record in records:
        facts = record.facts
        parts = {part: 1e6 * facts[f"{part}_s"] for part in _PARTS}
        core = {"cpu": 1e6 * facts["cpu_s"]} if "cpu_s" in facts else {}
        found[facts["cells"], _source(record)] = parts | {"total": 1e6 * record.median} | core
        thesis = facts.get("thesis") or {}
        if all(isinstance(thesis.get(f"{part}_us"), int | float) for part in _NAMES):
            known = [part for part in (*_NAMES, "cpu") if isinstance(thesis.get(f"{part}_us"), int | float)]
            found[facts["cells"], _THESIS] = {part: float(thesis[f"{part}_us"]) for part in known}
    order = {name: index for index, name in enumerate(sources(records))}
    return dict(sorted(found.items(), key=lambda item: (item[0][0], order[item[0][1]])))


def core_times(found: dict[tuple[int, str], dict[str, float]]) -> dict[str, dict[int, float]]:
    """Computation on one core, us, by mesh: of [Shi], of its scheme and of ours."""
    curves: dict[str, dict[int, float]] = {}
    for (cells, source), parts in found.items():
        if "cpu" in parts:
            name = source if source == _THESIS else _OURS if source.startswith(_OURS) else _ITS_SCHEME
            curves.setdefault(name, {})[cells] = parts["cpu"]
    return curves


def _draw_core(panel, meshes: list[int], curves: dict[str, dict[int, float]]):
    """Computation on one core, the right half of figure 5.15 of [Shi], on a logarithmic axis."""
    for name, curve in curves.items():
        colour = _CORE_COLOURS[name]
        place = [meshes.index(cells) for cells in curve]
        panel.plot(place, list(curve.values()), "-o", color=colour, markersize=3.6, linewidth=1.2)
        end = (place[-1], curve[meshes[place[-1]]])
        panel.annotate(name, end, (0, 5), textcoords="offset points", ha="right", fontsize=7, color=colour)
    panel.set_yscale("log")
    panel.margins(y=0.15)
    style.set_log_ticks(panel.yaxis)
    panel.set_title("computation on one core", pad=8)


def transfers_figure(title: str, machine: Machine, records: list[Record]):
    """Stacked bar charts by mesh, one panel per source; those of a row on a common scale if the sources are comparable."""
    found, kind = times(records), _KINDS[records[0].kind]
    panels = [name for name in sources(records) if any(source == name for _, source in found)]
    meshes = sorted({cells for cells, _ in found})
    cores = core_times(found) if kind.compared else {}
    count = len(panels) + bool(cores)
    columns, rows_of_panels = min(count, _PANELS_IN_A_ROW), -(-count // _PANELS_IN_A_ROW)
    height, details = 0.5 + 2.8 * rows_of_panels, f"total above each bar; {'rows' if kind.compared else 'panels'} have scales of their own; {machine.name}"
    figure, axes = plt.subplots(rows_of_panels, columns, squeeze=False)
    if kind.compared:
        for index, panel in enumerate(axes.flat[: len(panels)]):
            if index % columns:
                panel.sharey(axes.flat[index - index % columns])
                panel.tick_params(labelleft=False)
    legend = [("\u25a0", words, _COLOURS[part]) for part, words in _PARTS.items()]
    chart_width = 0.7 + (0.5 + 0.33 * max(len(meshes), 3)) * columns
    width = max(chart_width, style.heading_width(figure, title, legend), style.subtitle_width(figure, details))
    figure.set_size_inches(width, height)
    for empty in axes.flat[count:]:
        empty.set_visible(False)
    for panel, source in zip(axes.flat, panels):
        place = [index for index, cells in enumerate(meshes) if (cells, source) in found]
        rows = [found[meshes[index], source] for index in place]
        base = np.zeros(len(rows))
        for part, colour in _COLOURS.items():
            values = np.array([row[part] for row in rows])
            panel.bar(place, values, 0.72, bottom=base, color=colour)
            base += values
        for index, top, row in zip(place, base, rows):
            panel.annotate(style.format_number(row["total"]), (index, top), (0, 2), textcoords="offset points", ha="center",
                           fontsize=6.5, color=style.MUTED)
        panel.set_title(source, pad=8)
    if cores:
        _draw_core(axes.flat[len(panels)], meshes, cores)
    for panel in axes.flat[:count]:
        panel.set_xticks(range(len(meshes)), [str(cells) for cells in meshes], rotation=60)
        panel.set_xlim(-0.6, len(meshes) - 0.4)
        panel.grid(axis="x", visible=False)
        panel.set_xlabel(kind.mesh)
    for first in axes[:, 0]:
        first.set_ylabel(kind.unit)
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.5 / height), w_pad=1.2)
    style.heading(figure, title, details, legend)
    return figure


def transfers_table(records: list[Record]) -> Table:
    """Parts and total by mesh and source, us."""
    found, kind = times(records), _KINDS[records[0].kind]
    columns = [(kind.mesh, True), (kind.source, False)] + [(f"{words} (\u00b5s)", True) for words in _NAMES.values()]
    on_core = any("cpu" in parts for parts in found.values())
    columns += [("one core (\u00b5s)", True)] if on_core else []
    columns += [("times as fast as [Shi]", True)] if kind.compared else []
    rows = []
    for (cells, source), parts in found.items():
        row = [html_page.format_grouped(cells), source, *(html_page.format_number(parts[part]) for part in _NAMES)]
        if on_core:
            row.append(html_page.format_number(parts["cpu"]) if "cpu" in parts else "")
        thesis = found.get((cells, _THESIS))
        if kind.compared:
            is_ratio = thesis and source != _THESIS
            row.append(html_page.format_number(thesis["total"] / parts["total"]) if is_ratio else "")
        rows.append(row)
    return Table(columns, rows)


def sections(machine: Machine, records: list[Record]) -> list[Section]:
    """One section per backend; `records` are of one kind."""
    found = []
    for backend in dict.fromkeys(record.facts["backend"] for record in records):
        own = [record for record in records if record.facts["backend"] == backend]
        kind = _KINDS[own[0].kind]
        title = f"Transfers of a step, {BACKENDS.get(backend, backend)}"
        picture = Picture(
            f"{kind.prefix}_{backend}_{machine.slug}",
            lambda title=title, own=own: transfers_figure(title, machine, own),
            f"{title}: copies and computation of {kind.panels}",
        )
        notes = ["Parts and total are medians of their own: they need not add up."]
        if any(source == _THESIS for _, source in times(own)):
            words = f"Times of [Shi] (the dissertation that README.md cites) are those of its Table {kind.table}, on its own machine."
            notes.append(" ".join(filter(None, [words, kind.note])))
        command = f"drogue-perf table transfers --app {kind.app} --out FILE.jsonl"
        found.append(Section(title, command, own, [picture], [transfers_table(own)], notes))
    return found
