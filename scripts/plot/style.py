"""Look of every picture: light, legible at one column of a paper, safe for colour-blind readers."""

import contextlib
import os
import re
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402
from PIL import Image  # noqa: E402

from .failure import IO_ERROR, Failure  # noqa: E402

# Okabe and Ito (2008), ordered so that neighbours differ in lightness too.
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
)  # fmt: skip

_SYMBOLS = {
    "rho": "density", "u": "velocity", "p": "pressure", "energy": "total energy", "mass": "mass",
    "momentum": "momentum", "dt": "time step", "x": "x",
}  # fmt: skip


def units_text(units: str) -> str:
    """`kg/m^3` as a person writes it; empty for a pure number."""
    if units in ("", "1", "-"):
        return ""
    return re.sub(r"\^(-?\d+)", r"$^{\1}$", units.replace("*", " "))


def axis_label(name: str, units: str) -> str:
    text = _SYMBOLS.get(name, name.replace("_", " "))
    return f"{text} ({units_text(units)})" if units_text(units) else text


def check_label(name: str) -> str:
    """What the value of a check of result.json is, in words."""
    # Not the density itself: its relative deviation from the published one.
    return "max density off by" if name == "max_density" else name.replace("_", " ")


def number(value: float) -> str:
    """Three digits, or the whole number from 1000 on; powers of ten as a paper prints them."""
    if value == 0 or not np.isfinite(value):
        return f"{value:g}"
    if 1e-2 <= abs(value) < 1e5:
        return f"{value:.0f}" if abs(value) >= 1e3 else f"{value:.3g}"
    mantissa, exponent = f"{value:.2e}".split("e")
    mantissa = mantissa.rstrip("0").rstrip(".")
    return rf"{mantissa}$\times$10$^{{{int(exponent)}}}$"


def heading(figure, name: str, details: str, key: list[tuple[str, str, str]] = ()):
    """Title at the left and what it shows under it, which is returned; `key` (marker, words, colour) names the curves."""
    width, height = figure.get_size_inches()
    left, second_line = 0.1 / width, 1 - 0.28 / height
    figure.text(left, 1 - 0.08 / height, name, fontsize=10.5, fontweight="bold", va="top")
    caption = figure.text(left, second_line, details, fontsize=8.5, color=MUTED, va="top")
    # Beside the title, whose words are few: the second line may be long.
    curve_key(figure, 1 - 0.1 / height, key)
    return caption


KEY_GAP = 0.16


def curve_key(figure, y: float, key: list[tuple[str, str, str]]) -> None:
    """Marker, words and colour of each curve in a line that ends at the right; y: its top as a share of the height."""
    width = figure.get_size_inches()[0]
    right = 1 - 0.1 / width
    for marker, words, colour in reversed(key):
        text = figure.text(right, y, f"{marker} {words}", color=colour, fontsize=8.5, ha="right", va="top")
        extent = text.get_window_extent(figure.canvas.get_renderer())
        right -= (extent.width / figure.dpi + KEY_GAP) / width


def text_width(figure, words: str, size: float) -> float:
    """Inches that a line of text takes."""
    text = figure.text(0, 0, words, fontsize=size)
    width = text.get_window_extent(figure.canvas.get_renderer()).width / figure.dpi
    text.remove()
    return width


def titled_key_width(figure, title: str, key: list[tuple[str, str, str]]) -> float:
    """Inches that a figure needs for a title in bold type and the key beside it."""
    words = sum(text_width(figure, f"{marker} {name}", 8.5) + KEY_GAP for marker, name, _ in key)
    return 0.5 + text_width(figure, title, 12) + words


def mark_logarithm(axis) -> None:
    """Ticks of a logarithmic axis: under two decades powers of ten alone leave it without a scale."""
    low, high = axis.get_view_interval()
    if high < 100 * low:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
        axis.set_minor_formatter(NullFormatter())


def details_width(figure, details: str) -> float:
    """Inches that a figure needs for the second line of its heading."""
    return 0.2 + text_width(figure, details, 8.5)


LABEL_SIZE = 8
# Inches from one label to the next.
LABEL_STEP = 11.5 / 72


def label_ends(axes, ends) -> None:
    """Names curves beside their right ends in their own colours, no two on each other; ends: ((x, y), words, colour)."""
    # Asking for the limits settles them; all else of a drawing moves nothing.
    axes.get_xlim(), axes.get_ylim()
    box = axes.get_window_extent()
    step = LABEL_STEP * axes.figure.dpi
    levels = sorted(
        (axes.transData.transform(point)[1] - box.y0, words, colour) for point, words, colour in ends
    )
    placed = -np.inf
    for index, (pixel, words, colour) in enumerate(levels):
        # Low enough for those above it to end at the top of the axes.
        highest = box.height - (len(levels) - 1 - index) * step
        placed = max(min(pixel, highest), placed + step)
        axes.annotate(
            words, (1.03, placed / box.height), xycoords="axes fraction", color=colour, va="center",
            fontsize=LABEL_SIZE, annotation_clip=False,
        )  # fmt: skip


def thin(x: np.ndarray, y: np.ndarray, buckets: int = 2000) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest point of each of `buckets` pieces of a long curve: looks the same, in a small file."""
    if len(x) <= 4 * buckets:
        return x, y
    size = len(x) // buckets
    used = size * buckets
    pieces = np.where(np.isfinite(y[:used]), y[:used], 0.0).reshape(buckets, size)
    start = np.arange(buckets) * size
    keep = np.concatenate([start + pieces.argmin(1), start + pieces.argmax(1), [len(x) - 1]])
    keep = np.unique(keep)
    return x[keep], y[keep]


def replace_file(file: Path, write) -> Path:
    """Calls write(temporary name) and renames: a reader never sees half a picture."""
    temporary = file.with_name(f".{file.stem}.{os.getpid()}{file.suffix}")
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        write(temporary)
        temporary.replace(file)
    except OSError as error:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise Failure(IO_ERROR, f"{file} cannot be written: {error.strerror or error}.") from None
    return file


def save(figure, file: Path, dpi: int) -> Path:
    """Writes and closes a figure; PNG in 256 colours, a third of the size with no visible change."""

    def write(temporary: Path) -> None:
        figure.savefig(temporary, dpi=dpi)
        if file.suffix == ".png":
            with Image.open(temporary) as image:
                small = image.convert("RGB").quantize(256, dither=Image.Dither.NONE)
            small.save(temporary, optimize=True)

    replace_file(file, write)
    plt.close(figure)
    return file
