"""Reader of run directories: fields.h5, scene.toml, result.json, history.csv, study.csv and study.json."""

import csv
import json
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

from .failure import IO_ERROR, USAGE, Failure

READABLE = ("fields.h5", "history.csv", "study.csv", "surface.csv", "boundary.csv")
RECORDS = "*.jsonl"
SHEETS = ("body", "flag")


@dataclass(frozen=True)
class Field:
    """Values of one dataset with its unit and description."""

    name: str
    values: np.ndarray
    units: str = ""
    description: str = ""


@dataclass(frozen=True)
class Snapshot:
    """Fields at one time, s; `canopy` holds those of the canopies in a flow, `sheets` those of bodies and flags."""

    time: float
    fields: dict[str, Field]
    canopy: dict[str, Field] = field(default_factory=dict)
    sheets: dict[str, dict[str, Field]] = field(default_factory=dict)


@dataclass(frozen=True)
class Reference:
    """Reference solution at the final time, from a finer run."""

    x: np.ndarray
    fields: dict[str, Field]
    scheme: str
    cells: int


@dataclass
class Run:
    """Contents of a run directory; missing files leave empty members."""

    path: Path
    scene: dict = field(default_factory=dict)
    result: dict = field(default_factory=dict)
    mesh: dict[str, Field] = field(default_factory=dict)
    canopy_mesh: dict[str, Field] = field(default_factory=dict)
    sheet_meshes: dict[str, dict[str, Field]] = field(default_factory=dict)
    snapshots: list[Snapshot] = field(default_factory=list)
    reference: Reference | None = None
    history: dict[str, Field] = field(default_factory=dict)
    study: list[dict[str, str]] = field(default_factory=list)
    study_facts: dict = field(default_factory=dict)

    @property
    def app(self) -> str:
        return self.scene.get("app", "")

    @property
    def name(self) -> str:
        return self.path.resolve().name

    @property
    def scene_name(self) -> str:
        """Scene of the study, or the name of the folder if there is no study.json."""
        return str(self.study_facts.get("scene") or self.name)


def evenly_spaced(snapshots: list[Snapshot], most: int) -> list[Snapshot]:
    """At most `most` of the snapshots, the first and the last one among them."""
    count = min(len(snapshots), most)
    return [snapshots[k] for k in np.linspace(0, len(snapshots) - 1, count).round().astype(int)]


def _text(value) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def _datasets(group) -> dict[str, Field]:
    return {
        name: Field(name, item[()], _text(item.attrs.get("units", "")), _text(item.attrs.get("description", "")))
        for name, item in group.items()
        if isinstance(item, h5py.Dataset)
    }


def _read_fields(run: Run, file: Path) -> None:
    try:
        with h5py.File(file, "r") as h5:
            run.mesh = _datasets(h5["mesh"])
            run.canopy_mesh = _datasets(h5["mesh"].get("canopy", {}))
            run.sheet_meshes = {name: _datasets(h5["mesh"][name]) for name in SHEETS if name in h5["mesh"]}
            for name in sorted(h5["steps"]):
                group = h5["steps"][name]
                time = float(np.ravel(group.attrs["time"])[0])
                sheets = {sheet: _datasets(group[sheet]) for sheet in SHEETS if sheet in group}
                run.snapshots.append(Snapshot(time, _datasets(group), _datasets(group.get("canopy", {})), sheets))
            if "reference" in h5:
                group = h5["reference"]
                fields = _datasets(group)
                x = fields.pop("x").values
                cells = int(np.ravel(group.attrs.get("cells", len(x)))[0])
                run.reference = Reference(x, fields, _text(group.attrs.get("scheme", "")), cells)
    except (OSError, KeyError, RuntimeError, ValueError) as error:
        reason = str(error).strip("'\"").splitlines()[0]
        raise Failure(IO_ERROR, f"{file} cannot be read as a Drogue field file: {reason}.") from None


def _read_history(file: Path) -> dict[str, Field]:
    with file.open(newline="") as stream:
        rows = [row for row in csv.reader(stream) if row]
    if not rows:
        raise ValueError("it is empty, without a line of columns")
    columns = {}
    for index, header in enumerate(rows[0]):
        name, _, units = header.partition("[")
        name = name.strip()
        values = [float(row[index]) for row in rows[1:]]
        columns[name] = Field(name, np.array(values), units.strip().rstrip("]"))
    return columns


def _parse(file: Path, parse):
    try:
        return parse(file)
    except (OSError, ValueError, IndexError) as error:
        raise Failure(IO_ERROR, f"{file} cannot be read: {str(error).splitlines()[0]}.") from None


def _read_object(file: Path) -> dict:
    document = json.loads(file.read_text())
    if not isinstance(document, dict):
        raise ValueError("it holds no JSON object")
    return document


def read_study(file: Path) -> list[dict[str, str]]:
    """Rows of study.csv as text, keyed by column."""
    with file.open(newline="") as stream:
        return list(csv.DictReader(stream))


def read_run(path: Path) -> Run:
    """Contents of a run directory; raises Failure: USAGE if there is nothing to draw, IO_ERROR for a damaged file.

    A folder that holds only benchmark records gives an empty Run; see evidence/records.py.
    """
    if path.is_file():
        names = f"{', '.join(READABLE)} or {RECORDS}"
        raise Failure(
            USAGE,
            f"{path} is a file: drogue-plot takes the folder, {path.parent}, and draws what is called {names} in it.",
        )
    if not path.is_dir():
        raise Failure(USAGE, f"{path} is not a run directory: no such folder.")
    run = Run(path)
    if not any((path / name).is_file() for name in READABLE) and not any(path.glob(RECORDS)):
        raise Failure(USAGE, f"{path} holds nothing to draw: none of {', '.join(READABLE)}, {RECORDS} is there.")
    readers = {
        "scene.toml": lambda file: setattr(run, "scene", tomllib.loads(file.read_text())),
        "result.json": lambda file: setattr(run, "result", _read_object(file)),
        "history.csv": lambda file: setattr(run, "history", _read_history(file)),
        "study.csv": lambda file: setattr(run, "study", read_study(file)),
        "study.json": lambda file: setattr(run, "study_facts", _read_object(file)),
        "fields.h5": lambda file: _read_fields(run, file),
    }
    for name, reader in readers.items():
        if (path / name).is_file():
            _parse(path / name, reader)
    return run
