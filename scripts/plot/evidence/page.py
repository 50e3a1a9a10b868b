"""Page of the benchmark records of a mini-app: a group of sections per machine, and notes on omitted records."""

from collections.abc import Iterator
from pathlib import Path

from PIL import Image

from .. import html_page, style
from ..flow import solver_tables
from ..options import transfers as options_transfers
from . import (
    abstraction, block_sizes, bounds, ladders, machine_table, occupancy, roofline, scaling, steps, transfers,
    work_precision_section,
)
from .perf_record import Machine, Record
from .records import Evidence
from .section import Cell, Section


def _gas_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    """Sections for which the machine has records."""
    solved, step_records = evidence.select(machine, "gas-solution"), evidence.select(machine, "gas-step")
    found = work_precision_section.sections(machine, solved, evidence.failed_runs_on(machine))
    found += steps.sections(step_records)
    found += roofline.sections(machine, evidence.select(machine, "ceiling"), step_records)
    found += transfers.sections(machine, evidence.select(machine, "gas-transfers"))
    return found + block_sizes.sections(machine, evidence.select(machine, "gas-block"))


def _springs_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    solved = evidence.select(machine, "springs-solution")
    found = work_precision_section.sections(machine, solved, evidence.failed_runs_on(machine))
    found += steps.sections(evidence.select(machine, "springs-step"))
    found += bounds.sections(machine, evidence.ceilings, evidence.select(machine, "springs-step"))
    found += steps.sections(evidence.select(machine, "springs-contact"))
    return found + transfers.sections(machine, evidence.select(machine, "springs-transfers"))


def _options_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    solved = evidence.select(machine, "options-solution")
    found = work_precision_section.sections(machine, solved, evidence.failed_runs_on(machine))
    for kind in ("options", "options-surface", "options-cos", "tridiagonal"):
        found += steps.sections(evidence.select(machine, kind))
    for kind in ("options", "tridiagonal"):
        found += bounds.sections(machine, evidence.ceilings, evidence.select(machine, kind))
    found += options_transfers.sections(machine, evidence.select(machine, "options-transfers"))
    return found + block_sizes.sections(machine, evidence.select(machine, "options-block"))


def _flow_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    failed = evidence.failed_runs_on(machine)
    found = []
    for kind in ("flow-solution", "parachute-solution"):
        failed_of_kind = [record for record in failed if record.kind == kind]
        found += work_precision_section.sections(machine, evidence.select(machine, kind), failed_of_kind)
    ceilings = [record for record in evidence.ceilings if record.machine == machine]
    found += steps.sections(evidence.select(machine, "flow-step"), roofline.bandwidths(ceilings))
    found += bounds.sections(machine, ceilings, evidence.select(machine, "flow-step"))
    found += steps.sections(evidence.select(machine, "parachute-flight"))
    found += transfers.sections(machine, evidence.select(machine, "parachute-transfers"))
    found += solver_tables.pressure_sections(evidence.select(machine, "flow-pressure"))
    found += solver_tables.memory_sections(evidence.select(machine, "flow-memory"))
    for kind in ("flow-block", "parachute-block"):
        found += block_sizes.sections(machine, evidence.select(machine, kind))
    return found


def _common_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    """Sections that any mini-app may have."""
    found = scaling.sections(evidence.select(machine, "scaling"))
    return found + abstraction.sections(evidence.select(machine, "abstraction"))


def _ladder_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    return ladders.sections(machine, evidence.select(machine, "ladder"))


def _machine_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    found = machine_table.sections(evidence.select(machine, "machine"))
    return found + occupancy.sections(evidence.select(machine, "occupancy"))


_SECTIONS = {
    "gas": _gas_sections, "springs": _springs_sections, "options": _options_sections, "flow": _flow_sections,
    "ladder": _ladder_sections, "machine": _machine_sections,
}


# Kinds that drogue-perf prints as a table of its own.
_WITHOUT_SECTION = {"kernels": "of a profile, whose shares of kernels drogue-perf table kernels prints"}


def _counted(count: int, words: str, plural: str) -> str:
    return f"{count} {words if count == 1 else plural}"


