"""One record of drogue-perf: what a line of a *.jsonl holds, checked, and the machine that it comes from."""

import json
import math
import re
from dataclasses import dataclass

from .failure import IO_ERROR, Failure

SCHEMA = "drogue.perf/1"
BACKENDS = {"serial": "Serial", "openmp": "OpenMP", "cuda": "CUDA"}

# What a kind needs beside its times, then what it may have.
_FACTS = {
    "gas-solution": {"problem": str, "backend": str, "weno": str, "cells": int},
    "gas-step": {},
    "ceiling": {"backend": str},
    "gas-transfers": {"backend": str, "memory": str, "cells": int, "h2d_s": float, "compute_s": float, "d2h_s": float},
    "gas-block": {"backend": str, "form": str, "block": int, "cells": int},
    "springs-solution": {"problem": str, "backend": str, "model": str, "mass": str, "integrator": str, "cells": int},
    "springs-step": {},
    "springs-contact": {},
    "springs-transfers": {
        "backend": str, "substeps": int, "cells": int, "h2d_s": float, "compute_s": float, "d2h_s": float,
    },
    "options": {},
    "options-solution": {"problem": str, "backend": str, "method": str, "cells": int},
    "options-transfers": {
        "backend": str, "method": str, "mesh": int, "cells": int, "h2d_s": float, "compute_s": float, "d2h_s": float,
    },
    "tridiagonal": {},
}  # fmt: skip
_STEPS = ("gas-step", "springs-step", "springs-contact", "options", "tridiagonal")  # what their names say, their facts need not
_OPTIONAL = {
    "gas-solution": {
        "weno_power": float, "splitting": str, "time_scheme": str, "precision": str, "status": str, "message": str,
    },
    "gas-step": {"flops": float, "bytes": float, "vector_bits": int},
    "ceiling": {"flops": float, "bytes": float},
    "gas-transfers": {"thesis": dict},
    "springs-solution": {"status": str, "message": str},
    "springs-transfers": {"thesis": dict},
    "options-solution": {"exercise": str, "grids": str, "intervals_a_step": str, "status": str, "message": str},
    "options-transfers": {"thesis": dict},
}  # fmt: skip
KINDS = frozenset(_FACTS)
_TYPES = {str: "text", int: "positive whole number", float: "number", dict: "JSON object"}


@dataclass(frozen=True)
class Machine:
    """Where records come from: two of them are never mixed."""

    gpu: str
    cpu: str

    @property
    def name(self) -> str:
        return re.sub(r"\((R|TM)\)", "", ", ".join(filter(None, (self.gpu, self.cpu)))) or "unknown machine"

    @property
    def slug(self) -> str:
        """Its name in the names of files."""
        words = re.sub(r"\((r|tm)\)", "", (self.gpu or self.cpu or "unknown machine").lower())
        return re.sub(r"[^a-z0-9]+", "-", words).strip("-")


@dataclass(frozen=True)
class Record:
    """One timed case: `median` and `interval` in s per unit of work; what was not measured is None."""

    case: str
    unit: str
    check: str
    median: float | None
    interval: tuple[float, float] | None
    error: float | None
    facts: dict
    provenance: dict

    @property
    def kind(self) -> str:
        return self.case.partition("/")[0]

    @property
    def app(self) -> str:
        """The mini-app whose page shows it; ceilings are those of the gas roofline, tridiagonal systems of options."""
        app = self.kind.partition("-")[0]
        return {"ceiling": "gas", "tridiagonal": "options"}.get(app, app)

    @property
    def machine(self) -> Machine:
        return Machine(str(self.provenance.get("gpu") or ""), str(self.provenance.get("cpu") or ""))

    @property
    def run(self) -> tuple[str, str]:
        """The same for the records of one run of drogue-perf."""
        return str(self.provenance.get("date", "")), str(self.provenance.get("git", ""))

    @property
    def threads(self) -> int:
        return int(self.provenance.get("threads") or 1)

    @property
    def is_solved(self) -> bool:
        return self.facts.get("status", "ok") == "ok"


