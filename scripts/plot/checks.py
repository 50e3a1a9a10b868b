"""Checks of result.json in headings and tables: which one a picture names, and with what words."""

import re

# Met by every solution to round-off, by most solutions closely, and without a limit for a mesh.
_TRIVIAL = ("conservation", "divergence", "force_balance", "momentum", "angular_momentum")
_USUAL = ("equilibrium", "energy_drift", "energy_balance", "energy_growth", "speed_growth", "intersections", "penetration")
INVARIANTS = _TRIVIAL + _USUAL  # do not converge with the mesh
_IS_ERROR = re.compile(r"(l1|l2|linf)_|cauchy_|cos_difference")


def main_check(result: dict) -> dict:
    """The most telling check of a run: the first that is no invariant, else the first that not every solution meets; {} of none."""
    checks = result.get("checks", [])
    return min(checks, key=lambda check: 2 * (check["name"] in _TRIVIAL) + (check["name"] in _USUAL), default={})


def check_label(name: str) -> str:
    """Display name of a check."""
    words = re.sub(r"^values_(\d+_)?", "", name).replace("_", " ")
    # The values of all others are deviations from what the scene states.
    return words if name in INVARIANTS or _IS_ERROR.match(name) or not name else f"{words} off by"


def check_caption(result: dict) -> str:
    """Value and tolerance of the main check, as the end of a subtitle; empty without a value."""
    check = main_check(result)
    if check.get("value") is None:
        return ""
    words = check_label(re.sub(r"_0(?=_|$)", "", check["name"]))
    return f", {words} {check['value']:.2g} (tolerance {check['tolerance']:.2g})"
