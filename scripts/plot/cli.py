"""The program drogue-plot: figures of a run directory, and pages of a folder of benchmark records."""

import argparse
import difflib
import importlib.util
import math
import os
import re
import subprocess
import sys
from pathlib import Path

from .failure import INVALID, OK, USAGE, Failure
from .picture_names import SPACE_TIME, picture_name
from .program import require_one_rank, write_line

SPACE_TIME_SNAPSHOTS = 8  # smallest number of snapshots for a space-time map
_MOVIES = {"gif": ("gif",), "mp4": ("mp4",), "both": ("gif", "mp4"), "none": ()}  # formats by the word of --movie


def _version() -> str:
    folder = Path(__file__).resolve().parent
    git = subprocess.run(
        ["git", "-C", str(folder), "rev-parse", "--short=12", "HEAD"], capture_output=True, text=True,
        check=False,
    )
    import h5py

    from .style import matplotlib

    # An installed package has no CMakeLists.txt: there the launcher sets DROGUE_VERSION.
    number = os.environ.get("DROGUE_VERSION")
    project = folder.parents[1] / "CMakeLists.txt"
    if number is None and project.is_file():
        match = re.search(r"project\(\s*\w+\s+VERSION\s+([\d.]+)", project.read_text())
        number = match and match.group(1)
    revision = git.stdout.strip() or "unknown"
    return (
        f"drogue-plot {number or 'unknown'} (git {revision})\n"
        f"matplotlib {matplotlib.__version__}, h5py {h5py.__version__}, HDF5 {h5py.version.hdf5_version}"
    )


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Failure(USAGE, f"{message}; drogue-plot --help lists the options.")

    def print_help(self, file=None):
        write_line(self.format_help().rstrip("\n"))


def arguments(words: list[str]) -> argparse.Namespace:
    """Parsed and validated command line; raises Failure (USAGE)."""
    parser = _Parser(
        prog="drogue-plot",
        description="Draws the pictures of a run directory, or the evidence page of records.",
    )
    parser.add_argument(
        "directory", metavar="DIR", nargs="?", type=Path,
        help="run directory, or one with study.csv, surface.csv, boundary.csv or records (*.jsonl)",
    )
    parser.add_argument("--out", type=Path, help="folder of the pictures (default: DIR)")
    parser.add_argument("--field", default="", help="fields to draw, by commas (default: all)")
    parser.add_argument("--time", type=float, help="draw the snapshot nearest to this time in s (default: the last)")
    parser.add_argument("--format", choices=("png", "pdf", "svg"), default="png", help="kind of the still pictures")
    parser.add_argument(
        "--movie", choices=_MOVIES, default="gif", help="kind of the moving picture; both: GIF and MP4 (default: gif)"
    )
    parser.add_argument("--dpi", type=int, default=160, help="pixels an inch of a PNG (default: 160)")
    parser.add_argument(
        "--slice", metavar="AXIS[=PLACE]", default="", help="plane of a flow, such as y=0.5 (default: z, its middle)"
    )
    parser.add_argument("--norm", help="error column of a study (default: the first that meshes make small)")
    parser.add_argument(
        "--report", action="store_true", help="write one page, report.html, of all records of DIR, and nothing else"
    )
    parser.add_argument("--verdicts", type=Path, help="with --report: verdicts that drogue-perf report --baseline wrote")
    parser.add_argument("--quiet", action="store_true", help="do not print the names of the pictures")
    parser.add_argument("--version", action="store_true", help="print the versions and stop")
    options = parser.parse_args(words)
    if not options.version and options.directory is None:
        parser.error("the run directory is missing")
    if not 20 <= options.dpi <= 1200:
        parser.error(f"--dpi {options.dpi} is outside 20 to 1200")
    if options.time is not None and not math.isfinite(options.time):
        parser.error(f"--time {options.time} is not finite")
    options.movie = _MOVIES[options.movie]
    return options


def _validated_fields(wanted: str, present: list[str]) -> list[str]:
    """Names of the comma-separated list `wanted`; raises Failure (USAGE) if the run lacks one of them."""
    names = [name.strip() for name in wanted.split(",") if name.strip()]
    for name in names:
        if name not in present:
            near = difflib.get_close_matches(name, present, 1, cutoff=0.75)
            hint = f"nearest is {near[0]}" if near else f"it has {', '.join(present) or 'none'}"
            raise Failure(
                USAGE, f"The run has no field '{name}'; {hint}; output.fields of its scene chooses what a run writes."
            )
    return names


