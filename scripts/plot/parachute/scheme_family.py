"""Discretizations and problems of the work-precision records of canopies."""

from ..evidence.scheme_family import SchemeFamily

_PROBLEMS = {
    "opening-impulse": "Opening C-9: impulse", "opening-time": "Opening C-9: time", "porous-drag": "Porous C-9: drag",
}
FAMILY = SchemeFamily(
    app="parachute",
    scheme_fact="kernel",
    scheme_names={
        "cbs43": "B-splines 4-3", "cbs43 inset 0.55": "B-splines 4-3, inset 0.55",
        "cbs43 defect 0.1": "B-splines 4-3, defect 0.1", "cbs43 inset 0.55 defect 0.1": "B-splines 4-3, inset 0.55, defect 0.1",
        "cbs43 corrected": "B-splines 4-3, corrected", "cbs32": "B-splines 3-2", "ib4": "four-point function",
    },
    settings=("time", "edge"),
    default_settings=("ab2 0.25", "0.7"),
    default_label="AB2 at CFL 0.25, edges of the cloth of 0.7 cells",
    colour_settings=("ab2 0.25", "ab2 0.125", "ab2 0.5", "rk3 0.5", "rk3 1.0"),
    line_settings={"0.7": "edges of 0.7 cells", "0.35": "edges of 0.35 cells"},
    problems=_PROBLEMS,
    error_titles={
        "opening-impulse": "relative error of the impulse",
        "opening-time": "relative error of the time of half the impulse",
        "porous-drag": "relative error of the mean drag",
    },
    mesh_unit="cells across",
    setting_labels={
        "ab2 0.25": "AB2 at CFL 0.25", "ab2 0.125": "AB2 at CFL 0.125", "ab2 0.5": "AB2 at CFL 0.5",
        "rk3 0.5": "RK3 at CFL 0.5", "rk3 1.0": "RK3 at CFL 1",
        "0.7": "edges of 0.7 cells", "0.35": "edges of 0.35 cells",
    },
    note="A C-9 opens from its flat cloth in a stream of 10 m/s, its payload fixed, in a box of 12 m by 12 m by 24 m. "
    "Impulse: momentum that it gives the air in the first second. Drag: mean from 1 to 2 s of highly porous cloth, which starts "
    "nearly open and hardly breathes. Inset: of free edges, in cells; defect: weight of its running mean. Errors are relative "
    "to a solution on twice the cells per axis of the finest grid with half the time step.",
    target_errors=(1e-1, 3e-2, 1e-2),
)
