"""Strings of a mesh, and where they are painted among its cloth."""

import numpy as np

from .style import PALETTE

# Vermilion: cloth has all of viridis, bodies are grey, the ground is white.
COLOUR = PALETTE[1]
WIDTH = 1.4


def pieces(mesh) -> np.ndarray:
    """Vertices (n, 2) of every piece of a string. In a file without `strings` all edges are, unless there is cloth."""
    if "strings" in mesh:
        return mesh["strings"].values
    return np.empty((0, 2), int) if len(mesh["triangles"].values) else mesh["edges"].values


def along_cloth(strings: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Whether each lies along an edge of a triangle, as a seam does."""
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    ends = np.sort(np.concatenate((strings, edges)), axis=1)
    number = np.unique(ends, axis=0, return_inverse=True)[1].reshape(-1)
    return np.isin(number[: len(strings)], number[len(strings) :])


def depths(seen: np.ndarray, strings: np.ndarray, seams: np.ndarray, triangles: np.ndarray, cloth: np.ndarray) -> np.ndarray:
    """How near each is to the eye: as its middle, or, of a seam, as the nearest triangle at its ends, so that none paints over it."""
    nearest = np.full(len(seen), -np.inf)
    np.maximum.at(nearest, triangles, cloth[:, None])
    return np.where(seams, nearest[strings].max(axis=1), seen[strings, 2].mean(axis=1))
