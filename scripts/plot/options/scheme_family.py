"""Methods and problems of the work-precision records of drogue-options."""

from ..evidence.scheme_family import SchemeFamily
from .published_results import PUBLISHED_RESULTS

_PROBLEMS = {
    "thesis": "The put of [Shi]", "five-years": "The same for five years",
    "pure-jumps": "Normal inverse Gaussian jumps alone", "day": "A day to expiry", "merton": "Merton's jumps",
    "black-scholes": "Black and Scholes",
}
FAMILY = SchemeFamily(
    app="options",
    scheme_fact="method",
    scheme_names={"pide": "finite differences", "cos": "cosine series", "seed": "the scheme of [Shi]"},
    settings=("exercise", "grids", "intervals_a_step"),
    default_settings=("exact", "two", "4"),
    default_label="American puts; finite differences on two grids, a step for four intervals",
    colour_settings=("exact", "split", "none"),
    line_settings={"two": "two grids", "one": "one grid"},
    problems=_PROBLEMS,
    error_titles=dict.fromkeys(_PROBLEMS, "largest error over the strike"),
    competitor="seed",
    mesh_unit="intervals",
    time_label="time an option (s)",
    setting_labels={
        "exact": "exact exercise", "split": "split exercise", "none": "European", "one": "one grid",
        "4": "a step for four intervals", "2": "a step for two intervals", "1": "a step for an interval",
    },
    published=PUBLISHED_RESULTS,
    note="Of cosine series the dates of the last Bermudan option stand for intervals. Known prices are good to 1e-7 of "
    "the strike (Merton's jumps 5e-8, Black and Scholes 5e-9): smaller errors mean no more than that.",
    target_errors=(1e-3, 1e-4, 1e-5),
)
