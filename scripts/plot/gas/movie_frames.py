"""Animation of a gas run: the fields of each snapshot on axes that fit the whole run."""

from .. import style
from ..movie_file import frame_of
from ..run_directory import evenly_spaced
from ..style import plt
from .exact_solution import pointwise_errors
from .fields_figure import FieldPanel, View, legend, set_range, subtitle

MAX_FRAMES = 100
_HEIGHT = 2.9
_DPI = 100


def frames(view: View):
    """Generator of frames, (height, width, 3) bytes each, of at most MAX_FRAMES evenly spaced snapshots."""
    snapshots = view.run.snapshots
    chosen = evenly_spaced(snapshots, MAX_FRAMES)
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
    shows_exact = bool(pointwise_errors(view.run, snapshots[-1], view.exact))
    caption = style.heading(figure, view.run.name, "", legend(view, shows_exact))

    # The static background is drawn once and copied, so that a frame costs only its curves.
    moving = [caption] + [artist for panel in panels for artist in panel.artists]
    for artist in moving:
        artist.set_animated(True)
    canvas = figure.canvas
    canvas.draw()
    background = canvas.copy_from_bbox(figure.bbox)
    for snapshot in chosen:
        canvas.restore_region(background)
        caption.set_text(subtitle(view, snapshot.time))
        for panel in panels:
            panel.show(snapshot)
        for artist in moving:
            figure.draw_artist(artist)
        yield frame_of(canvas)
    plt.close(figure)
