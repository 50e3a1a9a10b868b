"""The evidence page of a mini-app: machines, their sections, and what was left out."""

from collections.abc import Iterator
from pathlib import Path

from PIL import Image

from . import (
    evidence_blocks,
    evidence_options,
    evidence_roofline,
    evidence_solution_section,
    evidence_steps,
    evidence_transfers,
    page,
    style,
)
from .evidence_records import Evidence
from .evidence_section import Cell, Section
from .perf_record import Machine, Record


def _gas_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    """Those that records exist for: what a machine did not measure has no place."""
    solved, steps = evidence.of(machine, "gas-solution"), evidence.of(machine, "gas-step")
    found = evidence_solution_section.sections(machine, solved, evidence.unsolved_of(machine))
    found += evidence_steps.sections(steps)
    found += evidence_roofline.sections(machine, evidence.of(machine, "ceiling"), steps)
    found += evidence_transfers.sections(machine, evidence.of(machine, "gas-transfers"))
    return found + evidence_blocks.sections(machine, evidence.of(machine, "gas-block"))


def _springs_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    solved = evidence.of(machine, "springs-solution")
    found = evidence_solution_section.sections(machine, solved, evidence.unsolved_of(machine))
    found += evidence_steps.sections(evidence.of(machine, "springs-step"))
    found += evidence_steps.sections(evidence.of(machine, "springs-contact"))
    return found + evidence_transfers.sections(machine, evidence.of(machine, "springs-transfers"))


def _options_sections(evidence: Evidence, machine: Machine) -> list[Section]:
    solved = evidence.of(machine, "options-solution")
    found = evidence_solution_section.sections(machine, solved, evidence.unsolved_of(machine))
    found += evidence_steps.sections(evidence.of(machine, "options"))
    found += evidence_steps.sections(evidence.of(machine, "tridiagonal"))
    return found + evidence_options.sections(machine, evidence.of(machine, "options-transfers"))


_SECTIONS = {"gas": _gas_sections, "springs": _springs_sections, "options": _options_sections}


def _counted(count: int, words: str, plural: str) -> str:
    return f"{count} {words if count == 1 else plural}"


def _cases(records: list[Record]) -> str:
    """Case, machine and error of each; an error that was no number is not kept."""
    errors = [f"error {record.error:.3g}" if record.error is not None else "no error known" for record in records]
    return "; ".join(f"{line.case} on {line.machine.name} ({error})" for line, error in zip(records, errors))


def notes(evidence: Evidence) -> list[str]:
    """What does not stand on the page, and why."""
    found = []
    if evidence.unchecked:
        count = _counted(len(evidence.unchecked), "record is", "records are")
        found.append(f"{count} left out for a failed check: {_cases(evidence.unchecked)}.")
    if evidence.superseded:
        count = _counted(len(evidence.superseded), "record is", "records are")
        found.append(f"{count} left out, because a later one of the same case and machine exists.")
    if evidence.unknown:
        count = _counted(sum(evidence.unknown.values()), "record is", "records are")
        found.append(f"{count} ignored, of a kind that this page does not know: {', '.join(sorted(evidence.unknown))}.")
    return found


def _cell(value: Cell | str) -> Cell:
    return value if isinstance(value, Cell) else Cell(value)


def _width(file: Path, dpi: int) -> int:
    """Pixels of the page that a picture takes: an inch of it is 110 of them, whatever its resolution."""
    with Image.open(file) as image:
        return round(110 * image.width / dpi)


def write(evidence: Evidence, out: Path, form: str, dpi: int) -> Iterator[Path]:
    """Draws the pictures, writes a page for each mini-app, and yields the name of each file once it is written.

    The pages hold PNG; in another form the pictures are written beside them.
    """
    for app in evidence.apps or ["gas"]:
        yield from _write_app(app, evidence.of_app(app), out, form, dpi)


def _write_app(app: str, evidence: Evidence, out: Path, form: str, dpi: int) -> Iterator[Path]:
    machines = [(machine, _SECTIONS[app](evidence, machine)) for machine in evidence.machines]
    files: dict[int, Path] = {}
    names: dict[str, int] = {}
    for _, found in machines:
        for section in found:
            for picture in section.pictures:
                # Two machines may share a GPU's name.
                names[picture.name] = names.get(picture.name, 0) + 1
                name = picture.name if names[picture.name] == 1 else f"{picture.name}-{names[picture.name]}"
                figure = picture.draw()
                files[id(picture)] = style.save(figure, out / f"{name}.png", dpi)
                yield files[id(picture)]
                if form != "png":
                    yield style.save(figure, out / f"{name}.{form}", dpi)
    filters = {"cell": _cell, "file_of": lambda picture: files[id(picture)], "width": lambda file: _width(file, dpi)}
    yield page.write(
        out / f"{app}.html", "evidence_page.html.j2", filters, app=app, machines=machines, notes=notes(evidence),
        count=len(evidence.records),
    )  # fmt: skip
