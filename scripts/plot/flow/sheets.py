"""Bodies and flags in a plane of the flow."""

import numpy as np

from ..run_directory import Run, Snapshot


def section(corners: np.ndarray, axis: int, place: float) -> np.ndarray:
    """Segments (n, 2, 3) in which triangles (m, 3, 3) meet the plane at `place` on an axis, m."""
    height = corners[..., axis] - place
    # A vertex in the plane counts as above it, so that a cut triangle has exactly two cut edges.
    above = height >= 0
    cut = above.any(axis=1) & ~above.all(axis=1)
    corners, height, above = corners[cut], height[cut], above[cut]
    following = [1, 2, 0]
    crosses = above != above[:, following]
    part = height / np.where(crosses, height - height[:, following], 1)
    points = corners + part[..., None] * (corners[:, following] - corners)
    return points[crosses].reshape(-1, 2, 3)


def sheet_section(run: Run, snapshot: Snapshot, axis: int, place: float) -> np.ndarray:
    """Segments (n, 2, 3) in which bodies and flags meet the plane at `place` on an axis, m."""
    segments = [np.empty((0, 2, 3))]
    for name, mesh in run.sheet_meshes.items():
        positions = snapshot.sheets.get(name, {}).get("position", mesh["vertices"]).values
        segments.append(section(positions[mesh["triangles"].values], axis, place))
    return np.concatenate(segments)