def _is(value, kind: type) -> bool:
    if kind in (str, dict) or isinstance(value, bool):
        return kind in (str, dict) and isinstance(value, kind)
    if kind is int:
        return isinstance(value, int) and value > 0
    return isinstance(value, int | float) and math.isfinite(value)


def _checked_facts(case: str, facts: dict, place: str) -> dict:
    """Facts with those that the name of a step gives too."""
    kind, *words = case.split("/")
    if kind in _STEPS:
        if len(words) < 2 or not words[1].isdecimal():
            raise Failure(IO_ERROR, f"{place}: '{case}' is not {kind}/BACKEND/CELLS[/VARIANT].")
        facts = facts | {"backend": words[0], "cells": int(words[1]), "variant": "/".join(words[2:])}
    for name, wanted in _FACTS[kind].items():
        if not _is(facts.get(name), wanted):
            raise Failure(IO_ERROR, f"{place}: fact '{name}' of {case} is no {_TYPES[wanted]}.")
    for name, wanted in _OPTIONAL.get(kind, {}).items():
        if facts.get(name) is not None and not _is(facts[name], wanted):
            raise Failure(IO_ERROR, f"{place}: fact '{name}' of {case} is no {_TYPES[wanted]}.")
    return {name: value for name, value in facts.items() if value is not None}


def _times(document: dict, place: str) -> tuple[float, tuple[float, float]]:
    """Median and interval of a record that counts."""
    median, interval = document.get("median"), document.get("interval")
    if not _is(median, float) or median <= 0:
        raise Failure(IO_ERROR, f"{place}: the median of {document['case']} is no time.")
    if not isinstance(interval, list) or len(interval) != 2 or not all(_is(end, float) and end > 0 for end in interval):
        raise Failure(IO_ERROR, f"{place}: the interval of {document['case']} is not two times.")
    return median, (interval[0], interval[1])


def parse(line: str, place: str) -> Record:
    """The record of a line; exit code 6, with its place (FILE:LINE), where it is none."""
    try:
        document = json.loads(line)
    except ValueError as error:
        raise Failure(IO_ERROR, f"{place} is no JSON: {str(error).partition(': line')[0]}.") from None
    if not isinstance(document, dict):
        raise Failure(IO_ERROR, f"{place} holds no JSON object.")
    if document.get("schema") != SCHEMA:
        raise Failure(IO_ERROR, f"{place} has schema '{document.get('schema', '')}'; drogue-plot reads {SCHEMA}.")
    case, check = document.get("case"), document.get("check")
    facts, provenance = document.get("facts", {}), document.get("provenance", {})
    if not isinstance(case, str) or not case:
        raise Failure(IO_ERROR, f"{place} names no case.")
    if check not in ("passed", "failed"):
        raise Failure(IO_ERROR, f"{place}: the check of {case} is neither passed nor failed.")
    if not isinstance(facts, dict) or not isinstance(provenance, dict):
        raise Failure(IO_ERROR, f"{place}: facts or provenance of {case} is no JSON object.")
    if not _is(provenance.get("threads", 1), int):
        raise Failure(IO_ERROR, f"{place}: threads of {case} is no positive whole number.")
    median, interval, error = None, None, document.get("error")
    if case.partition("/")[0] in _FACTS:
        facts = _checked_facts(case, facts, place)
        if check == "passed" and facts.get("status", "ok") == "ok":
            median, interval = _times(document, place)
            if case.partition("/")[0].endswith("-solution") and not _is(error, float):
                raise Failure(IO_ERROR, f"{place}: the error of {case} is no number.")
    unit, error = str(document.get("unit", "")), error if _is(error, float) else None
    return Record(case, unit, check, median, interval, error, facts, provenance)
