"""Figure of the history of a flow: kinetic energy, dissipation, largest speed, divergence, and outflow per side."""

import numpy as np

from .. import style
from ..checks import failure_caption
from ..run_directory import Run
from ..style import plt

_OUTFLOW = "outflow_"


def keeps_energy(run: Run) -> bool:
    """Whether the kinetic energy changes by dissipation alone: no open side, no moving wall, no force, and nothing in the
    flow that may take energy up.
    """
    grid, flow = run.scene.get("grid", {}), run.scene.get("flow", {})
    sides = [side for pair in grid.get("boundary", {}).values() for side in np.ravel(pair).tolist()]
    forces = [*flow.get("body_force", []), *flow.get("pressure_drop", [])]
    closed = all(side in ("periodic", "slip", "wall") for side in sides)
    holds = any(run.scene.get(name) for name in ("body", "canopy", "flag"))
    return bool(sides) and closed and not grid.get("wall_velocity") and not any(forces) and not holds


def energy_fall(time: np.ndarray, energy: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) between rows of a history, and the rate at which the energy (J) falls between them, W."""
    apart = np.diff(time) > 0
    rate = -np.diff(energy)[apart] / np.diff(time)[apart]
    return ((time[1:] + time[:-1]) / 2)[apart], rate


def _panels(run: Run) -> list[tuple[str, dict[str, tuple[np.ndarray, np.ndarray]], bool]]:
    """Title, curves (time, values) by label, and whether the axis is logarithmic, of each panel."""
    history, time = run.history, run.history["time"].values

    def title(name, words=""):
        return style.axis_label(words or name, history[name].units)

    panels = [(title("kinetic_energy"), {"": (time, history["kinetic_energy"].values)}, False)]
    if "dissipation" in history:
        curves = {"viscous": (time, history["dissipation"].values)}
        if keeps_energy(run):
            curves["energy fall"] = energy_fall(time, history["kinetic_energy"].values)
        panels.append((title("dissipation"), curves if len(curves) > 1 else {"": curves["viscous"]}, False))
    if "max_speed" in history:
        panels.append((title("max_speed", "largest speed"), {"": (time, history["max_speed"].values)}, False))
    divergence = {
        words: (time, history[name].values)
        for name, words in (("divergence_rms", "rms"), ("divergence_max", "largest"))
        if name in history
    }
    if divergence:
        positive = all(np.any(values > 0) for _, values in divergence.values())
        panels.append((title("divergence_rms", "divergence"), divergence, positive))
    outflow = {
        name.removeprefix(_OUTFLOW).replace("_", " "): (time, item.values)
        for name, item in history.items()
        if name.startswith(_OUTFLOW) and np.any(item.values != 0)
    }
    if outflow:
        name = next(name for name in history if name.startswith(_OUTFLOW))
        panels.append((title(name, "flow out of each side"), outflow, False))
    return panels


def expected_points(run: Run, name: str) -> np.ndarray:
    """Times (s), values and tolerances (n, 3) that `verify.*_curve` of the scene states for a column of the history."""
    rows = []
    for curve in run.scene.get("verify", {}).get(f"{name}_curve", []):
        points = np.array(curve["points"], float)
        rows += [(time, value, curve["tolerance"] * np.abs(points[:, 1]).max()) for time, value in points]
    return np.array(rows).reshape(-1, 3)


def _draw_expected(axes, points: np.ndarray) -> None:
    """Draws what the scene expects as circles with bars of the tolerance."""
    if len(points):
        axes.errorbar(
            points[:, 0], points[:, 1], points[:, 2], fmt="o", color=style.INK, markersize=3.5, markerfacecolor="white",
            markeredgewidth=0.9, elinewidth=0.8, zorder=3,
        )


def _draw(axes, curves: dict[str, tuple[np.ndarray, np.ndarray]], is_log: bool) -> None:
    ends = []
    for colour, (label, (time, values)) in zip(style.PALETTE, curves.items()):
        axes.plot(*style.decimate(time, np.where(values > 0, values, np.nan) if is_log else values), color=colour)
        if label:
            ends.append(((time[-1], values[-1]), label, colour))
    if is_log:
        axes.set_yscale("log")
        style.set_log_ticks(axes.yaxis)
    else:
        _keep_round_off_flat(axes, [values for _, values in curves.values()])
    style.label_curves(axes, ends)


def _keep_round_off_flat(axes, arrays: list[np.ndarray]) -> None:
    """Widens the range of curves that are constant up to round-off."""
    low = min(float(np.nanmin(values)) for values in arrays)
    high = max(float(np.nanmax(values)) for values in arrays)
    if high - low <= 1e-9 * max(abs(low), abs(high)):
        margin = 0.1 * max(abs(low), abs(high)) or 1.0
        axes.set_ylim(low - margin, high + margin)


def flow_history_figure(run: Run):
    """Figure; None if the history has fewer than two rows."""
    time = run.history.get("time")
    if time is None or len(time.values) < 2:
        return None
    panels = _panels(run)
    height = 1.0 + 1.45 * len(panels)
    figure, axes = plt.subplots(len(panels), 1, figsize=(5.2, height), sharex=True, squeeze=False)
    figure.subplots_adjust(left=0.16, right=0.8, top=1 - 0.9 / height, bottom=0.45 / height, hspace=0.5)
    expected = {name: expected_points(run, name) for name in ("kinetic_energy", "dissipation")}
    for panel, (title, curves, is_log) in zip(axes[:, 0], panels):
        panel.set_title(title)
        name = next((name for name in expected if title.startswith(name.replace("_", " "))), None)
        if name:
            _draw_expected(panel, expected[name])
        _draw(panel, curves, is_log)
    axes[-1, 0].set_xlabel("time (s)")
    legend = [("\u25cb", "expected, with tolerance", style.INK)] if any(map(len, expected.values())) else []
    style.heading(figure, run.name, f"history, {len(time.values)} rows{failure_caption(run.result)}", legend)
    return figure