def _selected_fields(run, wanted: str) -> list[str]:
    """Cell fields to draw: the list of --field, else all of them with rho, u and p first."""
    import numpy as np

    size = np.size(run.mesh["x"].values)
    present = [name for name, item in run.snapshots[-1].fields.items() if item.values.shape == (size,)]
    usual = [name for name in ("rho", "u", "p") if name in present]
    ordered = usual + [name for name in present if name not in usual]
    return _validated_fields(wanted, ordered) if wanted else ordered


def _chosen_snapshot(run, options):
    """Snapshot nearest to --time, by default the last."""
    if options.time is None:
        return run.snapshots[-1]
    return min(run.snapshots, key=lambda candidate: abs(candidate.time - options.time))


def _gas_pictures(run, options, out, save):
    from . import movie_file
    from .gas import fields_figure, movie_frames
    from .gas.exact_solution import exact_solution

    view = fields_figure.View(run, _selected_fields(run, options.field), exact_solution(run))
    if not view.fields:
        return
    snapshot = _chosen_snapshot(run, options)
    yield save(fields_figure.fields_figure(view, snapshot), "fields")
    if len(run.snapshots) >= SPACE_TIME_SNAPSHOTS:
        mapped = options.field and view.fields or [view.fields[0]]
        for name in mapped:
            yield save(fields_figure.space_time_figure(view, name), f"{SPACE_TIME}{name}")
    if len(run.snapshots) >= 2 and options.movie:
        yield from movie_file.write(out / "fields", options.movie, movie_frames.frames(view))


def _springs_pictures(run, options, out, save):
    from . import movie_file
    from .springs import fabric_figure

    view = fabric_figure.View(run)
    snapshot = _chosen_snapshot(run, options)
    yield save(fabric_figure.fabric_figure(view, snapshot), "fields", few_colours=False)
    if len(run.snapshots) >= 2 and options.movie:
        yield from movie_file.write(out / "fields", options.movie, fabric_figure.frames(view))


def _canopy_pictures(run, options, out, save):
    from . import movie_file
    from .flow import quantities
    from .flow.plane import is_flow, plane_of
    from .parachute import canopy_figure
    from .parachute.canopies import Canopies, plane_through_canopy

    known = quantities.quantities(run)
    names = _validated_fields(options.field, list(known))
    moving = [quantities.movie_name(names or list(known))] if known else []
    # Canopies are symmetric to the plane across y, through which an angled one turns.
    canopies, plane = Canopies(run), plane_of(run, options.slice or "y") if is_flow(run) else None
    if plane is not None and "=" not in options.slice:
        plane = plane_through_canopy(canopies, plane)
    view = canopy_figure.View(canopies, plane, [known[name] for name in names or moving])
    yield save(canopy_figure.canopy_figure(view, _chosen_snapshot(run, options)), "fields", few_colours=False)
    if len(run.snapshots) >= 2 and options.movie:
        view.quantities = [known[name] for name in moving]
        yield from movie_file.write(out / "fields", options.movie, canopy_figure.frames(view))


def _flow_pictures(run, options, out, save):
    from . import movie_file
    from .flow import profiles_figure, quantities, slices_figure, spectrum
    from .flow.plane import plane_of
    from .parachute.canopies import has_canopies

    known = quantities.quantities(run)
    names = _validated_fields(options.field, list(known)) or quantities.default_names(run)
    plane = plane_of(run, options.slice)
    snapshot = _chosen_snapshot(run, options)
    if has_canopies(run):
        yield from _canopy_pictures(run, options, out, save)
        names = []
    if names:
        view = slices_figure.View(plane, [known[name] for name in names])
        figure = slices_figure.slices_figure(view, snapshot)
        yield save(figure, "fields", few_colours=False)
    if names and len(run.snapshots) >= 2 and options.movie:
        moving = slices_figure.View(plane, [known[quantities.movie_name(names)]])
        yield from movie_file.write(out / "fields", options.movie, slices_figure.frames(moving))
    if (figure := profiles_figure.profiles_figure(run, snapshot)) is not None:
        yield save(figure, "profiles")
    if spectrum.is_periodic(run) and (figure := spectrum.spectrum_figure(run, snapshot)) is not None:
        yield save(figure, "spectrum")


