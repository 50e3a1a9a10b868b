"""Strings of a mesh, and their drawing order relative to the cloth."""

import numpy as np

from ..style import PALETTE

COLOUR = PALETTE[1]  # vermilion, distinct from viridis (cloth), grey (bodies) and white (background)
WIDTH = 1.4


def segments(mesh) -> np.ndarray:
    """Vertex pairs (n, 2) of all string segments: `mesh/strings`, else all edges of a mesh without triangles."""
    if "strings" in mesh:
        return mesh["strings"].values
    return np.empty((0, 2), int) if len(mesh["triangles"].values) else mesh["edges"].values


def lie_along_cloth(strings: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Mask of the segments that coincide with an edge of a triangle, as seams do."""
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    ends = np.sort(np.concatenate((strings, edges)), axis=1)
    number = np.unique(ends, axis=0, return_inverse=True)[1].reshape(-1)
    return np.isin(number[: len(strings)], number[len(strings) :])


def depths(
    projected: np.ndarray, strings: np.ndarray, seams: np.ndarray, triangles: np.ndarray, cloth: np.ndarray
) -> np.ndarray:
    """Depth of each segment: that of its midpoint, for a seam that of the nearest triangle at its ends.

    `projected` holds view coordinates (n, 3), `cloth` the depths of the triangles; larger is nearer to the viewer.
    """
    nearest = np.full(len(projected), -np.inf)
    np.maximum.at(nearest, triangles, cloth[:, None])
    return np.where(seams, nearest[strings].max(axis=1), projected[strings, 2].mean(axis=1))
