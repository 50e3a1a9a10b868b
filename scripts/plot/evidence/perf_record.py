"""Validated record of drogue-perf, one line of a *.jsonl file, with its machine."""

import json
import re
from dataclasses import dataclass, field
from pathlib import Path

from ..failure import INVALID, IO_ERROR, Failure

SCHEMA = "drogue.perf/1"
BACKENDS = {"serial": "Serial", "openmp": "OpenMP", "cuda": "CUDA"}

# Required facts of each kind of record; _OPTIONAL lists the others.
_FACTS = {
    "gas-solution": {"problem": str, "backend": str, "weno": str, "cells": int},
    "gas-step": {},
    "flow-step": {"backend": str, "cells": int, "variant": str},
    "flow-pressure": {"backend": str, "cells": int, "variant": str},
    "parachute-flight": {"backend": str, "cells": int, "variant": str},
    "flow-memory": {"backend": str, "cells": int, "variant": str, "array_bytes": int},
    "flow-solution": {
        "problem": str, "backend": str, "advection": str, "time_scheme": str, "pressure": str, "diffusion": str,
        "cells": int,
    },
    "parachute-solution": {"problem": str, "backend": str, "kernel": str, "time": str, "edge": str, "cells": int},
    "ceiling": {"backend": str},
    "gas-transfers": {"backend": str, "memory": str, "cells": int, "h2d_s": float, "compute_s": float, "d2h_s": float},
    "gas-block": {"backend": str, "form": str, "block": int, "cells": int},
    "options-block": {"backend": str, "form": str, "block": int, "cells": int},
    "flow-block": {"backend": str, "form": str, "block": int, "cells": int},
    "parachute-block": {"backend": str, "form": str, "block": int, "cells": int},
    "springs-solution": {"problem": str, "backend": str, "model": str, "mass": str, "integrator": str, "cells": int},
    "springs-step": {},
    "springs-contact": {},
    "springs-transfers": {
        "backend": str, "substeps": int, "cells": int, "h2d_s": float, "compute_s": float, "d2h_s": float,
    },
    "parachute-transfers": {
        "backend": str, "memory": str, "substeps": int, "cells": int, "h2d_s": float, "compute_s": float, "d2h_s": float,
    },
    "options": {},
    "options-surface": {"backend": str, "cells": int, "variant": str},
    "options-cos": {"backend": str, "cells": int, "variant": str},
    "options-solution": {"problem": str, "backend": str, "method": str, "cells": int},
    "options-transfers": {
        "backend": str, "method": str, "mesh": int, "cells": int, "h2d_s": float, "compute_s": float, "d2h_s": float,
    },
    "tridiagonal": {},
    "abstraction": {"backend": str, "cells": int, "version": str, "launches": str},
    "scaling": {"backend": str, "cells": int, "threads": int},
    "benchmark": {
        "backend": str, "cells": int, "problem": str, "size": str, "extent": str, "ranks": int, "threads": int, "memory_bytes": int,
        "quantity": str, "merit": str, "command": str,
    },
    "ladder": {"ladder": str, "rung": str, "backend": str, "cells": int, "predicted_s": float, "predicted_bound": str},
    "machine": {"host": dict},
    "occupancy": {
        "architecture": str, "block": int, "registers": int, "shared_bytes": float, "blocks_by_registers": float,
        "blocks_by_shared_memory": float, "blocks_by_threads": float, "blocks_by_limit": float, "blocks": float,
        "threads_sm": float, "occupancy": float,
    },
}
_NAMED_BY_CASE = ("gas-step", "springs-step", "springs-contact", "options", "tridiagonal")  # facts in the case name
# Kinds of all mini-apps: the word of the case that names the kernel.
_PLACE_OF_KERNEL = {"abstraction": 2, "scaling": 1}
_APPS = ("gas", "springs", "options", "flow")
# Layout of cases whose words the pages show, behind the kind.
_LAYOUTS = {
    "flow-pressure": (r"[^/]+/\d{1,9}x\d{1,9}x\d{1,9}/[^/]+/[^/]+(/.*)?", "BACKEND/NXxNYxNZ/SOLVER/SIDES[/TOLERANCE]"),
    "flow-memory": (r"[^/]+/\d{1,9}x\d{1,9}x\d{1,9}/.+", "BACKEND/NXxNYxNZ/CASE"),
}
_METHODS = ("seed", "pide")  # of options-transfers
STATED = ("machine", "occupancy", "flow-memory")  # computed or read, never timed: tables of their own show all of them
# Counted work of a step, for its bounds.
_COUNTS = {"instructions": float, "launches": int, "driver": str}
_OPTIONAL = {
    "benchmark": {"figure_of_merit": float, "efficiency": float, "environment": dict},
    "flow-step": {"bytes": float, "solution_error": float, **_COUNTS},
    "flow-pressure": {"tolerance": float, "iterations": int},
    "flow-memory": {"driver_bytes": int},
    "flow-solution": {"status": str, "message": str},
    "parachute-solution": {"status": str, "message": str},
    "gas-solution": {
        "weno_power": float, "splitting": str, "time_scheme": str, "precision": str, "status": str, "message": str,
    },
    "gas-step": {"flops": float, "bytes": float, "vector_bits": int, **_COUNTS},
    "springs-step": {"bytes": float, **_COUNTS},
    "options": {"flops": float, "bytes": float},
    "tridiagonal": {"flops": float, "bytes": float},
    "ceiling": {"flops": float, "bytes": float, "instructions": float},
    "machine": {"device": dict, "thesis": dict},
    "occupancy": {
        "threads_device": float, "thesis": dict, "slots": int, "least_blocks": int, "kernel": str, "limited_by": str,
        "launches": int, "achieved": dict, "device": str,
    },
    "scaling": {
        "ranks": int, "scaling": str, "transport": str, "bytes": float, "rounds": int, "latency_s": float, "bandwidth": float,
        "messages_s": float, "model_s": float,
    },
    "abstraction": {"ratio": float, "ratio_low": float, "ratio_high": float, "block": int, "steps": int},
    "gas-transfers": {"thesis": dict, "method": str, "cpu_s": float},
    "springs-solution": {"status": str, "message": str},
    "springs-transfers": {"thesis": dict, "memory": str, "cpu_s": float},
    "options-solution": {"exercise": str, "grids": str, "intervals_a_step": str, "status": str, "message": str},
    "options-transfers": {"thesis": dict, "memory": str, "cpu_s": float},
}
KINDS = frozenset(_FACTS)
# Ratios and products of numbers within these limits neither overflow nor vanish.
_LARGEST, _LARGEST_COUNT = 1e100, 2**63 - 1
_TYPES = {str: "text", int: "positive whole number", float: "number", dict: "JSON object"}


