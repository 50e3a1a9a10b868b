"""The evidence page of the gas mini-app: machines, their sections, and what was left out."""

from collections.abc import Iterator
from pathlib import Path

from PIL import Image

from . import (
    evidence_blocks,
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

PAGE = "gas.html"


def _sections(evidence: Evidence, machine: Machine) -> list[Section]:
    """Those that records exist for: what a machine did not measure has no place."""
    solved, steps = evidence.of(machine, "gas-solution"), evidence.of(machine, "gas-step")
    unsolved = [record for record in evidence.unsolved if record.machine == machine]
    found = evidence_solution_section.sections(machine, solved, unsolved)
    found += evidence_steps.sections(steps) if steps else []
    found += evidence_roofline.sections(machine, evidence.of(machine, "ceiling"), steps)
    found += evidence_transfers.sections(machine, evidence.of(machine, "gas-transfers"))
    return found + evidence_blocks.sections(machine, evidence.of(machine, "gas-block"))


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
        count = _counted(evidence.superseded, "record is", "records are")
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
    """Draws the pictures, writes the page, and yields the name of each file once it is written.

    The page holds PNG; in another form the pictures are written beside them.
    """
    machines = [(machine, _sections(evidence, machine)) for machine in evidence.machines]
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
        out / PAGE, "evidence_page.html.j2", filters, machines=machines, notes=notes(evidence),
        count=len(evidence.records),
    )  # fmt: skip
