"""Roofline sections: measured ceilings of a device, and the share of them that a step of drogue-gas attains."""

from dataclasses import dataclass

import numpy as np

from .. import html_page, style
from ..style import plt
from .bounds import backend_ceilings, bounds_table, ceiling_table, ceilings, launch_seconds, scaled
from .perf_record import BACKENDS, Machine, Record
from .section import Picture, Section, Table, format_cells

_COMMAND = "drogue-perf run --filter '^(ceiling|gas-step)' --out FILE.jsonl"
_BYTES = {
    "memory": ("#7A7A7A", "memory"), "l3": ("#8E8E8E", "L3"), "l2": ("#A4A4A4", "L2"), "cache": ("#B9B9B9", "cache"),
}


@dataclass(frozen=True)
class Point:
    """A step: arithmetic intensity, FLOP per byte, and rate, FLOP/s."""

    cells: int
    intensity: float
    rate: float
    launch_rate: float | None = None  # FLOP/s that the latency of its launches allows


def bandwidths(records: list[Record]) -> dict[str, float]:
    """Measured bandwidth of the memory, B/s, by backend."""
    names = dict.fromkeys(record.facts["backend"] for record in records)
    found = {name: ceilings([r for r in records if r.facts["backend"] == name]).get("memory") for name in names}
    return {name: speed for name, speed in found.items() if speed}


def points(steps: list[Record], tops: dict[str, float] | None = None) -> list[Point]:
    """Steps in the default variant whose work is known, by increasing mesh, with the bound of launches by `tops`."""
    found = []
    for record in steps:
        flops, moved = (record.facts.get(name, 0) for name in ("flops", "bytes"))
        if flops > 0 and moved > 0 and not record.facts["variant"]:
            seconds = launch_seconds(record.facts, tops or {})
            limit = flops / seconds if seconds else None
            found.append(Point(record.facts["cells"], flops / moved, flops / record.median, limit))
    return sorted(found, key=lambda point: point.cells)


def _draw_ceilings(axes, tops: dict[str, float], low: float, high: float) -> None:
    peak = tops.get("fp64", np.inf)
    at = np.geomspace(low, high, 200)
    for name, (colour, _) in _BYTES.items():
        if name in tops:
            axes.plot(at, np.minimum(peak, tops[name] * at), color=colour, linewidth=1.2)
    above = "fp32" in tops and tops["fp32"] > peak
    if above:
        first = tops["fp32"] / max((tops[name] for name in _BYTES if name in tops), default=np.inf)
        axes.plot([max(first, low), high], [tops["fp32"]] * 2, color=style.MUTED, linewidth=1.0, linestyle="--")
        axes.annotate(
            f"FP32 {scaled(tops['fp32'], 'FLOP/s')}", (high, tops["fp32"]), (0, 4), textcoords="offset points",
            ha="right", fontsize=8, color=style.MUTED,
        )
    if "fp64" in tops:
        first = peak / max((tops[name] for name in _BYTES if name in tops), default=np.inf)
        axes.plot([max(first, low), high], [peak, peak], color=style.INK, linewidth=1.2)
        axes.annotate(
            f"FP64 {scaled(peak, 'FLOP/s')}", (high, peak), (0, -4) if above else (0, 4),
            textcoords="offset points", ha="right", va="top" if above else "baseline", fontsize=8,
        )


def _label_slopes(axes, tops: dict[str, float], low: float) -> None:
    """Labels the bandwidth slopes, above the upper one and below the lower one."""
    slopes = sorted((name for name in _BYTES if name in tops), key=tops.get)
    for name in slopes:
        start, end = (axes.transData.transform((x, tops[name] * x)) for x in (low, 2 * low))
        angle = np.degrees(np.arctan2(*(end - start)[::-1]))
        above = name == slopes[-1]
        axes.annotate(
            f"{_BYTES[name][1]} {scaled(tops[name], 'B/s')}", (1.15 * low, tops[name] * 1.15 * low),
            (-3, 3) if above else (3, -3), textcoords="offset points", rotation=angle, rotation_mode="anchor",
            va="bottom" if above else "top", fontsize=8, color=style.MUTED,
        )