@dataclass(frozen=True)
class Machine:
    """Machine of a record; records of different machines are never combined."""

    gpu: str
    cpu: str

    @property
    def name(self) -> str:
        """Display name."""
        return re.sub(r"\((R|TM)\)", "", ", ".join(filter(None, (self.gpu, self.cpu)))) or "unknown machine"

    @property
    def slug(self) -> str:
        """Name for use in file names."""
        words = re.sub(r"\((r|tm)\)", "", (self.gpu or self.cpu or "unknown machine").lower())
        return re.sub(r"[^a-z0-9]+", "-", words).strip("-")


@dataclass(frozen=True)
class Record:
    """One timed case; `median` and `interval` are in s per unit of work, None if not measured."""

    case: str
    unit: str
    check: str
    median: float | None
    interval: tuple[float, float] | None
    error: float | None
    facts: dict
    provenance: dict
    samples: tuple[float, ...] = ()  # s per unit of work
    cold_caches: bool = False  # before each work
    place: str = field(default="", compare=False)  # FILE:LINE

    @property
    def kind(self) -> str:
        """First component of the case name."""
        return self.case.partition("/")[0]

    @property
    def app(self) -> str:
        """Mini-app whose page shows the record; ceilings belong to gas, tridiagonal systems to options, canopies to flow.

        What is of no mini-app is on the page `machine`.
        """
        app = self.case.split("/")[_PLACE_OF_KERNEL.get(self.kind, 0)].partition("-")[0]
        return {"ceiling": "gas", "tridiagonal": "options", "parachute": "flow", "occupancy": "machine", "benchmark": "machine"}.get(app, app)

    @property
    def machine(self) -> Machine:
        return Machine(str(self.provenance.get("gpu") or ""), str(self.provenance.get("cpu") or ""))

    def device(self, on_gpu: bool) -> str:
        """Name of the GPU, or of the processor."""
        return (Machine(self.machine.gpu, "") if on_gpu else Machine("", self.machine.cpu)).name

    @property
    def file(self) -> Path:
        return Path(self.place.rpartition(":")[0])

    @property
    def run_id(self) -> tuple[str, str]:
        """Date and commit; equal for all records of one run of drogue-perf."""
        return str(self.provenance.get("date", "")), str(self.provenance.get("git", ""))

    @property
    def threads(self) -> int:
        return int(self.provenance.get("threads") or 1)

    @property
    def lacks_times(self) -> bool:
        """Whether a record of a kind that is timed holds no samples and no median."""
        return self.kind in KINDS and self.kind not in STATED and self.median is None and self.check == "passed"

    @property
    def succeeded(self) -> bool:
        """Whether the scheme solved the problem; failed runs are listed, not drawn."""
        return self.facts.get("status", "ok") == "ok"


