"""Figures and animations of canopies: the cloth from the side, coloured by stress, and slices of the flow beside it."""

from dataclasses import dataclass, field

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize, to_rgba
from matplotlib.patches import Circle

from .. import shading, style
from ..checks import check_caption
from ..flow.plane import Plane
from ..flow.quantities import Quantity
from ..flow.slices_figure import SheetOutline, draw_slice
from ..flow.streamlines import Streamlines
from ..movie_file import drawn_frames
from ..run_directory import Snapshot, evenly_spaced
from ..style import plt
from .canopies import Canopies

MAX_FRAMES = 60
_DPI = 100
_AZIMUTH, _ELEVATION = -70, 14  # degrees; the vent and the opposite side of the lines stay visible
_BRIGHT = 99.0  # percentile of the stresses at the upper end of the colour scale if few are far larger
_DARKEST = 0.7  # brightness of cloth along the light
_PLAIN = np.array([0.80, 0.47, 0.28, 1.0])  # cloth without stress
_LINE_PARTS = 6  # of a suspension line, each with its own depth
_LINE, _CUT, _BODY = "#4A4A4A", "#D55E00", "#B8B8B8"
# Inches.
_HEIGHT, _LONG = 4.4, 4.4
_LEFT, _KEY, _KEY_GAP, _KEY_LABELS, _CLOTH_LEFT = 0.62, 0.11, 0.08, 0.62, 0.15
_ABOVE, _BELOW, _HEADING = 0.3, 0.45, 0.55
_KEY_TITLE = 0.7  # of the words above the key of the stress, beyond its labels
# Shown flow beside and behind the canopies, relative to their size.
_BESIDE, _BEHIND = 0.3, 1.0


@dataclass
class View:
    """Canopies, and quantities of the flow in a plane beside them; no plane and no quantities without a flow."""

    canopies: Canopies
    plane: Plane | None
    quantities: list[Quantity]
    projection: np.ndarray = field(init=False)

    def __post_init__(self):
        self.projection = shading.oblique_projection(_AZIMUTH, _ELEVATION)

    def caption(self, snapshot: Snapshot) -> str:
        """Vertices, cells, place of the plane, and time (s)."""
        count = len(self.canopies.run.canopy_mesh["vertices"].values)
        flow = f", {self.plane.at(snapshot).description}" if self.quantities else ""
        check = check_caption(self.canopies.run.result)
        return f"t = {snapshot.time:.2f} s, {count} vertices{flow}{check}"

    def window(self, snapshots: list[Snapshot]) -> tuple[float, float, float, float]:
        """Shown part of the plane, m: the canopies at all times and the flow around and, along z, behind them."""
        low, high = self.canopies.bounds(snapshots)
        size = np.max(high - low)
        before, behind = np.full(3, _BESIDE * size), np.array([_BESIDE, _BESIDE, _BEHIND]) * size
        ends = []
        for axis, (least, most) in zip(self.plane.across, np.reshape(self.plane.extent, (2, 2))):
            ends += [max(least, low[axis] - before[axis]), min(most, high[axis] + behind[axis])]
        return tuple(ends)


@dataclass(frozen=True)
class Colours:
    """Numbers of colours of the stress and of the flow, and of shades of the cloth (None: any)."""

    stress: int = 256
    flow: int = 256
    shades: int | None = None


# A GIF has 256 colours with those of the text.
_MOVIE_COLOURS = Colours(stress=32, flow=40, shades=4)


