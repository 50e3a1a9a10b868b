"""Animations: GIF by Pillow, MP4 by the ffmpeg binary of the package imageio-ffmpeg."""

import subprocess
from collections import Counter
from pathlib import Path

import numpy as np
from PIL import Image

from . import style
from .failure import IO_ERROR, Failure
from .program import at_signal
from .style import plt

_GIF_COLOURS = 255  # one of 256 is for pixels that keep their colour from frame to frame
_NEAR = 8  # distance, of 255 along each axis, below which a colour of a GIF stands for another one
_CANDIDATES = 8192  # colours that are considered for the palette


def frame_of(canvas) -> np.ndarray:
    """Pixels, (height, width, 3) bytes, of what a canvas shows, without an odd last row or column."""
    pixels = np.asarray(canvas.buffer_rgba())[..., :3]
    # Many MP4 players require even sizes.
    return pixels[: pixels.shape[0] // 2 * 2, : pixels.shape[1] // 2 * 2].copy()


def drawn_frames(drawing, snapshots):
    """Generator of a frame, (height, width, 3) bytes, per snapshot that `drawing` shows in its figure, which it closes."""
    for snapshot in snapshots:
        drawing.show(snapshot)
        drawing.figure.canvas.draw()
        yield frame_of(drawing.figure.canvas)
    plt.close(drawing.figure)


def _pack_rgb(pixels: np.ndarray) -> np.ndarray:
    """Pixels (height, width, 3) as integers 0xRRGGBB (height, width)."""
    return pixels.astype(np.int64) @ np.array([1 << 16, 1 << 8, 1])


def _unpack_rgb(colours: np.ndarray) -> np.ndarray:
    """Inverse of `_pack_rgb`."""
    return np.stack([colours >> 16, colours >> 8 & 255, colours & 255], axis=-1)


def _common_palette(frames) -> np.ndarray:
    """Colours of a GIF; one common palette avoids flicker and keeps white exact.

    They are the most frequent ones of all frames that are not near to more frequent ones: mixtures at the edges of thin
    lines, each of them rare, find a colour of their kind.
    """
    counts = Counter()
    for pixels in frames:
        counts.update(dict(zip(*(part.tolist() for part in np.unique(_pack_rgb(pixels), return_counts=True)))))
    candidates = np.array([colour for colour, _ in counts.most_common(_CANDIDATES)])
    colours = _unpack_rgb(candidates)
    nearest, chosen = np.full(len(colours), np.inf), []  # squared distance to the chosen ones
    while len(chosen) < _GIF_COLOURS and nearest.max() >= _NEAR**2:
        chosen.append(int((nearest >= _NEAR**2).argmax()))
        nearest = np.minimum(nearest, ((colours - colours[chosen[-1]]) ** 2).sum(-1))
    return candidates[chosen]


def _quantize(pixels: np.ndarray, palette: np.ndarray) -> Image.Image:
    """Frame with each colour replaced by the nearest one of the palette (Pillow's own search is approximate)."""
    colours, index = np.unique(_pack_rgb(pixels), return_inverse=True)
    # The squared distance without the square of the colour itself; single precision holds these integers exactly.
    choices = _unpack_rgb(palette).astype(np.float32)
    distance = (choices**2).sum(-1) - 2 * _unpack_rgb(colours).astype(np.float32) @ choices.T
    nearest = distance.argmin(1).astype(np.uint8)[index].reshape(pixels.shape[:2])
    image = Image.fromarray(nearest, "P")
    image.putpalette(_unpack_rgb(palette).astype(np.uint8).tobytes())
    return image


def _write_gif(file: Path, frames: list[np.ndarray]) -> None:
    palette = _common_palette(frames)
    images = [_quantize(pixels, palette) for pixels in frames]
    frame_ms = int(np.clip(4000 / len(images), 50, 700))
    durations = [frame_ms] * (len(images) - 1) + [1500]
    images[0].save(file, save_all=True, append_images=images[1:], duration=durations, loop=0, optimize=True)


def _write_mp4(file: Path, frames: list[np.ndarray]) -> None:
    import imageio_ffmpeg

    height, width = frames[0].shape[:2]
    rate = max(2.0, len(frames) / 4)
    command = [
        imageio_ffmpeg.get_ffmpeg_exe(), "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
        "-s", f"{width}x{height}", "-r", str(rate), "-i", "-", "-pix_fmt", "yuv420p", str(file),
    ]
    stream = b"".join(pixels.tobytes() for pixels in frames)
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as ffmpeg:
        at_signal.append(ffmpeg.kill)
        errors = ffmpeg.communicate(stream)[1]
    if ffmpeg.returncode != 0:
        raise Failure(IO_ERROR, f"ffmpeg could not write {file}: {errors.decode().strip().splitlines()[-1]}.")


def write(stem: Path, formats: tuple[str, ...], frames):
    """Generator of the paths of movies, `stem` with the suffix of each format, of the same frames.

    Frames are of equal size, (height, width, 3) bytes each. Raises Failure (IO_ERROR) if a file cannot be written.
    """
    frames = list(frames)
    writers = {"gif": _write_gif, "mp4": _write_mp4}
    for suffix in formats:
        yield style.write_atomically(
            stem.with_name(f"{stem.name}.{suffix}"), lambda temporary: writers[suffix](temporary, frames)
        )
