"""Schemes and problems of the work-precision records of flow."""

from ..evidence.scheme_family import SchemeFamily
from .published_results import PUBLISHED_RESULTS

_PROBLEMS = {
    "drifting-vortices": "Drifting vortices of Taylor and Green",
    "resting-vortices": "Vortices of Taylor and Green at rest",
    "cavity": "Lid-driven cavity",
}
_VORTICES = "largest error of the velocity (m/s)"
FAMILY = SchemeFamily(
    app="flow",
    scheme_fact="advection",
    scheme_names={"weno-z": "WENO-Z", "weno-js": "WENO-JS", "central": "central"},
    settings=("time_scheme", "pressure", "diffusion"),
    default_settings=("ab2", "fft", "explicit"),
    # Without fast transforms between walls on CUDA.
    other_defaults={("cavity", "cuda"): ("ab2", "diagonalization", "explicit")},
    default_label="AB2, explicit diffusion; transforms, on CUDA between walls matrix products",
    colour_settings=("ab2", "rk3"),
    line_settings={"fft": "transforms", "diagonalization": "matrix products"},
    problems=_PROBLEMS,
    error_titles=dict.fromkeys(_PROBLEMS, _VORTICES) | {"cavity": "error of extreme velocities (m/s)"},
    mesh_unit="cells per axis",
    setting_labels={
        "ab2": "AB2", "rk3": "RK3", "fft": "transforms", "diagonalization": "matrix products",
        "hypre-pfmg": "hypre PFMG", "explicit": "explicit diffusion", "crank-nicolson": "Crank-Nicolson",
    },
    published=PUBLISHED_RESULTS,
    note="AB2 at CFL 0.5, RK3 at 1. Vortices: a periodic cube of 2 pi m, nu = 0.01 m^2/s, to t = 1 s; those at rest hide "
    "errors of time integration, because the pressure balances their advection. Cavity: Re 100, to t = 20 s, when it is "
    "steady; extremes on the centre lines against Marchi, Suero and Araki 2009.",
    target_errors=(1e-2, 1e-3, 1e-4),
)
