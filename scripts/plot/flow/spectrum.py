"""Energy spectrum E(k) of a flow that is periodic along every axis, from the velocity at the cell centres."""

from dataclasses import dataclass

import numpy as np

from .. import style
from ..checks import failure_caption
from ..run_directory import Run, Snapshot, evenly_spaced
from ..style import plt
from .plane import AXES, cell_counts, dimension, is_uniform

_MAX_CURVES = 6
_SIZE = (5.2, 3.6)
_ROUND_OFF = 1e-11  # relative to the largest value; what is smaller is not drawn
_NOTHING = 1e-20  # relative to the square of the largest speed: a uniform flow has round-off and no spectrum
_LEAST_SHELLS = 4  # with energy above round-off; a flow of fewer modes has no spectrum worth a figure


@dataclass(frozen=True)
class Spectrum:
    """Wave numbers (rad/m) at the centres of the shells, and kinetic energy per mass and wave number, m^3/s^2."""

    k: np.ndarray
    energy: np.ndarray


def is_periodic(run: Run) -> bool:
    """Whether every axis with more than one cell is periodic, there are two at least, and a finite velocity is known."""
    boundary = run.scene.get("grid", {}).get("boundary", {})
    along = [axis for axis, count in zip(AXES, cell_counts(run)) if count > 1]
    periodic = all(boundary.get(axis) in ("periodic", ["periodic", "periodic"]) for axis in along)
    fields = run.snapshots[-1].fields
    uniform = all(is_uniform(run.mesh[axis].values) for axis in along)
    return periodic and uniform and len(along) >= 2 and "velocity" in fields and bool(np.isfinite(fields["velocity"].values).all())


def energy_spectrum(velocity: np.ndarray, lengths: tuple[float, float, float]) -> Spectrum:
    """Spectrum of a velocity (nx, ny, nz, 3), m/s, in a periodic box of the edge `lengths`, m.

    Shell n holds the wave vectors whose size rounds to n times the smallest wave number of the box. The sum of the
    energies times the width of a shell is the kinetic energy per mass of all of them, without the mean velocity.
    Shells beyond the largest wave number that every axis resolves are left out, since they are incomplete.
    """
    counts = velocity.shape[:3]
    along = [axis for axis in range(3) if counts[axis] > 1]
    width = min(2 * np.pi / lengths[axis] for axis in along)
    waves = np.meshgrid(
        *(2 * np.pi * np.fft.fftfreq(count, length / count) for count, length in zip(counts, lengths)),
        indexing="ij", sparse=True,
    )
    shell = np.rint(np.sqrt(sum(wave**2 for wave in waves)) / width).astype(int)
    modes = np.fft.fftn(velocity, axes=(0, 1, 2)) / np.prod(counts)
    energy = np.bincount(shell.ravel(), weights=(0.5 * np.sum(np.abs(modes) ** 2, axis=-1)).ravel())
    largest = int(min(np.pi * counts[axis] / lengths[axis] for axis in along) / width * (1 + 1e-9))
    shells = np.arange(1, min(largest, len(energy) - 1) + 1)
    return Spectrum(shells * width, energy[shells] / width)


def _box(run: Run) -> tuple[float, float, float]:
    """Edge lengths of the domain, m."""
    return tuple(float(np.ptp(run.mesh[axis].values)) for axis in AXES)


def _curves(run: Run, last: Snapshot) -> list[tuple[Snapshot, Spectrum]]:
    """Spectra of at most _MAX_CURVES evenly spaced snapshots up to `last`, without those of no energy."""
    snapshots = run.snapshots[: run.snapshots.index(last) + 1]
    spectra = [
        (snapshot, energy_spectrum(snapshot.fields["velocity"].values, _box(run)))
        for snapshot in evenly_spaced(snapshots, _MAX_CURVES)
    ]
    return [(snapshot, spectrum) for snapshot, spectrum in spectra if np.any(spectrum.energy > 0)]


def _draw_mark(axes, spectra: list[Spectrum], power: float, words: str, start: float, end: float) -> None:
    """Draws a line of slope `power` above the parts `start` to `end` of the shells of all spectra, with its label."""
    count = len(spectra[0].k)
    first = max(1, round(start * count))
    part = slice(first, max(first + 2, round(end * count) + 1))
    k, energy = spectra[0].k[part], np.max([spectrum.energy[part] for spectrum in spectra], axis=0)
    line = k**power
    line *= 2 * np.max(energy / line)
    axes.plot(k, line, "--", color=style.MUTED, linewidth=1)
    middle = int(np.searchsorted(k, np.sqrt(k[0] * k[-1])))
    axes.annotate(
        words, (k[middle], line[middle]), xytext=(3, 4), textcoords="offset points", color=style.MUTED,
        fontsize=style.LABEL_SIZE,
    )


def largest_speed(run: Run) -> float:
    """Largest speed of the snapshots and of the history, m/s."""
    speeds = [np.linalg.norm(snapshot.fields["velocity"].values, axis=-1).max() for snapshot in run.snapshots]
    return max(*speeds, *run.history["max_speed"].values) if "max_speed" in run.history else max(speeds)


def spectrum_figure(run: Run, last: Snapshot):
    """Spectra of the snapshots up to `last`, with marks of slope -5/3 and, in two dimensions, -3.

    None if the last flow consists of fewer than four shells of modes, or of a uniform velocity.
    """
    curves = _curves(run, last)
    top = max((spectrum.energy.max() for _, spectrum in curves), default=0.0)
    floor = _ROUND_OFF * top
    if not curves or top * curves[-1][1].k[0] < _NOTHING * largest_speed(run) ** 2 or np.sum(curves[-1][1].energy > floor) < _LEAST_SHELLS:
        return None
    figure, axes = plt.subplots(figsize=_SIZE)
    colours = plt.get_cmap("viridis_r")(np.linspace(0.15, 1, len(curves)))
    ends = []
    for colour, (snapshot, spectrum) in zip(colours, curves):
        is_shown = spectrum.energy > floor
        axes.plot(spectrum.k, np.where(is_shown, spectrum.energy, np.nan), "o-", color=colour, linewidth=1.2,
                  markersize=2)
        if np.any(is_shown):
            end = np.flatnonzero(is_shown)[-1]
            ends.append(((spectrum.k[end], spectrum.energy[end]), f"t = {snapshot.time:.4g} s", colour))
    axes.set_xscale("log")
    axes.set_yscale("log")
    marks = [(-5 / 3, "$k^{-5/3}$", 0.08, 0.5)]
    if dimension(run) == 2:
        marks = [(-5 / 3, "$k^{-5/3}$", 0.05, 0.2), (-3, "$k^{-3}$", 0.25, 0.8)]
    for mark in marks:
        _draw_mark(axes, [spectrum for _, spectrum in curves], *mark)
    axes.set_ylim(max(axes.get_ylim()[0], floor / 3), 10 * top)
    style.set_log_ticks(axes.xaxis)
    style.label_curves(axes, ends)
    axes.set_xlabel("wave number k (rad/m)")
    axes.set_title("energy per mass and wave number (m$^3$/s$^2$)")
    figure.subplots_adjust(left=0.13, right=0.84, top=1 - 0.85 / _SIZE[1], bottom=0.13)
    counts = " x ".join(str(count) for count in cell_counts(run) if count > 1)
    style.heading(figure, run.name, f"spectrum of the kinetic energy, {counts} cells{failure_caption(run.result)}")
    return figure
