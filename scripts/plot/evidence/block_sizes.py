"""Sections on block sizes: time against mesh, one curve per block size, one panel per form of the kernel."""

from .. import html_page, style
from ..style import plt
from .perf_record import BACKENDS, Machine, Record
from .section import Cell, Picture, Section, Table

_COMMAND = "drogue-perf table block-size --app {app} --out FILE.jsonl"
_FORMS = {
    "seed": "the flux kernel of [Shi]",
    "step": "the fused step",
    "momentum": "a step of flow by the block of its momentum stage",
    "cos": "puts by cosine series",
    "contact": "the flight of a canopy by the block of contact",
}
_Times = dict[int, dict[int, float]]  # s, by block size and number of cells


def times(records: list[Record]) -> _Times:
    """Median times, s, by block size and number of cells, both increasing."""
    found: _Times = {}
    for record in sorted(records, key=lambda record: (record.facts["block"], record.facts["cells"])):
        found.setdefault(record.facts["block"], {})[record.facts["cells"]] = record.median
    return found


def _forms(records: list[Record]) -> dict[str, _Times]:
    """Times by form of the kernel, those of _FORMS first."""
    names = list(dict.fromkeys(record.facts["form"] for record in records))
    ordered = [name for name in _FORMS if name in names] + [name for name in names if name not in _FORMS]
    return {name: times([record for record in records if record.facts["form"] == name]) for name in ordered}


def blocks_figure(title: str, machine: Machine, forms: dict[str, _Times], unit: str):
    """Figure of time against mesh, one panel per form of the kernel and one curve per block size."""
    panel, left, gap, bottom, top = 3.0, 0.75, 1.05, 0.62, 0.72
    details = f"time against mesh, a curve a block size; {machine.name}"
    blocks = sorted({block for data in forms.values() for block in data})
    panel_height = max(2.5, style.LABEL_STEP * len(blocks))
    height = bottom + panel_height + top
    figure, axes = plt.subplots(1, len(forms), squeeze=False)
    width = max(left + (panel + gap) * len(forms), style.subtitle_width(figure, details))
    panel = (width - left) / len(forms) - gap
    figure.set_size_inches(width, height)
    figure.subplots_adjust(
        left=left / width, right=1 - gap / width, bottom=bottom / height, top=1 - top / height,
        wspace=gap / panel,
    )
    for axis, (form, data) in zip(axes[0], forms.items()):
        ends = []
        for block, by_mesh in data.items():
            index = blocks.index(block)
            colour, marker = style.PALETTE[index % len(style.PALETTE)], "osD^vP*X"[index % 8]
            meshes, values = list(by_mesh), [1e6 * value for value in by_mesh.values()]
            axis.plot(
                meshes, values, "-" + marker, color=colour, markersize=3.6, markerfacecolor="white",
                linewidth=1.2,
            )
            ends.append(((meshes[-1], values[-1]), f"block {block}", colour))
        axis.set_title(_FORMS.get(form, form), pad=5)
        axis.set_xlabel("cells")
        meshes = sorted({cells for by_mesh in data.values() for cells in by_mesh})
        if meshes[-1] > 20 * meshes[0]:
            axis.set_xscale("log")
            axis.set_yscale("log")
            style.set_log_ticks(axis.yaxis)
        else:
            axis.set_ylim(bottom=0)
        style.label_curves(axis, ends)
    axes[0, 0].set_ylabel(f"\u00b5s per {unit}")
    style.heading(figure, title, details)
    return figure


def _table(form: str, data: _Times) -> Table:
    blocks = sorted(data)
    meshes = sorted({cells for by_mesh in data.values() for cells in by_mesh})
    rows = []
    for cells in meshes:
        values = {block: data[block][cells] for block in blocks if cells in data[block]}
        fastest = min(values, key=values.get)
        row = [html_page.format_grouped(cells)]
        for block in blocks:
            text = html_page.format_number(1e6 * values[block]) if block in values else ""
            row.append(Cell(text, "good" if block == fastest else ""))
        rows.append(row)
    columns = [("cells", True)] + [(f"block {block} (\u00b5s)", True) for block in blocks]
    name = _FORMS.get(form, form)
    return Table(columns, rows, f"{name[:1].upper()}{name[1:]}; the fastest block of a mesh is marked")


def sections(machine: Machine, records: list[Record]) -> list[Section]:
    """One section per mini-app and backend."""
    found = []
    for app in dict.fromkeys(record.kind.partition("-")[0] for record in records):
        found += _sections_of(app, machine, [record for record in records if record.kind.startswith(app + "-")])
    return found


def _sections_of(app: str, machine: Machine, records: list[Record]) -> list[Section]:
    found = []
    for backend in dict.fromkeys(record.facts["backend"] for record in records):
        own = [record for record in records if record.facts["backend"] == backend]
        title, forms = f"Block size, {BACKENDS.get(backend, backend)}", _forms(own)
        unit = own[0].unit.removeprefix("s per ")
        picture = Picture(
            f"blocks_{'' if app == 'gas' else app + '_'}{backend}_{machine.slug}",
            lambda title=title, forms=forms, unit=unit: blocks_figure(title, machine, forms, unit),
            f"{title}: time against mesh, one curve a block size, one panel a form of the kernel",
        )
        found.append(
            Section(title, _COMMAND.format(app=app), own, [picture], [_table(form, data) for form, data in forms.items()])
        )
    return found
