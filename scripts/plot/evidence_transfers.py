"""Sections of the transfers: the dissertation's times of copies and computation beside those of this machine."""

import numpy as np

from . import page, style
from .evidence_section import Picture, Section, Table
from .perf_record import BACKENDS, Machine, Record
from .style import plt

_COMMAND = "drogue-perf table transfers --app gas --out FILE.jsonl"
_THESIS = "dissertation"
_SOURCES = (_THESIS, "pageable", "pinned")
_PARTS = {"h2d": "host to device", "compute": "compute", "d2h": "device to host"}
_NAMES = _PARTS | {"total": "total"}
_COLOURS = dict(zip(_PARTS, (style.PALETTE[5], style.PALETTE[0], style.PALETTE[4])))


def times(records: list[Record]) -> dict[tuple[int, str], dict[str, float]]:
    """Microseconds of a step, its parts and total, by (cells, dissertation | pageable | pinned), by rising mesh."""
    found = {}
    for record in records:
        facts = record.facts
        parts = {part: 1e6 * facts[f"{part}_s"] for part in _PARTS}
        found[facts["cells"], facts["memory"]] = parts | {"total": 1e6 * record.median}
        thesis = facts.get("thesis") or {}
        if all(isinstance(thesis.get(f"{part}_us"), int | float) for part in _NAMES):
            found[facts["cells"], _THESIS] = {part: float(thesis[f"{part}_us"]) for part in _NAMES}
    order = {name: index for index, name in enumerate(_SOURCES)}
    return dict(sorted(found.items(), key=lambda item: (item[0][0], order.get(item[0][1], len(order)))))


def transfers_figure(title: str, machine: Machine, found: dict[tuple[int, str], dict[str, float]]):
    """Stacked bars by mesh, one panel for the dissertation and each kind of host memory, on one scale."""
    sources = [name for name in _SOURCES if any(source == name for _, source in found)]
    meshes = sorted({cells for cells, _ in found})
    height, details = 3.3, f"total above each bar; {machine.name}"
    figure, axes = plt.subplots(1, len(sources), sharey=True, squeeze=False)
    key = [("\u25a0", words, _COLOURS[part]) for part, words in _PARTS.items()]
    bars = 0.7 + (0.5 + 0.33 * len(meshes)) * len(sources)
    width = max(bars, style.titled_key_width(figure, title, key), style.details_width(figure, details))
    figure.set_size_inches(width, height)
    for panel, source in zip(axes[0], sources):
        place = [index for index, cells in enumerate(meshes) if (cells, source) in found]
        rows = [found[meshes[index], source] for index in place]
        base = np.zeros(len(rows))
        for part, colour in _COLOURS.items():
            values = np.array([row[part] for row in rows])
            panel.bar(place, values, 0.72, bottom=base, color=colour)
            base += values
        for index, top, row in zip(place, base, rows):
            panel.annotate(
                style.number(row["total"]), (index, top), (0, 2), textcoords="offset points", ha="center", fontsize=6.5,
                color=style.MUTED,
            )  # fmt: skip
        panel.set_title(source, pad=8)
        panel.set_xticks(range(len(meshes)), [str(cells) for cells in meshes], rotation=60)
        panel.set_xlim(-0.6, len(meshes) - 0.4)
        panel.grid(axis="x", visible=False)
        panel.set_xlabel("cells")
    axes[0, 0].set_ylabel("\u00b5s a step")
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.5 / height), w_pad=1.2)
    style.heading(figure, title, details, key)
    return figure


def transfers_table(found: dict[tuple[int, str], dict[str, float]]) -> Table:
    columns = [("cells", True), ("memory", False)] + [(f"{words} (\u00b5s)", True) for words in _NAMES.values()]
    columns.append(("times as fast as the dissertation", True))
    rows = []
    for (cells, source), parts in found.items():
        thesis = found.get((cells, _THESIS))
        factor = "" if source == _THESIS or not thesis else page.number(thesis["total"] / parts["total"])
        rows.append([page.grouped(cells), source, *(page.number(parts[part]) for part in _NAMES), factor])
    return Table(columns, rows)


def sections(machine: Machine, records: list[Record]) -> list[Section]:
    """One a backend."""
    found = []
    for backend in dict.fromkeys(record.facts["backend"] for record in records):
        own = [record for record in records if record.facts["backend"] == backend]
        title, data = f"Transfers of a step, {BACKENDS.get(backend, backend)}", times(own)
        picture = Picture(
            f"transfers_{backend}_{machine.slug}",
            lambda title=title, data=data: transfers_figure(title, machine, data),
            f"{title}: copies and computation of the dissertation, with pageable and with pinned memory",
        )
        has_thesis = any(source == _THESIS for _, source in data)
        notes = ["Parts and total are medians of their own: they need not add up."]
        notes += ["The dissertation's times are those of its Table 5.5, on its own machine."] if has_thesis else []
        found.append(Section(title, _COMMAND, own, [picture], [transfers_table(data)], notes))
    return found
