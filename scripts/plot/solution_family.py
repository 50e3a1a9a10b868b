"""What the solutions of an app differ in, and how a page calls it."""

from dataclasses import dataclass

from .perf_record import Record
from .study_figure import SCHEMES, TITLES


@dataclass(frozen=True, eq=False)
class Family:
    """Schemes are named by one fact and have settings, of which the first has colours and the second lines, and the
    third, where there is one, rows. `errors` are those whose times are asked for; empty: the competitor's."""

    app: str
    fact: str
    names: dict[str, str]
    settings: tuple[str, ...]
    usual: tuple[str, ...]
    usual_words: str
    firsts: tuple[str, ...]
    seconds: dict[str, str]
    problems: dict[str, str]
    error_titles: dict[str, str]  # of a problem
    competitor: str = ""
    mesh: str = "cells"
    planar: tuple[str, ...] = ()  # schemes whose mesh has as many edges along an axis as the root of its number
    errors: tuple[float, ...] = ()

    @property
    def command(self) -> str:
        return f"drogue-perf work-precision --app {self.app} --out FILE.jsonl"


_GAS_PROBLEMS = {
    "entropy-wave": "Entropy wave", "shu-osher": "Shu-Osher", "blast": "Woodward-Colella blast", "leblanc": "LeBlanc",
    "sod": "Sod",
}  # fmt: skip
GAS = Family(
    app="gas",
    fact="weno",
    names=SCHEMES | {"muscl-hancock": "MUSCL-Hancock"},
    settings=("splitting", "time_scheme", "precision"),
    usual=("lf-stencil", "ssprk3", "double"),
    usual_words="lf-stencil, SSP-RK3, double precision",
    firsts=("lf-stencil", "lf-global", "lf-single"),
    seconds={"ssprk3": "SSP-RK3", "ssprk43": "SSPRK(4,3)"},
    problems=_GAS_PROBLEMS,
    error_titles=dict.fromkeys(_GAS_PROBLEMS, TITLES["l1_density"]),
    competitor="muscl-hancock",
)
SPRINGS = Family(
    app="springs",
    fact="model",
    names={"biquadratic": "biquadratic", "quadratic": "quadratic", "string": "string"},
    settings=("mass", "integrator"),
    usual=("area", "rk4"),
    usual_words="masses by area, Runge-Kutta",
    firsts=("area", "equal"),
    seconds={"rk4": "Runge-Kutta", "verlet": "Verlet"},
    problems={"drum": "Drum", "hencky": "Hencky's membrane", "catenary": "Catenary"},
    error_titles={
        "drum": "relative error of the frequency", "hencky": "relative error of the deflection",
        "catenary": "farthest vertex over the span",
    },  # fmt: skip
    mesh="vertices",
    planar=("biquadratic", "quadratic"),
    errors=(1e-2, 1e-3, 1e-4),
)


def family_of(record: Record) -> Family:
    return SPRINGS if record.kind == "springs-solution" else GAS
