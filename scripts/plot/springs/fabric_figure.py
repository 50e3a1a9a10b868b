"""Figures of a drogue-springs run: cloth coloured by stress or displacement, strings, and contact bodies."""

from dataclasses import dataclass, field

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize, to_rgba

from .. import shading, style
from ..checks import check_caption
from ..movie_file import drawn_frames
from ..run_directory import Run, Snapshot, evenly_spaced
from ..style import plt
from . import bodies, strings

MAX_FRAMES = 60
_SIZE = (5.2, 4.0)
_DPI = 100
_AXES = "xyz"
_FLAT = 0.02  # ratio of extents below which the mesh is drawn in its plane
_BRIGHT = 99.5  # percentile of all values at the upper end of the colour scale if few are far larger
_MOVIE_COLOURS, _MOVIE_SHADES = 48, 4  # a GIF has 256 colours with those of the text
_AZIMUTH, _ELEVATION = -65, 28  # degrees
_BODY_MARGIN = 0.3  # distance from the cloth up to which bodies are shown, relative to its extent
_MAX_DIRECTIONS = 1500  # largest number of principal directions that are drawn
_LEAST_STRESS = 0.02  # relative to the largest stress; below it principal directions are not drawn


@dataclass
class View:
    """A run and its projection: along an axis for flat meshes, else oblique from above."""

    run: Run
    projection: np.ndarray = field(init=False)  # rows: unit vectors to the right, up, and towards the viewer
    labels: tuple[str, str] | None = field(init=False)
    body_facets: np.ndarray = field(init=False)  # (n, 4, 3), m

    def __post_init__(self):
        every = np.concatenate([self.positions(snapshot) for snapshot in self.run.snapshots])
        extent = np.ptp(every, axis=0)
        self.body_facets = bodies.facets(self.run.scene, every)
        thin = int(extent.argmin())
        self.labels = None
        if extent[thin] < _FLAT * extent.max():
            # x or y points to the right, z or y upwards.
            shown = [axis for axis in range(3) if axis != thin]
            self.projection = np.eye(3)[[*shown, thin]]
            self.labels = tuple(_AXES[axis] for axis in shown)
        else:
            self.projection = shading.oblique_projection(_AZIMUTH, _ELEVATION)

    @property
    def triangles(self) -> np.ndarray:
        return self.run.mesh["triangles"].values

    @property
    def segments(self) -> np.ndarray:
        """Vertex pairs (n, 2) of the string segments."""
        return strings.segments(self.run.mesh)

    @property
    def quantity(self) -> tuple[str, str]:
        """Name and unit of the quantity shown by colour."""
        if "von_mises" in self.run.snapshots[-1].fields:
            return "von Mises stress", "N/m"
        return "displacement", "m"

    def positions(self, snapshot: Snapshot) -> np.ndarray:
        """Vertex positions (n, 3), m."""
        moved = snapshot.fields.get("position")
        return self.run.mesh["vertices"].values if moved is None else moved.values

    def values(self, snapshot: Snapshot) -> np.ndarray:
        """Values of the coloured quantity, one per triangle, or per string segment if there is no cloth."""
        if "von_mises" in snapshot.fields:
            return snapshot.fields["von_mises"].values
        # Displacements are relative to the prestretched mesh, whose stretch would hide small deflections.
        stretched = 1 + self.run.scene.get("initial", {}).get("prestretch", 0.0)
        moved = np.linalg.norm(self.positions(snapshot) - stretched * self.run.mesh["vertices"].values, axis=1)
        parts = self.triangles if len(self.triangles) else self.segments
        return moved[parts].mean(axis=1)

    def projected(self, snapshot: Snapshot) -> np.ndarray:
        """View coordinates (n, 3): to the right, up, and towards the viewer, m."""
        return self.positions(snapshot) @ self.projection.T

    def stress_directions(self, snapshot: Snapshot) -> np.ndarray:
        """Segments (n, 2, 2) along the larger principal stress; none for cloth that is not flat."""
        major = snapshot.fields.get("major_direction")
        if major is None or self.labels is None:
            return np.empty((0, 2, 2))
        every = -(-len(self.triangles) // _MAX_DIRECTIONS)
        corners = self.positions(snapshot)[self.triangles]
        areas = (np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2)
        half = 0.35 * np.sqrt(every * areas.mean()) * major.values
        values = self.values(snapshot)
        shown = (np.arange(len(half)) % every == 0) & (values > _LEAST_STRESS * np.nanmax(values))
        middle = corners.mean(axis=1)
        return (np.stack((middle - half, middle + half), axis=1)[shown] @ self.projection.T)[:, :, :2]


class FabricFigure:
    """Figure that shows one snapshot at a time; axes and colour scale fit all `snapshots`.

    `colours` and `shades` limit the numbers of colours and of their brightnesses (None: any).
    """

    def __init__(self, view: View, snapshots: list[Snapshot], colours: int = 256, shades: int | None = None):
        self._view, self._levels = view, shades
        self.figure, axes = plt.subplots(figsize=_SIZE, dpi=_DPI)
        values = np.concatenate([view.values(snapshot) for snapshot in snapshots])
        # A percentile, since a few highly stressed triangles would leave all others dark.
        finite = values[np.isfinite(values)]
        low = float(finite.min())
        high = style.scale_end(finite, _BRIGHT, float(finite.max()), low)
        colour_map = plt.get_cmap("viridis", colours)
        self._map = plt.cm.ScalarMappable(Normalize(low, high if high > low else low + 1), colour_map)
        if len(view.triangles):
            self._parts = PolyCollection([], joinstyle="round")
            self._seams = strings.lie_along_cloth(view.segments, view.triangles)
        else:
            self._parts = LineCollection([], linewidth=2.2)
        colours = self._shades(view.body_facets, np.tile(bodies.COLOUR, (len(view.body_facets), 1)))
        self._bodies = (view.body_facets @ view.projection.T, colours)
        if not len(view.triangles):
            axes.add_collection(
                PolyCollection(self._bodies[0][..., :2], facecolors=colours, edgecolors=colours, linewidth=0.4)
            )
        axes.add_collection(self._parts)
        # Cloth may hide a body altogether.
        outlines = bodies.outlines(view.run.scene, view.projection) if len(view.triangles) else []
        axes.add_collection(LineCollection(outlines, linewidth=0.9, linestyle=(0, (4, 3)), color=style.INK, zorder=4), autolim=False)
        self._directions = LineCollection([], linewidth=0.6, color="white")
        axes.add_collection(self._directions)
        low, high = self._range(np.concatenate([view.projected(snapshot)[:, :2] for snapshot in snapshots]))
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal")
        if view.labels is None:
            axes.axis("off")
        else:
            axes.set_xlabel(style.axis_label(view.labels[0], "m"))
            axes.set_ylabel(style.axis_label(view.labels[1], "m"))
        extend = "max" if np.nanmax(values) > self._map.norm.vmax else "neither"
        colorbar = self.figure.colorbar(self._map, ax=axes, shrink=0.8, pad=0.03, extend=extend)
        colorbar.set_label(style.axis_label(*view.quantity))
        colorbar.outline.set_visible(False)
        self.figure.subplots_adjust(left=0.14, right=0.94, top=0.86, bottom=0.12)
        legend = [("- -", "outline of a body", style.INK)] if outlines else []
        self._caption = style.heading(self.figure, view.run.name, "", legend)

    def _range(self, projected: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner of the shown region: all cloth, and the bodies near it."""
        low, high = projected.min(axis=0), projected.max(axis=0)
        near = _BODY_MARGIN * np.max(high - low)
        if len(self._bodies[0]):
            corners = self._bodies[0][..., :2].reshape(-1, 2)
            lowest, highest = (
                np.maximum(corners.min(axis=0), low - near),
                np.minimum(corners.max(axis=0), high + near),
            )
            low, high = np.minimum(low, lowest), np.maximum(high, highest)
        margin = 0.04 * np.max(high - low)
        return low - margin, high + margin

    def _shades(self, corners: np.ndarray, colours: np.ndarray) -> np.ndarray:
        """Shading of RGBA colours; none for flat meshes."""
        return colours if self._view.labels is not None else shading.shade(corners, colours, levels=self._levels)

    def show(self, snapshot: Snapshot) -> None:
        """Replaces the drawn data by those of a snapshot."""
        view = self._view
        projected, colours = view.projected(snapshot), self._map.to_rgba(view.values(snapshot))
        if len(view.triangles):
            facets, body_colours = self._bodies
            # Painter's algorithm. Cloth that lies on a body is nearer by less than the depth of a facet. So the depth
            # of a body facet is that of its farthest corner, less the depth of a triangle behind its centroid.
            corners = projected[view.triangles]
            depths = corners[..., 2].mean(axis=1)
            back = np.max(depths - corners[..., 2].min(axis=1))
            ends = projected[view.segments]
            string_depths = strings.depths(projected, view.segments, self._seams, view.triangles, depths)
            # A stable sort, so that strings are drawn after cloth of equal depth.
            order = np.concatenate((depths, facets[..., 2].min(axis=1) - back, string_depths)).argsort(kind="stable")
            parts = [*corners[..., :2], *facets[..., :2], *ends[..., :2]]
            shades = self._shades(view.positions(snapshot)[view.triangles], colours)
            string_colours = np.tile(to_rgba(strings.COLOUR), (len(ends), 1))
            colours = np.concatenate((shades, body_colours, string_colours))[order]
            self._parts.set_verts([parts[k] for k in order])
            self._parts.set_facecolor(colours)
            self._parts.set_edgecolor(colours)
            self._parts.set_linewidth(np.where(order < len(parts) - len(ends), 0.2, strings.WIDTH))
            self._directions.set_segments(view.stress_directions(snapshot))
        else:
            self._parts.set_segments(projected[view.segments, :2])
            self._parts.set_color(colours)
        count = len(view.run.mesh["vertices"].values)
        self._caption.set_text(f"{count} vertices, t = {snapshot.time:.4g} s{check_caption(view.run.result)}")


def fabric_figure(view: View, snapshot: Snapshot):
    """Figure of one snapshot."""
    drawing = FabricFigure(view, [snapshot])
    drawing.show(snapshot)
    return drawing.figure


def frames(view: View):
    """Generator of frames, (height, width, 3) bytes each, of at most MAX_FRAMES evenly spaced snapshots."""
    chosen = evenly_spaced(view.run.snapshots, MAX_FRAMES)
    return drawn_frames(FabricFigure(view, chosen, _MOVIE_COLOURS, _MOVIE_SHADES), chosen)
