"""Checks of result.json in headings and tables: which one a picture names, and with what words."""

import math
import re

# Met by every solution to round-off, by most solutions closely, and without a limit for a mesh.
_TRIVIAL = ("conservation", "divergence", "force_balance", "momentum", "angular_momentum")
_USUAL = ("equilibrium", "energy_drift", "energy_balance", "energy_growth", "speed_growth", "intersections", "penetration")
INVARIANTS = _TRIVIAL + _USUAL  # do not converge with the mesh
_IS_ERROR = re.compile(r"(l1|l2|linf)_|cauchy_|cos_difference")


def _excess(check: dict) -> float:
    """Value of a check over its tolerance; infinite without a finite value or a tolerance."""
    value, tolerance = check.get("value"), check["tolerance"]
    return value / tolerance if value is not None and math.isfinite(value) and tolerance > 0 else math.inf


def main_check(result: dict) -> dict:
    """The check that failed by the largest factor, else the most telling one: the first that is no invariant, else the
    first that not every solution meets; {} of none.
    """
    checks = result.get("checks", [])
    if failed := [check for check in checks if not check["passed"]]:
        return max(failed, key=_excess)
    return min(checks, key=lambda check: 2 * (check["name"] in _TRIVIAL) + (check["name"] in _USUAL), default={})


def check_label(name: str) -> str:
    """Display name of a check."""
    words = re.sub(r"^values_(\d+_)?", "", name).replace("_", " ")
    # The values of all others are deviations from what the scene states.
    return words if name in INVARIANTS or _IS_ERROR.match(name) or not name else f"{words} off by"


def check_caption(result: dict) -> str:
    """Value and tolerance of the main check, as the end of a subtitle, and whether it or the run failed; else empty."""
    check = main_check(result)
    if result.get("status") == "numerical-failure":
        return ", FAILED: numerical failure"
    if check.get("value") is None and check.get("passed", True):
        return ""
    words = check_label(re.sub(r"_0(?=_|$)", "", check["name"]))
    value = "is not finite" if check["value"] is None else f"{check['value']:.2g}"
    return f", {'' if check['passed'] else 'FAILED: '}{words} {value} (tolerance {check['tolerance']:.2g})"


def failure_caption(result: dict) -> str:
    """`check_caption` of a run that failed; of others empty."""
    caption = check_caption(result)
    return caption if caption.startswith(", FAILED") else ""
