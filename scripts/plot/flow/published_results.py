"""Speed and error of other programs on Taylor-Green vortices, as measured for this project."""

from ..evidence.scheme_family import PublishedResult

_METHOD = (
    "peclet-flow 1.4.0 (second-order upwind, explicit Euler for advection, multigrid), defaults but for the multigrid "
    "levels, dt = 0.25 h; its time per cell and step times cells and steps; measured for this project, 2026-11-21"
)
_END_TIME, _LENGTH, _COURANT = 1.0, 6.283185307179586, 0.25


def _seconds(n: int, nanoseconds: float) -> float:
    """Time to the end of n^3 cells, s, from ns per cell and step."""
    return 1e-9 * nanoseconds * n**3 * _END_TIME / (_COURANT * _LENGTH / n)


PUBLISHED_RESULTS = (
    PublishedResult(
        "resting-vortices", "peclet-flow", "cuda", ((_seconds(128, 5.22), 1.7e-5), (_seconds(256, 4.04), 2.0e-6)),
        f"{_METHOD}, one H200, 128 and 256 cells per axis",
    ),
    PublishedResult(
        "resting-vortices", "peclet-flow, two threads", "openmp",
        ((_seconds(64, 421), 1.7e-4), (_seconds(128, 729), 1.7e-5)),
        f"{_METHOD}, two cores of a Xeon, 64 and 128 cells per axis",
    ),
)
