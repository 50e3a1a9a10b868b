"""Schemes and problems of the work-precision records of drogue-gas."""

from ..evidence.scheme_family import SchemeFamily
from ..study_figure import SCHEMES, TITLES

_PROBLEMS = {
    "entropy-wave": "Entropy wave", "shu-osher": "Shu-Osher", "blast": "Woodward-Colella blast", "leblanc": "LeBlanc",
    "sod": "Sod",
}
FAMILY = SchemeFamily(
    app="gas", scheme_fact="weno", scheme_names=SCHEMES | {"muscl-hancock": "MUSCL-Hancock"},
    settings=("splitting", "time_scheme", "precision"), default_settings=("lf-stencil", "ssprk3", "double"),
    default_label="lf-stencil, SSP-RK3, double precision",
    colour_settings=("lf-stencil", "lf-global", "lf-single"),
    line_settings={"ssprk3": "SSP-RK3", "ssprk43": "SSPRK(4,3)"}, problems=_PROBLEMS,
    error_titles=dict.fromkeys(_PROBLEMS, TITLES["l1_density"]),
    row_labels={"double": "double precision", "split": "split precision"}, competitor="muscl-hancock",
)
