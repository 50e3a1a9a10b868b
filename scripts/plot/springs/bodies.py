"""Surfaces of the contact bodies of a springs scene as small facets, to be depth-sorted with the cloth."""

import numpy as np

from ..expression import evaluate

_FACETS = 24  # facets along a diameter
COLOUR = np.array([0.74, 0.73, 0.71, 1.0])


def _frame(normal) -> np.ndarray:
    """Orthonormal frame; its third row is the unit vector along `normal`."""
    axis = np.asarray(normal, float) / np.linalg.norm(normal)
    first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(axis, first), axis])


def _quads(grid: np.ndarray) -> np.ndarray:
    """Facets (n, 4, 3) of a structured grid of points (i, j, 3)."""
    corners = (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:])
    return np.stack(corners, axis=2).reshape(-1, 4, 3)


def _disk(body) -> np.ndarray:
    radius, angle = (np.linspace(0, body["radius"], _FACETS // 2 + 1), np.linspace(0, 2 * np.pi, 2 * _FACETS + 1))
    across = np.stack(np.broadcast_arrays(np.cos(angle), np.sin(angle), 0 * angle), axis=-1)
    return _quads(body["centre"] + (radius[:, None, None] * across) @ _frame(body["normal"]))


def _sphere(body) -> np.ndarray:
    height, angle = np.meshgrid(
        np.linspace(0, np.pi, _FACETS + 1), np.linspace(0, 2 * np.pi, 2 * _FACETS + 1), indexing="ij"
    )
    out = np.stack((np.sin(height) * np.cos(angle), np.sin(height) * np.sin(angle), np.cos(height)), axis=-1)
    return _quads(body["centre"] + body["radius"] * out)


def _plane(body, points: np.ndarray) -> np.ndarray:
    """Square part of a plane below the bounding box of `points`, enlarged by a fifth."""
    frame = _frame(body["normal"])
    flat = (points - body["centre"]) @ frame[:2].T
    middle, half = (flat.min(axis=0) + flat.max(axis=0)) / 2, 0.6 * np.ptp(flat, axis=0).max()
    along, across = (np.linspace(m - half, m + half, _FACETS + 1) for m in middle)
    grid = np.stack(np.meshgrid(along, across, indexing="ij"), axis=-1)
    return _quads(body["centre"] + grid @ frame[:2])


def _level_set(body, points: np.ndarray) -> np.ndarray:
    """Part of a level set around `points` by surface nets (Gibson 1998).

    Each lattice cell that the surface crosses holds a corner, the mean of the intersections with the edges of the
    cell. Each edge that the surface crosses gives a facet.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    half = 0.8 * np.max(high - low)
    origin, step = (low + high) / 2 - half, half / _FACETS
    count = 2 * _FACETS + 1
    x, y, z = (origin[:, None] + step * np.arange(count)).reshape(3, count)
    with np.errstate(all="ignore"):
        value = evaluate(body["expression"], x=x[:, None, None], y=y[:, None], z=z)
    inside = value < 0
    sums, cuts = np.zeros((count, count, count, 3)), np.zeros((count, count, count, 1))
    across = []
    for axis, unit in enumerate(np.eye(3, dtype=int)):
        edges = np.argwhere(np.diff(inside, axis=axis))
        below, above = value[tuple(edges.T)], value[tuple((edges + unit).T)]
        # Next to a value that is not finite, the surface is assumed at half a lattice step.
        part = np.where(np.isfinite(below - above), below / (below - above), 0.5)
        first, second = np.eye(3, dtype=int)[[axis - 2, axis - 1]]
        about = np.stack([edges, edges - first, edges - first - second, edges - second], axis=1)
        across.append(about[(edges[:, [axis - 2, axis - 1]] > 0).all(axis=1) & (edges < count - 1).all(axis=1)])
        for k in range(4):
            cell = tuple(about[:, k].T)
            np.add.at(sums, cell, edges + part[:, None] * unit)
            np.add.at(cuts, cell, 1)
    with np.errstate(invalid="ignore"):
        corners = origin + step * sums / cuts
    return corners[tuple(np.moveaxis(np.concatenate(across), -1, 0))]


def outlines(scene: dict, projection: np.ndarray) -> list[np.ndarray]:
    """Outlines (n, 2) of the disks and spheres of a scene, as `projection` (rows: right, up, towards the viewer) shows them, m."""
    angle = np.linspace(0, 2 * np.pi, 8 * _FACETS + 1)
    circle = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    axes = {"disk": lambda body: _frame(body["normal"])[:2], "sphere": lambda _: projection[:2]}
    return [
        (body["centre"] + body["radius"] * circle @ axes[body["kind"]](body)) @ projection[:2].T
        for body in scene.get("contact", {}).get("objects", [])
        if body["kind"] in axes
    ]


def facets(scene: dict, points: np.ndarray) -> np.ndarray:
    """Facets (n, 4, 3) of all contact bodies of a resolved scene; `points` (n, 3) are positions of the cloth, m."""
    make = {
        "disk": _disk, "sphere": _sphere, "plane": lambda body: _plane(body, points),
        "level-set": lambda body: _level_set(body, points),
    }
    bodies = scene.get("contact", {}).get("objects", [])
    return np.concatenate([make[body["kind"]](body) for body in bodies] or [np.empty((0, 4, 3))])
