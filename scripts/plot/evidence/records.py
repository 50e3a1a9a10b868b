"""Reader of the benchmark records of a folder, which sorts out failed and superseded ones."""

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from ..failure import INVALID, Failure
from ..run_directory import RECORDS
from .counts import without_outdated_counts
from .perf_record import KINDS, Machine, Record, read_file


@dataclass
class Evidence:
    """Records of a folder: valid ones, failed runs, failed checks, ones without times, and superseded ones."""

    folder: Path
    records: list[Record] = field(default_factory=list)
    failed_runs: list[Record] = field(default_factory=list)
    failed_checks: list[Record] = field(default_factory=list)
    unknown_kinds: Counter = field(default_factory=Counter)
    untimed: list[Record] = field(default_factory=list)  # of timed kinds, without samples
    superseded: list[Record] = field(default_factory=list)
    cold: list[Record] = field(default_factory=list)  # with cold caches, to which no page compares others
    ceilings: list[Record] = field(default_factory=list)  # valid ones, which concern all mini-apps
    outdated: list[Record] = field(default_factory=list)  # whose counts of work stand in no table
    everything: list[Record] = field(default_factory=list)  # in the order of the files, also of unknown kinds

    @property
    def apps(self) -> list[str]:
        """Mini-apps that have records."""
        every = self.records + self.failed_runs + self.failed_checks + self.untimed
        return sorted({record.app for record in every})

    def for_app(self, app: str) -> "Evidence":
        """Records of one mini-app."""

        def own(records: list[Record]) -> list[Record]:
            return [record for record in records if record.app == app]

        return Evidence(
            self.folder, own(self.records), own(self.failed_runs), own(self.failed_checks),
            self.unknown_kinds, own(self.untimed), own(self.superseded), own(self.cold),
            self.ceilings or [record for record in self.records if record.kind == "ceiling"],
            own(self.outdated),
        )

    @property
    def machines(self) -> list[Machine]:
        """Machines in the order of their first record."""
        return list(dict.fromkeys(record.machine for record in self.records + self.failed_runs))

    def failed_runs_on(self, machine: Machine) -> list[Record]:
        """Failed runs of one machine."""
        return [record for record in self.failed_runs if record.machine == machine]

    def select(self, machine: Machine, kind: str) -> list[Record]:
        """Valid records of one machine and kind."""
        return [record for record in self.records if record.machine == machine and record.kind == kind]


def _latest(records: list[Record]) -> list[Record]:
    """Latest record of each case and machine, in the order of first appearance."""
    kept: dict[tuple[Machine, str], Record] = {}
    for record in records:
        key = record.machine, record.case
        if key not in kept or record.run_id >= kept[key].run_id:
            kept[key] = record
    return list(kept.values())


def read_records(folder: Path) -> Evidence | None:
    """Records of all *.jsonl files of a folder, None without files.

    Raises Failure: INVALID for an invalid line or without records, IO_ERROR for an unreadable file.
    """
    files = sorted(folder.glob(RECORDS))
    if not files:
        return None
    evidence, known = Evidence(folder), []
    for file in files:
        for record in read_file(file):
            evidence.everything.append(record)
            if record.cold_caches:
                evidence.cold.append(record)
            elif record.kind in KINDS:
                known.append(record)
            else:
                evidence.unknown_kinds[record.kind] += 1
    if not evidence.everything:
        raise Failure(INVALID, f"{files[0]}: the file holds no records.")
    latest = _latest(known)
    kept = {id(record) for record in latest}
    evidence.superseded = [record for record in known if id(record) not in kept]
    for record in latest:
        if not record.succeeded:
            evidence.failed_runs.append(record)
        # Contradictions between the model of occupancy and a profile are its result: its table marks them.
        elif record.check == "failed" and record.kind != "occupancy":
            evidence.failed_checks.append(record)
        elif record.lacks_times:
            evidence.untimed.append(record)
        else:
            evidence.records.append(record)
    evidence.records, evidence.outdated = without_outdated_counts(evidence.records)
    return evidence