def roofline_figure(title: str, machine: Machine, tops: dict[str, float], found: list[Point]):
    """Roofline plot: FLOP/s against FLOP per byte on logarithmic axes, with the measured ceilings."""
    left, right, bottom, top = 0.75, 2.1 if found else 0.2, 0.5, 0.62
    details = f"{'a step of WENO-JS under ' if found else ''}measured ceilings; {machine.name}"
    limited = [point for point in found if point.launch_rate and point.launch_rate < tops.get("fp64", np.inf)]
    details += "; short lines: latency of launches" if limited else ""
    figure, axes = plt.subplots()
    width, height = max(left + 3.7 + right, style.subtitle_width(figure, details)), bottom + 2.5 + top
    figure.set_size_inches(width, height)
    figure.subplots_adjust(left=left / width, right=1 - right / width, bottom=bottom / height, top=1 - top / height)
    speed = max((tops[name] for name in _BYTES if name in tops), default=None)
    ridge = [tops["fp64"] / speed] if speed and "fp64" in tops else []
    middle = ridge + [point.intensity for point in found] or [1.0]
    low, high = min(middle) / 16, max(middle) * 8
    rates = [point.rate for point in found] + [point.launch_rate for point in limited] + [tops[name] * low for name in _BYTES if name in tops]
    rates += [tops["fp64"]] if "fp64" in tops else [speed * high] if speed else []
    rates += [tops["fp32"]] if "fp32" in tops else []
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(low, high)
    axes.set_ylim(min(rates) / 2, max(rates) * 3)
    _draw_ceilings(axes, tops, low, high)
    ends = []
    for index, point in enumerate(found):
        colour = style.PALETTE[index % len(style.PALETTE)]
        axes.plot(point.intensity, point.rate, "o", color=colour, markersize=6, zorder=3)
        if point in limited:
            axes.plot(point.intensity, point.launch_rate, "_", color=colour, markersize=14, zorder=2)
        share = f": {100 * point.rate / tops['fp64']:.2g} % of FP64" if "fp64" in tops else ""
        ends.append(((point.intensity, point.rate), f"{format_cells(point.cells)} cells{share}", colour))
    axes.set_xlabel("FLOP a byte of memory")
    axes.set_ylabel("FLOP/s")
    style.set_log_ticks(axes.xaxis)
    style.set_log_ticks(axes.yaxis)
    _label_slopes(axes, tops, low)
    style.label_curves(axes, ends)
    style.heading(figure, title, details)
    return figure


def _share_table(tops: dict[str, float], found: list[Point]) -> Table:
    columns = [("cells", True), ("FLOP a byte", True), ("FLOP/s", True), ("B/s", True)]
    columns += [(f"% of {name}", True) for name in ("fp64", *_BYTES) if name in tops]
    rows = []
    for point in found:
        moved = point.rate / point.intensity
        row = [
            html_page.format_grouped(point.cells), html_page.format_number(point.intensity),
            scaled(point.rate, "FLOP/s"), scaled(moved, "B/s"),
        ]
        shares = [point.rate / tops["fp64"]] if "fp64" in tops else []
        shares += [moved / tops[name] for name in _BYTES if name in tops]
        rows.append(row + [html_page.format_number(100 * share) for share in shares])
    return Table(columns, rows, "A step beside the ceilings")


def sections(machine: Machine, records: list[Record], steps: list[Record]) -> list[Section]:
    """One section per backend that has a measured ceiling."""
    found = []
    for backend in dict.fromkeys(record.facts["backend"] for record in records):
        own = [record for record in records if record.facts["backend"] == backend]
        beside = [record for record in steps if record.facts["backend"] == backend]
        tops, note = backend_ceilings(records, backend)
        shown = points(beside, tops)
        if not any(name in tops for name in ("fp64", *_BYTES)):
            continue
        title = f"Roofline, {BACKENDS.get(backend, backend)}"
        picture = Picture(
            f"roofline_{backend}_{machine.slug}",
            lambda title=title, tops=tops, shown=shown: roofline_figure(title, machine, tops, shown),
            f"{title}: FLOP/s of a step against FLOP a byte under the measured ceilings",
        )
        bound = bounds_table(beside, tops)
        tables = [ceiling_table(tops, backend, note)] + ([_share_table(tops, shown)] if shown else [])
        tables += [bound] if bound else []
        used = own + [record for record in beside if record.facts.get("flops") and not record.facts["variant"]]
        found.append(Section(title, _COMMAND, used, [picture], tables))
    return found
