"""Figure of option prices: a surface over strikes and maturities, and exercise boundaries over time."""

import csv
from pathlib import Path

from .. import style
from ..failure import IO_ERROR, Failure
from ..style import plt

FILES = ("surface.csv", "boundary.csv")
_MOST_CURVES = len(style.PALETTE)
_MOST_ON_ONE_AXIS = 10.0  # quotient of times to expiry


def _curves(file: Path, names: tuple[str, ...], x: str, y: str) -> dict[str, tuple[list[float], list[float]]]:
    """Points (x, y) by the values of the columns `names`; skips rows without x or y. Raises Failure (IO_ERROR)."""
    curves = {}
    try:
        with file.open(newline="", encoding="utf-8") as stream:
            for row in csv.DictReader(stream):
                if row[x] and row[y]:
                    xs, ys = curves.setdefault(tuple(row[name] for name in names), ([], []))
                    xs.append(float(row[x]))
                    ys.append(float(row[y]))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Failure(IO_ERROR, f"{file} cannot be read: {str(error).splitlines()[0]}.") from None
    return curves


def _merge_equal_curves(curves: dict) -> dict:
    """Distinct curves; the label of several equal ones is the first label with their number."""
    equal = {}
    for label, (x, y) in curves.items():
        equal.setdefault((tuple(x), tuple(y)), []).append(label)
    return {
        f"{labels[0]} ({len(labels)} equal)" if len(labels) > 1 else labels[0]: curve
        for curve, labels in equal.items()
    }


def _duration(years: float) -> str:
    """Short text of a time in the unit that suits it."""
    for name, unit in (("a", 1.0), ("months", 1.0 / 12.0), ("d", 1.0 / 365.0)):
        if years >= 0.95 * unit:
            return f"{years / unit:.3g} {name}"
    return f"{years * 8760.0:.3g} h"


def _share_of_lifetimes(curves: dict) -> dict:
    """The curves over the elapsed share of their times to expiry, which their labels state: a week and ten years
    do not fit on one axis of years. `curves`: by label and time to expiry, years.
    """
    return {
        (f"{label}, {_duration(life)}", life): ([time / life for time in x] if life > 0.0 else x, y)
        for (label, life), (x, y) in curves.items()
    }


def _boundaries(file: Path) -> dict[tuple[str, float], tuple[list[float], list[float]]]:
    """Exercise boundaries by identifier and time to expiry, years, before which they end. Raises Failure (IO_ERROR)."""
    try:
        found = _curves(file, ("id", "maturity"), "time", "spot")
        return {(name, float(maturity)): curve for (name, maturity), curve in found.items()}
    except ValueError as error:
        raise Failure(IO_ERROR, f"{file} cannot be read: {error}.") from None


def _draw(axes, curves, labels, title, across, up):
    ends = []
    for colour, (label, (x, y)) in zip(style.PALETTE, zip(labels, curves)):
        axes.plot(x, y, color=colour)
        ends.append(((x[-1], y[-1]), label, colour))
    axes.set_title(title)
    axes.set_xlabel(across)
    axes.set_ylabel(up)
    style.label_curves(axes, ends)


def prices_figure(folder: Path):
    """Figure of the FILES that a folder holds; None if none of their rows has a price. Raises Failure (IO_ERROR)."""
    panels = []
    surface, boundary = (folder / name for name in FILES)
    if surface.is_file():
        curves = _curves(surface, ("id", "maturity"), "strike", "price")
        first = next(iter(curves), ("",))[0]
        chosen = _merge_equal_curves({names[1]: curve for names, curve in curves.items() if names[0] == first})
        if chosen:
            title = f"price of {first} by years to maturity"
            panels.append((list(chosen.values()), list(chosen), title, "strike", "price"))
    if boundary.is_file():
        found, across = _boundaries(boundary), "time (years)"
        lifetimes = [life for _, life in found if life > 0.0]
        if lifetimes and max(lifetimes) > _MOST_ON_ONE_AXIS * min(lifetimes):
            found, across = _share_of_lifetimes(found), "elapsed share of the time to expiry"
        curves = _merge_equal_curves({name: curve for (name, _), curve in found.items()})
        if curves:
            panels.append((list(curves.values()), list(curves), "exercise boundary", across, "spot"))
    if not panels:
        return None
    height = 1.0 + 2.6 * len(panels)
    figure, axes = plt.subplots(len(panels), 1, figsize=(5.2, height), squeeze=False)
    figure.subplots_adjust(left=0.14, right=0.8, top=1 - 0.9 / height, bottom=0.5 / height, hspace=0.5)
    for panel, (curves, *words) in zip(axes[:, 0], panels):
        _draw(panel, curves, *words)
    left_out = sum(max(0, len(panel[0]) - _MOST_CURVES) for panel in panels)
    style.heading(figure, folder.resolve().name, f"options{f'; curves left out: {left_out}' if left_out else ''}")
    return figure
