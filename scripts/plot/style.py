"""Style of all figures: light, legible at the width of one journal column, and colour-blind safe."""

import contextlib
import os
import re
from pathlib import Path

from .plain_matplotlib import matplotlib  # before all that imports matplotlib  isort: skip
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from PIL import Image

from .failure import IO_ERROR, Failure
from .program import at_signal

# Okabe and Ito (2008), ordered such that neighbours also differ in lightness.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#5B4A9C", "#7A7A7A")
INK = "#222222"
MUTED = "#6B6B6B"
GRID = "#E4E4E4"
RUN_COLOUR = PALETTE[0]
ERROR_COLOUR = PALETTE[1]

matplotlib.rcParams.update(
    {
        "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "mathtext.fontset": "dejavusans",
        "font.size": 8.5, "axes.labelsize": 8.5, "xtick.labelsize": 8, "ytick.labelsize": 8, "axes.titlesize": 9,
        "text.color": INK, "axes.labelcolor": INK, "xtick.color": MUTED, "ytick.color": MUTED,
        "xtick.labelcolor": INK, "ytick.labelcolor": INK, "axes.edgecolor": "#9A9A9A", "axes.linewidth": 0.7,
        "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": GRID,
        "grid.linewidth": 0.6, "axes.axisbelow": True, "axes.titlelocation": "left", "lines.linewidth": 1.3,
        "xtick.direction": "out", "ytick.direction": "out", "xtick.major.size": 3, "ytick.major.size": 3,
        "figure.facecolor": "white", "savefig.facecolor": "white", "pdf.fonttype": 42, "svg.fonttype": "none",
        "axes.formatter.useoffset": False, "axes.formatter.limits": (-4, 5), "axes.formatter.use_mathtext": True,
    }
)

_SYMBOLS = {
    "rho": "density", "u": "velocity", "p": "pressure", "energy": "total energy", "mass": "mass",
    "momentum": "momentum", "dt": "time step", "x": "x",
}


def format_units(units: str) -> str:
    """Unit such as `kg/m^3` with superscripts; empty for a dimensionless quantity."""
    if units in ("", "1", "-"):
        return ""
    return re.sub(r"\^(-?\d+)", r"$^{\1}$", units.replace("*", " "))


def axis_label(name: str, units: str) -> str:
    """Display name of a field with its unit in parentheses."""
    text = _SYMBOLS.get(name, name.replace("_", " "))
    return f"{text} ({format_units(units)})" if format_units(units) else text


def format_number(value: float) -> str:
    """Number with three significant digits, an integer from 1000 on; powers of ten as mathtext."""
    if value == 0 or not np.isfinite(value):
        return f"{value:g}"
    if 1e-2 <= abs(value) < 1e5:
        return f"{value:.0f}" if abs(value) >= 1e3 else f"{value:.3g}"
    mantissa, exponent = f"{value:.2e}".split("e")
    mantissa = mantissa.rstrip("0").rstrip(".")
    return rf"{mantissa}$\times$10$^{{{int(exponent)}}}$"


def heading(figure, title: str, subtitle: str, legend: list[tuple[str, str, str]] = ()):
    """Draws title, subtitle and a legend of (marker, label, colour); returns the text artist of the subtitle."""
    width, height = figure.get_size_inches()
    left, second_line = 0.1 / width, 1 - 0.28 / height
    figure.text(left, 1 - 0.08 / height, title, fontsize=10.5, fontweight="bold", va="top")
    caption = figure.text(left, second_line, subtitle, fontsize=8.5, color=MUTED, va="top")
    # The legend stands beside the title, since the subtitle may be long.
    draw_legend(figure, 1 - 0.1 / height, legend)
    return caption


LEGEND_GAP = 0.16  # inches
_LABEL_GAP = 0.06  # between labels of ticks, inches


def draw_legend(figure, y: float, legend: list[tuple[str, str, str]]) -> None:
    """Draws (marker, label, colour) entries in one right-aligned line; y is its top as a fraction of the height."""
    width = figure.get_size_inches()[0]
    right = 1 - 0.1 / width
    for marker, words, colour in reversed(legend):
        text = figure.text(right, y, f"{marker} {words}", color=colour, fontsize=8.5, ha="right", va="top")
        extent = text.get_window_extent(figure.canvas.get_renderer())
        right -= (extent.width / figure.dpi + LEGEND_GAP) / width


def text_width(figure, words: str, size: float) -> float:
    """Width of a line of text, inches."""
    text = figure.text(0, 0, words, fontsize=size)
    width = text.get_window_extent(figure.canvas.get_renderer()).width / figure.dpi
    text.remove()
    return width


