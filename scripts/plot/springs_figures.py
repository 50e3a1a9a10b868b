"""Pictures of a run of drogue-springs: shaded cloth in the colours of its stress or displacement, strings as lines, bodies grey."""

from dataclasses import dataclass, field

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize, to_rgba

from . import springs_bodies, springs_strings, style
from .run_directory import Run, Snapshot
from .style import plt

MAX_FRAMES = 60
_SIZE = (5.2, 4.0)
_DPI = 100
_AXES = "xyz"
# Thinner than this share of its length, a body is drawn in its plane.
_FLAT = 0.02
# Percentile of all values at which the colours end.
_BRIGHT = 99.5
_AZIMUTH, _ELEVATION = np.radians(-65), np.radians(28)
_LIGHT = np.array([-0.4, -0.5, 0.77])
# Bodies are seen as far from the cloth as this share of its extent.
_BEYOND = 0.3
# Principal directions drawn at most, and the stress, over the largest, from which they mean something.
_MAX_DIRECTIONS = 1500
_LEAST_STRESS = 0.02


@dataclass
class View:
    """A run and the way in which it is looked at: along an axis, or from above and the side."""

    run: Run
    across: np.ndarray = field(init=False)  # rows: to the right, up, towards the eye
    labels: tuple[str, str] | None = field(init=False)
    bodies: np.ndarray = field(init=False)  # facets (n, 4, 3)

    def __post_init__(self):
        every = np.concatenate([self.positions(snapshot) for snapshot in self.run.snapshots])
        extent = np.ptp(every, axis=0)
        self.bodies = springs_bodies.facets(self.run.scene, every)
        thin = int(extent.argmin())
        self.labels = None
        if extent[thin] < _FLAT * extent.max():
            # x or y to the right, z or y upwards.
            shown = [axis for axis in range(3) if axis != thin]
            self.across = np.eye(3)[[*shown, thin]]
            self.labels = tuple(_AXES[axis] for axis in shown)
        else:
            right = np.array([-np.sin(_AZIMUTH), np.cos(_AZIMUTH), 0])
            eye = np.array([np.cos(_AZIMUTH) * np.cos(_ELEVATION), np.sin(_AZIMUTH) * np.cos(_ELEVATION), np.sin(_ELEVATION)])
            self.across = np.array([right, np.cross(eye, right), eye])

    @property
    def triangles(self) -> np.ndarray:
        return self.run.mesh["triangles"].values

    @property
    def strings(self) -> np.ndarray:
        return springs_strings.pieces(self.run.mesh)

    @property
    def quantity(self) -> tuple[str, str]:
        """Name and unit of what the colours mean."""
        if "von_mises" in self.run.snapshots[-1].fields:
            return "von Mises stress", "N/m"
        return "displacement", "m"

    def positions(self, snapshot: Snapshot) -> np.ndarray:
        moved = snapshot.fields.get("position")
        return self.run.mesh["vertices"].values if moved is None else moved.values

    def values(self, snapshot: Snapshot) -> np.ndarray:
        """What is coloured: a value a triangle, or of strings without cloth a piece."""
        if "von_mises" in snapshot.fields:
            return snapshot.fields["von_mises"].values
        stretched = 1 + self.run.scene.get("initial", {}).get("prestretch", 0.0)  # which would hide what a drum does
        moved = np.linalg.norm(self.positions(snapshot) - stretched * self.run.mesh["vertices"].values, axis=1)
        parts = self.triangles if len(self.triangles) else self.strings
        return moved[parts].mean(axis=1)

    def seen(self, snapshot: Snapshot) -> np.ndarray:
        """Coordinates to the right, up and towards the eye."""
        return self.positions(snapshot) @ self.across.T

    def directions(self, snapshot: Snapshot) -> np.ndarray:
        """Segments (n, 2, 2) along the larger principal stress, of flat cloth and where the run has them."""
        told = snapshot.fields.get("major_direction")
        if told is None or self.labels is None:
            return np.empty((0, 2, 2))
        every = -(-len(self.triangles) // _MAX_DIRECTIONS)
        corners = self.positions(snapshot)[self.triangles]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        half = 0.35 * np.sqrt(every * areas.mean()) * told.values
        values = self.values(snapshot)
        shown = (np.arange(len(half)) % every == 0) & (values > _LEAST_STRESS * np.nanmax(values))
        middle = corners.mean(axis=1)
        return (np.stack((middle - half, middle + half), axis=1)[shown] @ self.across.T)[:, :, :2]


def _shades(view: View, corners: np.ndarray, colours: np.ndarray) -> np.ndarray:
    """Colours darker where facets turn from the light; both sides look alike."""
    if view.labels is not None:
        return colours
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    facing = np.abs(normals @ _LIGHT) / np.where(lengths > 0, lengths, 1)
    shaded = colours.copy()
    shaded[:, :3] *= (0.55 + 0.45 * np.minimum(1, facing))[:, None]
    return shaded


class Picture:
    """A figure that can show one snapshot after another on the same axes and colours."""

    def __init__(self, view: View):
        self._view = view
        snapshots = view.run.snapshots
        self.figure, axes = plt.subplots(figsize=_SIZE, dpi=_DPI)
        values = np.concatenate([view.values(snapshot) for snapshot in snapshots])
        # A few triangles at a pull would leave all others dark.
        low, high = float(np.nanmin(values)), float(np.nanpercentile(values, _BRIGHT))
        self._map = plt.cm.ScalarMappable(Normalize(low, high if high > low else low + 1), "viridis")
        if len(view.triangles):
            self._parts = PolyCollection([], joinstyle="round")
            self._seams = springs_strings.along_cloth(view.strings, view.triangles)
        else:
            self._parts = LineCollection([], linewidth=2.2)
        colours = _shades(view, view.bodies, np.tile(springs_bodies.COLOUR, (len(view.bodies), 1)))
        self._bodies = (view.bodies @ view.across.T, colours)
        if not len(view.triangles):
            axes.add_collection(PolyCollection(self._bodies[0][..., :2], facecolors=colours, edgecolors=colours, linewidth=0.4))
        axes.add_collection(self._parts)
        self._directions = LineCollection([], linewidth=0.6, color="white")
        axes.add_collection(self._directions)
        low, high = self._range(np.concatenate([view.seen(snapshot)[:, :2] for snapshot in snapshots]))
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal")
        if view.labels is None:
            axes.axis("off")
        else:
            axes.set_xlabel(style.axis_label(view.labels[0], "m"))
            axes.set_ylabel(style.axis_label(view.labels[1], "m"))
        extend = "max" if np.nanmax(values) > self._map.norm.vmax else "neither"
        tolerance = self.figure.colorbar(self._map, ax=axes, shrink=0.8, pad=0.03, extend=extend)
        tolerance.set_label(style.axis_label(*view.quantity))
        tolerance.outline.set_visible(False)
        self.figure.subplots_adjust(left=0.14, right=0.94, top=0.86, bottom=0.12)
        self._caption = style.heading(self.figure, view.run.name, "")

    def _range(self, seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and highest places shown: all cloth, and bodies near it."""
        low, high = seen.min(axis=0), seen.max(axis=0)
        near = _BEYOND * np.max(high - low)
        if len(self._bodies[0]):
            corners = self._bodies[0][..., :2].reshape(-1, 2)
            lowest, highest = np.maximum(corners.min(axis=0), low - near), np.minimum(corners.max(axis=0), high + near)
            low, high = np.minimum(low, lowest), np.maximum(high, highest)
        margin = 0.04 * np.max(high - low)
        return low - margin, high + margin

    def show(self, snapshot: Snapshot) -> None:
        view = self._view
        seen, colours = view.seen(snapshot), self._map.to_rgba(view.values(snapshot))
        if len(view.triangles):
            bodies, body_colours = self._bodies
            # What is farther from the eye is painted first. Cloth that lies on a body is nearer by less than facets are
            # deep: of bodies the farthest corner counts, and they stand back by what a triangle reaches behind its middle.
            corners = seen[view.triangles]
            depths = corners[..., 2].mean(axis=1)
            back = np.max(depths - corners[..., 2].min(axis=1))
            ends = seen[view.strings]
            string_depths = springs_strings.depths(seen, view.strings, self._seams, view.triangles, depths)
            # Stable: strings come after cloth that is as near.
            order = np.concatenate((depths, bodies[..., 2].min(axis=1) - back, string_depths)).argsort(kind="stable")
            parts = [*corners[..., :2], *bodies[..., :2], *ends[..., :2]]
            shades = _shades(view, view.positions(snapshot)[view.triangles], colours)
            string_colours = np.tile(to_rgba(springs_strings.COLOUR), (len(ends), 1))
            colours = np.concatenate((shades, body_colours, string_colours))[order]
            self._parts.set_verts([parts[k] for k in order])
            self._parts.set_facecolor(colours)
            self._parts.set_edgecolor(colours)
            self._parts.set_linewidth(np.where(order < len(parts) - len(ends), 0.2, springs_strings.WIDTH))
            self._directions.set_segments(view.directions(snapshot))
        else:
            self._parts.set_segments(seen[view.strings, :2])
            self._parts.set_color(colours)
        count = len(view.run.mesh["vertices"].values)
        self._caption.set_text(f"{count} vertices, t = {snapshot.time:.4g} s{_checks(view.run)}")


def _checks(run: Run) -> str:
    """The first check, as the heading shows it."""
    checks = run.result.get("checks", [])
    if not checks or checks[0]["value"] is None:
        return ""
    check = checks[0]
    return f", {style.check_label(check['name'])} {check['value']:.2g} (tolerance {check['tolerance']:.2g})"


def figure(view: View, snapshot: Snapshot):
    picture = Picture(view)
    picture.show(snapshot)
    return picture.figure


def frames(view: View):
    """Yields pictures as (height, width, 3) arrays of bytes, at most MAX_FRAMES evenly chosen snapshots."""
    snapshots = view.run.snapshots
    count = min(len(snapshots), MAX_FRAMES)
    picture = Picture(view)
    for k in np.linspace(0, len(snapshots) - 1, count).round().astype(int):
        picture.show(snapshots[k])
        picture.figure.canvas.draw()
        pixels = np.asarray(picture.figure.canvas.buffer_rgba())[..., :3]
        # Most MP4 players want even sizes.
        yield pixels[: pixels.shape[0] // 2 * 2, : pixels.shape[1] // 2 * 2].copy()
    plt.close(picture.figure)