def _require_templates():
    if importlib.util.find_spec("jinja2") is None:
        raise Failure(USAGE, "a page of records needs the Python package jinja2: run scripts/setup.sh, or install it.")


def _evidence_pages(options, evidence, out):
    _require_templates()
    from .evidence import page

    yield from page.write(evidence, out, options.format, options.dpi)


def _report(options):
    _require_templates()
    from .evidence import report
    from .evidence.records import read_records

    evidence = read_records(options.directory)
    if evidence is None:
        raise Failure(USAGE, f"{options.directory} holds no records (*.jsonl).")
    yield report.write(evidence, (options.out or options.directory) / "report.html", options.dpi, options.verdicts)


def draw(options: argparse.Namespace):
    """Generator of the paths of the written files; raises Failure (USAGE, INVALID or IO_ERROR)."""
    from . import style
    from .evidence.records import read_records
    from .gas.history_figure import history_figure
    from .options.prices_figure import prices_figure
    from .flow.history_figure import flow_history_figure
    from .flow.plane import is_flow, plane_of
    from .flow.quantities import quantities
    from .parachute.canopies import has_canopies
    from .parachute.canopies_history import canopies_history_figure
    from .parachute.forces_history import forces_history_figure
    from .run_directory import read_run
    from .springs.history_figure import springs_history_figure
    from .study_figure import check_norm, study_figure

    if options.report:
        yield from _report(options)
        return
    run = read_run(options.directory)
    # Validation precedes the first figure, so that a mistyped option leaves no files behind.
    if options.norm is not None:
        check_norm(run, options.norm)
    if is_flow(run):
        plane_of(run, options.slice)
        _validated_fields(options.field, list(quantities(run)))
    elif options.slice:
        raise Failure(USAGE, f"{options.directory} holds no fields of a flow, which --slice is for.")
    elif options.field:
        _validated_fields(options.field, list(run.snapshots[-1].fields) if run.snapshots else [])
    evidence = read_records(options.directory)
    out = options.out or options.directory

    def save(figure, name, few_colours=True):
        return style.save_figure(figure, out / f"{picture_name(name)}.{options.format}", options.dpi, few_colours)

    if is_flow(run):
        yield from _flow_pictures(run, options, out, save)
    elif run.snapshots and "x" in run.mesh:
        yield from _gas_pictures(run, options, out, save)
    elif run.snapshots and has_canopies(run):
        yield from _canopy_pictures(run, options, out, save)
    if run.snapshots and "vertices" in run.mesh:
        yield from _springs_pictures(run, options, out, save)
    # canopies_history_figure shows all of a cloth drop.
    by_column = {
        "kinetic": springs_history_figure,
        "kinetic_energy": flow_history_figure,
        "potential_energy": lambda _: None,
    }
    draw_history = next((draw for name, draw in by_column.items() if name in run.history), history_figure)
    if (figure := draw_history(run)) is not None:
        yield save(figure, "history")
    for name, draw_more in (("canopies", canopies_history_figure), ("forces", forces_history_figure)):
        if (figure := draw_more(run)) is not None:
            yield save(figure, name)
    if (figure := prices_figure(options.directory)) is not None:
        yield save(figure, "fields")
    if run.study:
        yield save(study_figure(run.scene_name, run.study, options.norm or ""), "study")
    if evidence:
        yield from _evidence_pages(options, evidence, out)


def main(words: list[str] | None = None) -> int:
    """Runs the program. Returns its exit code: 0 success, 2 usage error, 3 invalid record, 6 unreadable or unwritable file."""
    try:
        options = arguments(sys.argv[1:] if words is None else words)
        if options.version:
            write_line(_version())
            return OK
        require_one_rank()
        drawn = 0
        for file in draw(options):
            drawn += 1
            if not options.quiet:
                write_line(str(file))
        if drawn == 0:
            raise Failure(USAGE, f"{options.directory} holds nothing to draw: no fields, and too short a history.")
    except Failure as failure:
        print(failure if failure.code == INVALID else f"drogue-plot: {failure}", file=sys.stderr)
        return failure.code
    return OK
