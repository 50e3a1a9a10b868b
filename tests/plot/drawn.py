"""What tests ask of drogue-plot and of its figures."""

import contextlib
import io
from pathlib import Path

from folder_test import FolderTest
from matplotlib.text import Text
from plot import cli, style


def plot(*words):
    """Exit code, names of the files, standard error."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = cli.main([str(word) for word in words])
    return code, sorted(Path(line).name for line in out.getvalue().split("\n") if line), err.getvalue()


def texts_of(figure):
    """The texts that a figure shows: matplotlib keeps labels of ticks beyond the ends of their axis, and does not draw them."""
    figure.canvas.draw()
    hidden = set()
    for axis in (axis for axes in figure.axes for axis in (axes.xaxis, axes.yaxis)):
        low, high = sorted(axis.get_view_interval())
        hidden |= {tick.label1 for tick in axis.get_major_ticks() if not low <= tick.get_loc() <= high}
    return [text for text in figure.findobj(Text)
            if text.get_visible() and text.get_text() and text not in hidden and text.axes in (None, *figure.axes)]


class PictureTest(FolderTest):
    """Test case with an empty folder, whose figures are closed after it."""

    def setUp(self):
        super().setUp()
        self.addCleanup(style.plt.close, "all")

    def pictures(self, run):
        return {file.name for file in run.iterdir() if file.suffix in (".png", ".gif")}

    def refusal(self, run, *words):
        """Standard error of drogue-plot, which must end with exit code 2 and draw nothing."""
        code, _, errors = plot(run, *words)
        self.assertEqual(2, code)
        self.assertEqual(set(), self.pictures(run))
        return errors

    def assert_apart(self, texts, bounds):
        """Asserts that texts lie within a box and do not overlap; returns their boxes."""
        boxes = [text.get_window_extent() for text in texts]
        for k, box in enumerate(boxes):
            words = texts[k].get_text()
            self.assertTrue(bounds.x0 <= box.x0 and bounds.y0 <= box.y0, words)
            self.assertTrue(box.x1 <= bounds.x1 and box.y1 <= bounds.y1, words)
            for other, text in zip(boxes[:k], texts):
                self.assertFalse(box.overlaps(other), (words, text.get_text()))
        return boxes