class CanopyFigure:
    """Figure that shows one snapshot at a time on fixed axes; colour scales fit all `snapshots`."""

    def __init__(self, view: View, snapshots: list[Snapshot], colours: Colours = Colours()):
        self._view, self._colours = view, colours
        self._panel = (0.0, 0.0)
        if view.quantities:
            window = view.window(snapshots)
            shape = (window[1] - window[0], window[3] - window[2])
            scale = min(_HEIGHT / shape[1], _LONG / shape[0])
            self._panel = (scale * shape[0], scale * shape[1])
        low, high = self._cloth_range(snapshots)
        cloth_height = max(self._panel[1], 0.75 * _HEIGHT) if view.quantities else _HEIGHT
        cloth_scale = min(cloth_height / (high[1] - low[1]), _LONG / (high[0] - low[0]))
        cloth_width = cloth_scale * (high[0] - low[0])
        has_stress = view.canopies.stress_units is not None
        cloth_cell = _CLOTH_LEFT + cloth_width + (_KEY_GAP + _KEY + _KEY_LABELS if has_stress else 0.1)
        cell = _LEFT + self._panel[0] + _KEY_GAP + _KEY + _KEY_LABELS
        if has_stress and not view.quantities:
            cloth_cell += _KEY_TITLE  # beyond the labels; beside a slice, there is room
        size = (cloth_cell + cell * len(view.quantities), _HEADING + _ABOVE + cloth_height + _BELOW)
        self.figure = plt.figure(figsize=size, dpi=_DPI)
        caption = max((view.caption(snapshot) for snapshot in snapshots), key=len)
        size = (max(size[0], style.subtitle_width(self.figure, caption)), size[1])
        self.figure.set_figwidth(size[0])

        def inches(x, y, w, h):
            return self.figure.add_axes((x / size[0], y / size[1], w / size[0], h / size[1]))

        self._add_cloth(inches(_CLOTH_LEFT, _BELOW, cloth_width, cloth_height), low, high)
        self._map = None
        if has_stress:
            left = _CLOTH_LEFT + cloth_width + _KEY_GAP
            key = inches(left, _BELOW + 0.2 * cloth_height, _KEY, 0.6 * cloth_height)
            self._add_stress(key, snapshots)
        self._slices, self._streamlines = [], []
        for k, quantity in enumerate(view.quantities):
            left = cloth_cell + k * cell + _LEFT
            axes = inches(left, _BELOW, *self._panel)
            key = inches(left + self._panel[0] + _KEY_GAP, _BELOW, _KEY, self._panel[1])
            self._slices.append(self._add_slice(axes, key, quantity, snapshots))
            axes.axis(window)
            if quantity.name == "speed":
                self._streamlines.append(Streamlines(axes, view.plane))
        self._caption = style.heading(self.figure, view.canopies.run.name, "")

    def _cloth_range(self, snapshots: list[Snapshot]) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner of the view of the canopies, m."""
        every = [self._projected(snapshot)[:, :2] for snapshot in snapshots]
        for centre, radius in self._spheres():
            place = (self._view.projection @ centre)[:2]
            every.append(np.stack((place - radius, place + radius)))
        low, high = np.concatenate(every).min(axis=0), np.concatenate(every).max(axis=0)
        margin = 0.04 * np.max(high - low)
        return low - margin, high + margin

    def _projected(self, snapshot: Snapshot) -> np.ndarray:
        """View coordinates (n, 3) of all vertices: to the right, up, and towards the viewer, m."""
        return self._view.canopies.positions(snapshot) @ self._view.projection.T

    def _spheres(self) -> list[tuple[np.ndarray, float]]:
        """Centres and radii, m, of the spheres beside the canopies; other bodies are not drawn."""
        bodies = self._view.canopies.run.scene.get("body", [])
        return [(np.array(body["centre"]), body["radius"]) for body in bodies if body["kind"] == "sphere"]

    def _add_cloth(self, axes, low: np.ndarray, high: np.ndarray) -> None:
        for centre, radius in self._spheres():
            axes.add_patch(Circle((self._view.projection @ centre)[:2], radius, facecolor=_BODY, zorder=0.5))
        self._parts = PolyCollection([], joinstyle="round")
        axes.add_collection(self._parts)
        (self._payloads,) = axes.plot([], [], "o", color=style.INK, markersize=5, zorder=3)
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.set_aspect("equal")
        axes.axis("off")

    def _add_stress(self, key, snapshots: list[Snapshot]) -> None:
        values = np.concatenate([self._view.canopies.stress(snapshot) for snapshot in snapshots])
        finite = values[np.isfinite(values)]
        high = style.scale_end(finite, _BRIGHT, float(finite.max())) if finite.size else 0.0
        self._map = plt.cm.ScalarMappable(Normalize(0, high or 1.0), plt.get_cmap("viridis", self._colours.stress))
        extend = "max" if finite.size and finite.max() > high else "neither"
        colorbar = self.figure.colorbar(self._map, cax=key, extend=extend, extendfrac=0.04)
        colorbar.outline.set_visible(False)
        key.set_title("von Mises stress\n" + f"({style.format_units(self._view.canopies.stress_units)})", pad=9)

    def _add_slice(self, axes, key, quantity: Quantity, snapshots: list[Snapshot]):
        image = draw_slice(axes, key, self._view.plane, quantity, snapshots, self._colours.flow)
        lines = LineCollection([], colors="black", linewidth=0.4, alpha=0.6, zorder=3)
        plane = self._view.plane
        spheres = [Circle(centre[list(plane.across)], radius, facecolor=_BODY, edgecolor=style.INK, zorder=2.5)
                   for centre, radius in self._spheres()]
        for circle in spheres:
            axes.add_patch(circle)
        outline = SheetOutline(axes, plane)
        cut = LineCollection([], colors=_CUT, linewidth=2.0, zorder=4, capstyle="round")
        axes.add_collection(lines, autolim=False)
        axes.add_collection(cut, autolim=False)
        (payloads,) = axes.plot([], [], "o", color="black", markersize=4.5, zorder=5)
        return quantity, image, outline, spheres, lines, cut, payloads

    def show(self, snapshot: Snapshot) -> None:
        """Replaces the drawn data by those of a snapshot."""
        canopies = self._view.canopies
        self._show_cloth(snapshot)
        positions = canopies.positions(snapshot)
        for quantity, image, outline, spheres, lines, cut, payloads in self._slices:
            outline.show(snapshot)
            plane = self._view.plane.at(snapshot)
            for circle, (centre, radius) in zip(spheres, self._spheres()):
                circle.set_radius(np.sqrt(max(radius**2 - (centre[plane.normal] - plane.place) ** 2, 0.0)))
            across = list(plane.across)
            image.set_data(plane.pixels(quantity.values(snapshot)))
            lines.set_segments(positions[canopies.lines][..., across])
            cut.set_segments(canopies.section(snapshot, plane.normal, plane.place)[..., across])
            payloads.set_data(*positions[canopies.payloads][:, across].T)
        for streamlines in self._streamlines:
            streamlines.show(snapshot)
        self._caption.set_text(self._view.caption(snapshot))

    def _show_cloth(self, snapshot: Snapshot) -> None:
        canopies, projected = self._view.canopies, self._projected(snapshot)
        if self._map is None:
            colours = np.tile(_PLAIN, (len(canopies.triangles), 1))
        else:
            colours = self._map.to_rgba(canopies.stress(snapshot))
        colours = shading.shade(
            canopies.positions(snapshot)[canopies.triangles], colours, _DARKEST, self._colours.shades
        )
        corners, ends = projected[canopies.triangles], projected[canopies.lines]
        part = np.linspace(0, 1, _LINE_PARTS + 1)[:, None, None]
        points = ends[:, 0] + part * (ends[:, 1] - ends[:, 0])
        pieces = np.stack((points[:-1], points[1:]), axis=2).reshape(-1, 2, 3)
        # Painter's algorithm.
        depths = np.concatenate([shapes[..., 2].mean(axis=1) for shapes in (corners, pieces)])
        order = depths.argsort(kind="stable")
        shapes = [*corners[..., :2], *pieces[..., :2]]
        colours = np.concatenate((colours, np.tile(to_rgba(_LINE), (len(pieces), 1))))[order]
        self._parts.set_verts([shapes[k] for k in order])
        self._parts.set_facecolor(colours)
        self._parts.set_edgecolor(colours)
        is_cloth = order < len(corners)
        self._parts.set_linewidth(np.where(is_cloth, 0.2, 0.6))
        # Mixed colours at the edges of triangles would fill the palette of a GIF.
        self._parts.set_antialiased(~is_cloth | (self._colours.shades is None))
        self._payloads.set_data(*projected[canopies.payloads, :2].T)


def canopy_figure(view: View, snapshot: Snapshot):
    """Figure of one snapshot."""
    drawing = CanopyFigure(view, [snapshot])
    drawing.show(snapshot)
    return drawing.figure


def frames(view: View):
    """Generator of frames, (height, width, 3) bytes each, of at most MAX_FRAMES evenly spaced snapshots."""
    chosen = evenly_spaced(view.canopies.run.snapshots, MAX_FRAMES)
    return drawn_frames(CanopyFigure(view, chosen, _MOVIE_COLOURS), chosen)