def heading_width(figure, title: str, legend: list[tuple[str, str, str]]) -> float:
    """Figure width needed by a bold title and the legend beside it, inches."""
    words = sum(text_width(figure, f"{marker} {name}", 8.5) + LEGEND_GAP for marker, name, _ in legend)
    return 0.5 + text_width(figure, title, 12) + words


def set_log_ticks(axis) -> None:
    """Sets the ticks of a logarithmic axis; below two decades it labels 1, 2 and 5 times the powers of ten."""
    low, high = axis.get_view_interval()
    if high < 100 * low:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: format_number(value)))
        axis.set_minor_formatter(NullFormatter())


def thin_labels(axes) -> None:
    """Removes labels of the horizontal axis that would touch one at their left. Its range and the size of the figure are final."""
    low, high = axes.get_xlim()
    places = [place for place in axes.xaxis.get_majorticklocs() if low <= place <= high]
    labels, end = axes.xaxis.get_major_formatter().format_ticks(places), -np.inf
    for k, place in enumerate(places):
        middle = axes.transData.transform((place, axes.get_ylim()[0]))[0] / axes.figure.dpi
        half = text_width(axes.figure, labels[k], matplotlib.rcParams["xtick.labelsize"]) / 2
        if middle - half < end + _LABEL_GAP:
            labels[k] = ""
        elif labels[k]:
            end = middle + half
    axes.set_xticks(places, labels)


def subtitle_width(figure, subtitle: str) -> float:
    """Figure width needed by a subtitle, inches."""
    return 0.2 + text_width(figure, subtitle, 8.5)


_OUTLIER = 2.0  # extreme values within this factor of a percentile are inside a colour scale


def scale_end(values: np.ndarray, percent: float, extreme: float, middle: float = 0.0) -> float:
    """End of a colour scale: the extreme value, or a percentile if the extreme is far beyond it, seen from `middle`."""
    end = float(np.percentile(values, percent))
    return end if abs(extreme - middle) > _OUTLIER * abs(end - middle) > 0 else extreme


LABEL_SIZE = 8
LABEL_STEP = 11.5 / 72  # inches between two labels


def label_curves(axes, ends) -> None:
    """Labels curves at the right of the axes without overlaps; `ends` holds ((x, y), label, colour) each."""
    # Reading the limits fixes them; nothing that is drawn later changes the layout.
    axes.get_xlim(), axes.get_ylim()
    box = axes.get_window_extent()
    step = LABEL_STEP * axes.figure.dpi
    levels = sorted((axes.transData.transform(point)[1] - box.y0, words, colour) for point, words, colour in ends)
    placed = -np.inf
    for index, (pixel, words, colour) in enumerate(levels):
        # The remaining labels must fit below the top of the axes.
        highest = box.height - (len(levels) - 1 - index) * step
        placed = max(min(pixel, highest), placed + step)
        axes.annotate(
            words, (1.03, placed / box.height), xycoords="axes fraction", color=colour, va="center",
            fontsize=LABEL_SIZE, annotation_clip=False,
        )


def decimate(x: np.ndarray, y: np.ndarray, buckets: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """Min-max decimation: the lowest and the highest point in each of `buckets` parts of a long curve."""
    if len(x) <= 4 * buckets:
        return x, y
    size = len(x) // buckets
    used = size * buckets
    pieces = np.where(np.isfinite(y[:used]), y[:used], 0.0).reshape(buckets, size)
    start = np.arange(buckets) * size
    keep = np.concatenate([start + pieces.argmin(1), start + pieces.argmax(1), [len(x) - 1]])
    keep = np.unique(keep)
    return x[keep], y[keep]


def write_atomically(file: Path, write) -> Path:
    """Calls write(temporary file) and renames it to `file`, which is returned; raises Failure (IO_ERROR)."""
    temporary = file.with_name(f".{file.stem}.{os.getpid()}{file.suffix}")
    at_signal.append(temporary.unlink)
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        write(temporary)
        temporary.replace(file)
    except OSError as error:
        raise Failure(IO_ERROR, f"{file} cannot be written: {error.strerror or error}.") from None
    finally:
        # It is still there after any failure.
        with contextlib.suppress(OSError):
            temporary.unlink()
    return file


def save_figure(figure, file: Path, dpi: int, few_colours: bool = True) -> Path:
    """Writes and closes a figure; raises Failure (IO_ERROR).

    A PNG has 256 colours (a third of the size) unless `few_colours` is false, for figures of several colour maps.
    """

    def write(temporary: Path) -> None:
        figure.savefig(temporary, dpi=dpi)
        if file.suffix == ".png" and few_colours:
            with Image.open(temporary) as image:
                small = image.convert("RGB").quantize(256, dither=Image.Dither.NONE)
            small.save(temporary, optimize=True)

    write_atomically(file, write)
    plt.close(figure)
    return file
