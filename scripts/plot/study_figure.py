"""Figure of a study: error against time and against mesh, one curve per scheme."""

import difflib

import numpy as np

from . import style
from .checks import INVARIANTS
from .failure import IO_ERROR, USAGE, Failure
from .run_directory import Run
from .style import plt

# L1 errors are sums of |error| dx (unit of the field times m); cauchy_* are time averages of the difference
# between a mesh and the next finer one.
TITLES = {
    "l1_density": "L1 error of density (kg/m$^2$)", "l1_velocity": "L1 error of velocity (m$^2$/s)",
    "l1_pressure": "L1 error of pressure (Pa m)",
    "cauchy_length": "difference of length to the next mesh (m)",
    "cauchy_area": "difference of area to the next mesh (m$^2$)",
    "cauchy_kinetic": "difference of kinetic energy to the next mesh (J)",
    "cauchy_elastic": "difference of elastic energy to the next mesh (J)",
}
# Errors of flow are means over faces or cells, with the unit of the field.
_FLOW_TITLES = {
    "l1_velocity": "mean error of velocity (m/s)", "l2_velocity": "rms error of velocity (m/s)",
    "linf_velocity": "largest error of velocity (m/s)", "l2_pressure": "rms error of pressure (Pa)",
}
_FLOW_WORDS = {"weno-js": "WENO-JS", "weno-z": "WENO-Z", "ab2": "AB2", "rk3": "RK3"}
SCHEMES = {"js": "WENO-JS", "z": "WENO-Z", "z2": "WENO-Z (p = 2)", "m": "WENO-M", "teno5": "TENO5"}


def _display_label(label: str) -> str:
    """Label of a study row, such as `z2 lf-global` or `weno-z ab2`, with the display names of its schemes."""
    scheme, *settings = label.split(" ")
    words = [SCHEMES.get(scheme, scheme), *settings]
    return " ".join(_FLOW_WORDS.get(word, word) for word in words)


def _is_flow(rows: list[dict[str, str]]) -> bool:
    return "advection" in rows[0]


def _title(rows: list[dict[str, str]], norm: str) -> str:
    """Axis label of an error column."""
    titles = TITLES | (_FLOW_TITLES if _is_flow(rows) else {})
    return titles.get(norm, "error of " + norm.replace("_", " "))


def _norms(rows: list[dict[str, str]]) -> list[str]:
    """Error columns of a study: those between `compute_s` and `status`, less observed orders."""
    columns = list(rows[0])
    columns = columns[columns.index("compute_s") + 1 : columns.index("status")]
    return [column for column in columns if not column.startswith("order_")]


def default_norm(rows: list[dict[str, str]]) -> str:
    """First non-empty error column that converges with the mesh, for flow the rms of the velocity if it is not empty.

    If no column converges, the first non-empty one.
    """
    try:
        norms = _norms(rows)
    except ValueError:
        return ""
    norms = [norm for norm in norms if any(row[norm] for row in rows)] or norms
    if _is_flow(rows) and "l2_velocity" in norms:
        return "l2_velocity"
    return next((norm for norm in norms if norm not in INVARIANTS), norms[0] if norms else "")


def _mesh_column(rows: list[dict[str, str]]) -> str:
    return "vertices" if "vertices" in rows[0] else "cells"


def _dimension(rows: list[dict[str, str]]) -> int:
    """Number of axes of mesh refinement: 2 for cloth, whose vertex count is quadratic in the edges per axis."""
    return 2 if "cauchy_area" in rows[0] else 1


def _curves(rows: list[dict[str, str]], norm: str) -> tuple[dict[str, np.ndarray], list[str]]:
    """Arrays of (mesh, seconds, error) by label, ordered by mesh, and descriptions of the omitted rows."""
    curves: dict[str, list[tuple[float, float, float]]] = {}
    failed = exact = finest = 0
    for row in rows:
        if row.get("status") != "ok":
            failed += 1
            continue
        if row[norm] == "" and row["compute_s"] != "":
            finest += 1
            continue
        point = tuple(float(row[column]) for column in (_mesh_column(rows), "compute_s", norm))
        if point[2] > 0:
            curves.setdefault(_display_label(row["label"]), []).append(point)
        else:
            exact += 1
    omitted = [f"{failed} of {len(rows)} runs failed"] if failed else []
    omitted += [f"{exact} of {len(rows)} have error 0"] if exact else []
    if finest and not curves:  # its finest mesh has no Cauchy error
        omitted.append(f"{finest} of {len(rows)} have no finer mesh to be compared with and nothing to verify")
    return {label: np.array(sorted(points)) for label, points in curves.items()}, omitted


