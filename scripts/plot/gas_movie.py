"""Moving picture of a gas run: the fields of every snapshot on the axes of the whole run."""

import numpy as np

from . import style
from .exact import errors
from .gas_figures import FieldPanel, View, details, key, set_range
from .style import plt

MAX_FRAMES = 100
_HEIGHT = 2.9
_DPI = 100


def frames(view: View):
    """Yields pictures as (height, width, 3) arrays of bytes, at most MAX_FRAMES evenly chosen snapshots."""
    snapshots = view.run.snapshots
    count = min(len(snapshots), MAX_FRAMES)
    chosen = [snapshots[k] for k in np.linspace(0, len(snapshots) - 1, count).round().astype(int)]
    columns = len(view.fields)
    width = max(3.7, 2.55 * columns + 0.4)
    figure, axes = plt.subplots(1, columns, figsize=(width, _HEIGHT), squeeze=False, dpi=_DPI)
    panels = []
    for name, panel in zip(view.fields, axes[0]):
        panels.append(FieldPanel(panel, view, name))
        panels[-1].show(chosen[-1])
        set_range(panel, name, [snapshot.fields[name].values for snapshot in snapshots])
        panel.set_xlabel(view.x_label)
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.48 / _HEIGHT), w_pad=1.4)
    shows_exact = bool(errors(view.run, snapshots[-1], view.exact))
    caption = style.heading(figure, view.run.name, "", key(view, shows_exact))

    # What stays is drawn once and copied: a frame costs only its curves.
    moving = [caption] + [artist for panel in panels for artist in panel.artists]
    for artist in moving:
        artist.set_animated(True)
    canvas = figure.canvas
    canvas.draw()
    background = canvas.copy_from_bbox(figure.bbox)
    for snapshot in chosen:
        canvas.restore_region(background)
        caption.set_text(details(view, snapshot.time))
        for panel in panels:
            panel.show(snapshot)
        for artist in moving:
            figure.draw_artist(artist)
        pixels = np.asarray(canvas.buffer_rgba())[..., :3]
        # Most MP4 players want even sizes.
        yield pixels[: pixels.shape[0] // 2 * 2, : pixels.shape[1] // 2 * 2].copy()
    plt.close(figure)
