"""Oblique views of surfaces: projection and shading."""

import numpy as np

_LIGHT = np.array([-0.4, -0.5, 0.77])


def oblique_projection(azimuth: float, elevation: float) -> np.ndarray:
    """Unit vectors to the right, up and towards a viewer (rows) at two angles, degrees: from x to y, and to z."""
    turn, lift = np.radians((azimuth, elevation))
    right = np.array([-np.sin(turn), np.cos(turn), 0])
    eye = np.array([np.cos(turn) * np.cos(lift), np.sin(turn) * np.cos(lift), np.sin(lift)])
    return np.array([right, np.cross(eye, right), eye])


def shade(corners: np.ndarray, colours: np.ndarray, darkest: float = 0.55, levels: int | None = None) -> np.ndarray:
    """Lambertian shading of RGBA colours, equal for both sides of a facet; corners (n, 3 or more, 3).

    `darkest` is the brightness of a facet along the light, `levels` the number of different ones if it is limited.
    """
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    facing = np.minimum(1, np.abs(normals @ _LIGHT) / np.where(lengths > 0, lengths, 1))
    if levels is not None:
        facing = np.round(facing * (levels - 1)) / (levels - 1)
    shaded = colours.copy()
    shaded[:, :3] *= (darkest + (1 - darkest) * facing)[:, None]
    return shaded