def check_norm(run: Run, norm: str) -> None:
    """Raises Failure (USAGE) unless the run has a study with the error column `norm`."""
    if not run.study:
        raise Failure(USAGE, f"{run.path} holds no study, which --norm is for.")
    norms = _norms(run.study)
    if norm not in norms:
        near = difflib.get_close_matches(norm, norms, 1)
        hint = f"nearest is {near[0]}" if near else f"it has {', '.join(norms)}"
        raise Failure(USAGE, f"The study of {run.scene_name} has no norm '{norm}'; {hint}.")


def observed_order(points: np.ndarray, dimension: int = 1) -> float | None:
    """Least-squares order of (mesh, seconds, error) in the mesh width; None for fewer than three meshes."""
    if len(points) < 3:
        return None
    return -dimension * np.polyfit(np.log(points[:, 0]), np.log(points[:, 2]), 1)[0]


def _order(points: np.ndarray, dimension: int) -> str:
    order = observed_order(points, dimension)
    return "" if order is None else f"  order {order:.2f}"


def _draw(axes, curves, column: int, labels: dict[str, str]) -> None:
    ends = []
    for index, (label, points) in enumerate(curves.items()):
        colour = style.PALETTE[index % len(style.PALETTE)]
        marker = "osD^vP*X"[index % 8]
        axes.plot(
            points[:, column], points[:, 2], "-" + marker, color=colour, markersize=4, markerfacecolor="white",
            markeredgewidth=1.1, linewidth=1.2,
        )
        if label in labels:
            ends.append(((points[-1, column], points[-1, 2]), labels[label], colour))
    axes.set_xscale("log")
    axes.set_yscale("log")
    style.set_log_ticks(axes.yaxis)
    style.label_curves(axes, ends)


def _fit_labels(figure, labels: list[str]) -> None:
    """Sizes a figure of two axes such that the labels fit at its right."""
    left, axes_width, bottom, top = 0.82, 5.66, 0.5, 0.72
    width = (left + axes_width + 0.2 + max(style.text_width(figure, words, style.LABEL_SIZE) for words in labels))
    axes_height = max(2.38, style.LABEL_STEP * len(labels))
    height = bottom + axes_height + top
    figure.set_size_inches(width, height)
    figure.subplots_adjust(
        left=left / width, right=(left + axes_width) / width, bottom=bottom / height, top=1 - top / height,
        wspace=0.1,
    )


def study_figure(name: str, rows: list[dict[str, str]], norm: str = ""):
    """Figure with error against time (left) and error against mesh with observed orders (right).

    Raises Failure: USAGE for an unknown norm, IO_ERROR if no row can be drawn.
    """
    norm = norm or (default_norm(rows) if rows else "")
    if rows and norm not in rows[0]:
        raise Failure(USAGE, f"The study of {name} has no column '{norm}'; it has {', '.join(rows[0])}.")
    try:
        curves, omitted = _curves(rows, norm)
    except (KeyError, TypeError, ValueError) as error:
        raise Failure(IO_ERROR, f"The study of {name} has a row that cannot be read: {error}.") from None
    if not curves:
        raise Failure(IO_ERROR, f"The study of {name} has nothing to draw: {' and '.join(omitted) or 'it is empty'}.")
    figure, (by_time, by_mesh) = plt.subplots(1, 2, sharey=True)
    labels = {
        label: label if norm in INVARIANTS else label + _order(points, _dimension(rows))
        for label, points in curves.items()
    }
    _fit_labels(figure, list(labels.values()))
    _draw(by_time, curves, 1, {})
    style.set_log_ticks(by_time.xaxis)
    _draw(by_mesh, curves, 0, labels)
    by_time.set_ylabel(_title(rows, norm))
    by_time.set_xlabel("time to solution (s)")
    by_mesh.set_xlabel("cells along the longest axis" if _is_flow(rows) else _mesh_column(rows))
    meshes = np.unique(np.concatenate([points[:, 0] for points in curves.values()]))
    if len(meshes) <= 8:
        by_mesh.set_xticks(meshes, [f"{int(mesh)}" for mesh in meshes])
        by_mesh.minorticks_off()
    else:
        style.set_log_ticks(by_mesh.xaxis)
    for axes in (by_time, by_mesh):
        style.thin_labels(axes)
    backends = sorted({row.get("backend", "") for row in rows} - {""})
    details = "error against time and mesh" + (f", {', '.join(backends)}" if backends else "")
    if omitted:
        details += f"; not drawn: {', '.join(omitted)}"
    style.heading(figure, name, details)
    return figure
