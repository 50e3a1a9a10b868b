"""What the solutions of an app differ in, and how a page calls it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from .options_marks import MARKS, Mark
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
    time: str = "time to solution (s)"
    words: Mapping[str, str] = field(default_factory=dict)  # of a setting, where it is not its own
    rows: Mapping[str, str] = field(default_factory=dict)  # of the third setting, where `words` do not say enough
    marks: tuple[Mark, ...] = ()
    note: str = ""
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
    rows={"double": "double precision", "split": "split precision"},
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
_OPTIONS_PROBLEMS = {
    "thesis": "The dissertation's put", "five-years": "The same for five years",
    "pure-jumps": "Normal inverse Gaussian jumps alone", "day": "A day to expiry", "merton": "Merton's jumps",
    "black-scholes": "Black and Scholes",
}  # fmt: skip
OPTIONS = Family(
    app="options",
    fact="method",
    names={"pide": "finite differences", "cos": "cosine series", "seed": "the dissertation's scheme"},
    settings=("exercise", "grids", "intervals_a_step"),
    usual=("exact", "two", "4"),
    usual_words="American puts; finite differences on two grids, a step for four intervals",
    firsts=("exact", "split", "none"),
    seconds={"two": "two grids", "one": "one grid"},
    problems=_OPTIONS_PROBLEMS,
    error_titles=dict.fromkeys(_OPTIONS_PROBLEMS, "largest error over the strike"),
    competitor="seed",
    mesh="intervals",
    time="time an option (s)",
    words={
        "exact": "exact exercise", "split": "split exercise", "none": "European", "one": "one grid",
        "4": "a step for four intervals", "2": "a step for two intervals", "1": "a step for an interval",
    },
    marks=MARKS,
    note="Of cosine series the dates of the last Bermudan option stand for intervals. Known prices are good to 1e-7 of "
    "the strike (Merton's jumps 5e-8, Black and Scholes 5e-9): smaller errors mean no more than that.",
    errors=(1e-3, 1e-4, 1e-5),
)  # fmt: skip


def family_of(record: Record) -> Family:
    return {"springs-solution": SPRINGS, "options-solution": OPTIONS}.get(record.kind, GAS)