def _cases(records: list[Record]) -> str:
    """Case, machine and error of each record."""
    errors = [f"error {record.error:.3g}" if record.error is not None else "no error known" for record in records]
    return "; ".join(f"{line.case} on {line.machine.name} ({error})" for line, error in zip(records, errors))


def _places(records: list[Record]) -> str:
    return "; ".join(f"{record.case} on {record.machine.name}" for record in records)


def notes(evidence: Evidence) -> list[str]:
    """Sentences about the records that the page omits, with the reason."""
    found = []
    are = ("record is", "records are")
    for records, words, why in (
            (evidence.failed_checks, are, f"left out for a failed check: {_cases(evidence.failed_checks)}"),
            (evidence.untimed, are, f"left out for having no samples: {_places(evidence.untimed)}"),
            (evidence.superseded, are, "left out, because a later one of the same case and machine exists"),
            (evidence.cold, ("record", "records"), "with cold caches: no figure compares them with others, whose caches are warm"),
            (evidence.outdated, ("record has", "records have"),
             f"no bounds: their counts of work differ from the latest ones of the same case: {_places(evidence.outdated)}")):
        if records:
            found.append(f"{_counted(len(records), *words)} {why}.")
    for kind, number in sorted(evidence.unknown_kinds.items()):
        count = _counted(number, "record", "records")
        words = _WITHOUT_SECTION.get(kind, f"of the kind {kind}, which this page does not know")
        found.append(f"Not shown: {count} {words}.")
    return found


def _cell(value: Cell | str) -> Cell:
    return value if isinstance(value, Cell) else Cell(value)


def _width(file: Path, dpi: int) -> int:
    """Width of an image on the page in CSS pixels, 110 per inch at any resolution."""
    with Image.open(file) as image:
        return round(110 * image.width / dpi)


def write(evidence: Evidence, out: Path, form: str, dpi: int) -> Iterator[Path]:
    """Writes a page per mini-app and its pictures; yields the path of each written file.

    The pages embed PNG. If `form` is another format, the pictures are written in that format too. Raises Failure
    (IO_ERROR) if a file cannot be written.
    """
    for app in evidence.apps or ["gas"]:
        yield from _write_app(app, evidence.for_app(app), out, form, dpi)


def machine_sections(app: str, evidence: Evidence) -> list[tuple[Machine, list[Section]]]:
    """Sections of a mini-app, whose records `evidence` holds, by machine."""
    return [(machine, _SECTIONS[app](evidence, machine) + _common_sections(evidence, machine)) for machine in evidence.machines]


class Pictures:
    """Pictures of the sections of a page, saved as PNG in a folder, and the filters of templates that show them."""

    def __init__(self, folder: Path, dpi: int):
        self._folder, self._dpi = folder, dpi
        self._files: dict[int, Path] = {}
        self._names: dict[str, int] = {}

    def save(self, picture, more: str = "") -> Iterator[Path]:
        """Draws a picture, also in the format `more`; yields the files."""
        # Two machines may have the same GPU name.
        self._names[picture.name] = self._names.get(picture.name, 0) + 1
        count = self._names[picture.name]
        name = picture.name if count == 1 else f"{picture.name}-{count}"
        figure = picture.draw()
        self._files[id(picture)] = style.save_figure(figure, self._folder / f"{name}.png", self._dpi)
        yield self._files[id(picture)]
        if more:
            yield style.save_figure(figure, self._folder / f"{name}.{more}", self._dpi)

    @property
    def filters(self) -> dict:
        return {
            "cell": _cell,
            "file_of": lambda picture: self._files[id(picture)],
            "width": lambda file: _width(file, self._dpi),
        }


def _write_app(app: str, evidence: Evidence, out: Path, form: str, dpi: int) -> Iterator[Path]:
    machines, pictures = machine_sections(app, evidence), Pictures(out, dpi)
    for _, found in machines:
        for section in found:
            for picture in section.pictures:
                yield from pictures.save(picture, "" if form == "png" else form)
    yield html_page.write(
        out / f"{app}.html", "evidence/page.html.j2", pictures.filters, app=app, machines=machines, notes=notes(evidence),
        count=len(evidence.records), timed=app != "machine",
    )
