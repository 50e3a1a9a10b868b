"""Lookup of the scheme family of a work-precision record."""

from ..flow import scheme_family as flow
from ..gas import scheme_family as gas
from ..options import scheme_family as options
from ..parachute import scheme_family as parachute
from ..springs import scheme_family as springs
from .perf_record import Record
from .scheme_family import SchemeFamily

_BY_KIND = {
    "springs-solution": springs.FAMILY,
    "options-solution": options.FAMILY,
    "flow-solution": flow.FAMILY,
    "parachute-solution": parachute.FAMILY,
}


def family_of(record: Record) -> SchemeFamily:
    """Scheme family of the mini-app of a record."""
    return _BY_KIND.get(record.kind, gas.FAMILY)
