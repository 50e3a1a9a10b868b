"""Models and problems of the work-precision records of drogue-springs."""

from ..evidence.scheme_family import SchemeFamily

FAMILY = SchemeFamily(
    app="springs",
    scheme_fact="model",
    scheme_names={"biquadratic": "biquadratic", "quadratic": "quadratic", "string": "string"},
    settings=("mass", "integrator"),
    default_settings=("area", "rk4"),
    default_label="masses by area, Runge-Kutta",
    colour_settings=("area", "equal"),
    line_settings={"rk4": "Runge-Kutta", "verlet": "Verlet"},
    problems={"drum": "Drum", "hencky": "Hencky's membrane", "catenary": "Catenary"},
    error_titles={
        "drum": "relative error of the frequency",
        "hencky": "relative error of the deflection",
        "catenary": "farthest vertex over the span",
    },
    mesh_unit="vertices",
    planar_schemes=("biquadratic", "quadratic"),
    target_errors=(1e-2, 1e-3, 1e-4),
)