def _has_type(value, kind: type) -> bool:
    """Whether a value is of the kind; numbers must be within the limits, integers positive."""
    if kind in (str, dict) or isinstance(value, bool):
        return kind in (str, dict) and isinstance(value, kind)
    if kind is int:
        return isinstance(value, int) and 0 < value <= _LARGEST_COUNT
    return isinstance(value, int | float) and -_LARGEST <= value <= _LARGEST


def _is_time(value) -> bool:
    """Whether a value is a positive time, s."""
    return _has_type(value, float) and value >= 1 / _LARGEST


def _checked_facts(case: str, facts: dict, place: str) -> dict:
    """Validated facts, completed by those in the case name; raises Failure (INVALID)."""
    kind, *words = case.split("/")
    if kind in _NAMED_BY_CASE:
        if len(words) < 2 or not words[1].isdecimal():
            raise Failure(INVALID, f"{place}: '{case}' is not {kind}/BACKEND/CELLS[/VARIANT].")
        facts = facts | {"backend": words[0], "cells": int(words[1]), "variant": "/".join(words[2:])}
    if kind in _LAYOUTS and not re.fullmatch(_LAYOUTS[kind][0], "/".join(words)):
        raise Failure(INVALID, f"{place}: '{case}' is not {kind}/{_LAYOUTS[kind][1]}.")
    if kind in _PLACE_OF_KERNEL:
        kernel = (case.split("/") + ["", ""])[_PLACE_OF_KERNEL[kind]]
        if kernel.partition("-")[0] not in _APPS:
            raise Failure(INVALID, f"{place}: '{case}' names no kernel of {', '.join(_APPS)}.")
        if "/ranks/" in case and facts.get("ranks") is None:
            raise Failure(INVALID, f"{place}: fact 'ranks' of {case} is no {_TYPES[int]}.")
    for name, wanted in _FACTS[kind].items():
        if not _has_type(facts.get(name), wanted):
            raise Failure(INVALID, f"{place}: fact '{name}' of {case} is no {_TYPES[wanted]}.")
    for name, wanted in _OPTIONAL.get(kind, {}).items():
        if facts.get(name) is not None and not _has_type(facts[name], wanted):
            raise Failure(INVALID, f"{place}: fact '{name}' of {case} is no {_TYPES[wanted]}.")
    if kind == "options-transfers" and facts["method"] not in _METHODS:
        raise Failure(INVALID, f"{place}: fact 'method' of {case} is none of {', '.join(_METHODS)}.")
    return {name: value for name, value in facts.items() if value is not None}


