"""Reads the records of a folder: keeps those that count, and says why the others do not."""

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from .failure import IO_ERROR, Failure
from .perf_record import KINDS, Machine, Record, parse
from .run_directory import RECORDS


@dataclass
class Evidence:
    """Records of a folder: those that count, and why the others do not."""

    folder: Path
    records: list[Record] = field(default_factory=list)
    unsolved: list[Record] = field(default_factory=list)
    unchecked: list[Record] = field(default_factory=list)
    unknown: Counter = field(default_factory=Counter)
    superseded: list[Record] = field(default_factory=list)

    @property
    def apps(self) -> list[str]:
        """Those that records tell of."""
        every = self.records + self.unsolved + self.unchecked
        return sorted({record.app for record in every})

    def of_app(self, app: str) -> "Evidence":
        """What belongs on the page of a mini-app."""

        def own(records: list[Record]) -> list[Record]:
            return [record for record in records if record.app == app]

        return Evidence(
            self.folder, own(self.records), own(self.unsolved), own(self.unchecked), self.unknown, own(self.superseded)
        )

    @property
    def machines(self) -> list[Machine]:
        return list(dict.fromkeys(record.machine for record in self.records + self.unsolved))

    def unsolved_of(self, machine: Machine) -> list[Record]:
        return [record for record in self.unsolved if record.machine == machine]

    def of(self, machine: Machine, kind: str) -> list[Record]:
        return [record for record in self.records if record.machine == machine and record.kind == kind]


def _newest(records: list[Record]) -> list[Record]:
    """The latest record of every case on every machine, in the order of the first ones."""
    kept: dict[tuple[Machine, str], Record] = {}
    for record in records:
        key = record.machine, record.case
        if key not in kept or record.run >= kept[key].run:
            kept[key] = record
    return list(kept.values())


def read(folder: Path) -> Evidence | None:
    """The records of all *.jsonl of a folder, None where there are none; exit code 6 where a line cannot be used."""
    files = sorted(folder.glob(RECORDS))
    if not files:
        return None
    evidence, known = Evidence(folder), []
    for file in files:
        try:
            lines = file.read_text(encoding="utf-8").split("\n")
        except (OSError, UnicodeDecodeError) as error:
            raise Failure(IO_ERROR, f"{file} cannot be read: {error}.") from None
        for number, line in enumerate(lines, 1):
            if not line.strip():
                continue
            record = parse(line, f"{file}:{number}")
            if record.kind in KINDS:
                known.append(record)
            else:
                evidence.unknown[record.kind] += 1
    if not known and not evidence.unknown:
        raise Failure(IO_ERROR, f"{folder} holds no record: its {RECORDS} are empty.")
    newest = _newest(known)
    kept = {id(record) for record in newest}
    evidence.superseded = [record for record in known if id(record) not in kept]
    for record in newest:
        if not record.is_solved:
            evidence.unsolved.append(record)
        elif record.check == "failed":
            evidence.unchecked.append(record)
        else:
            evidence.records.append(record)
    return evidence