def _times(document: dict, place: str) -> tuple[float, tuple[float, float]]:
    """Median and confidence interval, s; raises Failure (INVALID)."""
    median, interval = document.get("median"), document.get("interval")
    if not _is_time(median):
        raise Failure(INVALID, f"{place}: the median of {document['case']} is no time.")
    if (not isinstance(interval, list) or len(interval) != 2 or not all(_is_time(end) for end in interval)):
        raise Failure(INVALID, f"{place}: the interval of {document['case']} is not two times.")
    return median, (interval[0], interval[1])


def parse(line: str, place: str) -> Record:
    """Record of a line of JSON; raises Failure (INVALID) that names `place` (FILE:LINE) if it is invalid."""
    try:
        document = json.loads(line)
    except ValueError as error:
        raise Failure(INVALID, f"{place}: no JSON: {str(error).partition(': line')[0]}.") from None
    if not isinstance(document, dict):
        raise Failure(INVALID, f"{place}: the line is no JSON object.")
    if document.get("schema") != SCHEMA:
        raise Failure(INVALID, f"{place}: the schema is '{document.get('schema', '')}'; drogue-plot reads {SCHEMA}.")
    case, check = document.get("case"), document.get("check")
    facts, provenance = document.get("facts", {}), document.get("provenance", {})
    if not isinstance(case, str) or not case:
        raise Failure(INVALID, f"{place}: the record names no case.")
    if check not in ("passed", "failed"):
        raise Failure(INVALID, f"{place}: the check of {case} is neither passed nor failed.")
    if not isinstance(facts, dict) or not isinstance(provenance, dict):
        raise Failure(INVALID, f"{place}: facts or provenance of {case} is no JSON object.")
    if not _has_type(provenance.get("threads", 1), int):
        raise Failure(INVALID, f"{place}: threads of {case} is no positive whole number.")
    median, interval, error = None, None, document.get("error")
    kind = case.partition("/")[0]
    if kind in _FACTS:
        facts = _checked_facts(case, facts, place)
        if kind not in STATED and check == "passed" and facts.get("status", "ok") == "ok":
            # A measurement that ended early may leave a record without samples, which the pages name.
            if document.get("median") is not None or document.get("samples"):
                median, interval = _times(document, place)
            if kind.endswith("-solution") and not _has_type(error, float):
                raise Failure(INVALID, f"{place}: the error of {case} is no number.")
    unit, error = str(document.get("unit", "")), error if _has_type(error, float) else None
    samples = document.get("samples", [])
    if not isinstance(samples, list) or not all(_is_time(sample) for sample in samples):
        raise Failure(INVALID, f"{place}: the samples of {case} are no times.")
    instrument = document.get("instrument", {})
    caches = instrument.get("caches", "warm") if isinstance(instrument, dict) else None
    if caches not in ("cold", "warm"):
        raise Failure(INVALID, f"{place}: the caches of {case} are neither cold nor warm.")
    return Record(case, unit, check, median, interval, error, facts, provenance, tuple(samples), caches == "cold", place)


def read_file(file: Path) -> list[Record]:
    """Records of a file; raises Failure: INVALID for an invalid line, IO_ERROR for an unreadable file."""
    try:
        lines = file.read_bytes().decode("utf-8").split("\n")
    except OSError as error:
        raise Failure(IO_ERROR, f"{file} cannot be read: {error}.") from None
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        raise Failure(INVALID, f"{file}:{line}: the file is no text in UTF-8.") from None
    return [parse(line, f"{file}:{number}") for number, line in enumerate(lines, 1) if line.strip()]
