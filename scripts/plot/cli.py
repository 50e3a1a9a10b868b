"""drogue-plot: pictures of a run directory, and the evidence page of a folder of records."""

import argparse
import difflib
import importlib.util
import re
import subprocess
import sys
from pathlib import Path

from .failure import OK, USAGE, Failure

SPACE_TIME_SNAPSHOTS = 8


def _version() -> str:
    folder = Path(__file__).resolve().parent
    git = subprocess.run(
        ["git", "-C", str(folder), "rev-parse", "--short", "HEAD"],
        capture_output=True,
        text=True,
        check=False,
    )
    import h5py
    import matplotlib

    project = (folder.parents[1] / "CMakeLists.txt").read_text()
    number = re.search(r"project\(\s*\w+\s+VERSION\s+([\d.]+)", project)
    revision = git.stdout.strip() or "unknown"
    return (
        f"drogue-plot {number.group(1) if number else 'unknown'} (git {revision})\n"
        f"matplotlib {matplotlib.__version__}, h5py {h5py.__version__}, HDF5 {h5py.version.hdf5_version}"
    )


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Failure(USAGE, f"{message}; drogue-plot --help lists the options.")


def arguments(words: list[str]) -> argparse.Namespace:
    """The options of drogue-plot, checked."""
    parser = _Parser(
        prog="drogue-plot", description="Draws the pictures of a run directory, or the evidence page of records."
    )
    parser.add_argument(
        "directory", metavar="DIR", nargs="?", type=Path,
        help="run directory, or one with study.csv, surface.csv, boundary.csv or records (*.jsonl)",
    )  # fmt: skip
    parser.add_argument("--out", type=Path, help="folder of the pictures (default: DIR)")
    parser.add_argument("--field", default="", help="fields to draw, by commas (default: all)")
    parser.add_argument(
        "--time", type=float, help="draw the snapshot nearest to this time in s (default: the last)"
    )
    parser.add_argument(
        "--format", choices=("png", "pdf", "svg"), default="png", help="kind of the still pictures"
    )
    parser.add_argument(
        "--movie", choices=("gif", "mp4", "none"), default="gif", help="kind of the moving picture"
    )
    parser.add_argument("--dpi", type=int, default=160, help="pixels an inch of a PNG (default: 160)")
    parser.add_argument("--norm", help="error column of a study (default: the first that meshes make small)")
    parser.add_argument("--quiet", action="store_true", help="do not print the names of the pictures")
    parser.add_argument("--version", action="store_true", help="print the versions and stop")
    options = parser.parse_args(words)
    if not options.version and options.directory is None:
        parser.error("the run directory is missing")
    if not 20 <= options.dpi <= 1200:
        parser.error(f"--dpi {options.dpi} is outside 20 to 1200")
    return options


def _named_fields(wanted: str, present: list[str]) -> list[str]:
    """The fields that --field names, each one that the run has."""
    names = [name.strip() for name in wanted.split(",") if name.strip()]
    for name in names:
        if name not in present:
            near = difflib.get_close_matches(name, present, 1)
            hint = f"nearest is {near[0]}" if near else f"it has {', '.join(present) or 'none'}"
            raise Failure(USAGE, f"The run has no field '{name}'; {hint}.")
    return names


def _chosen_fields(run, wanted: str) -> list[str]:
    import numpy as np

    size = np.size(run.mesh["x"].values)
    present = [name for name, item in run.snapshots[-1].fields.items() if item.values.shape == (size,)]
    usual = [name for name in ("rho", "u", "p") if name in present]
    ordered = usual + [name for name in present if name not in usual]
    return _named_fields(wanted, ordered) if wanted else ordered


def _gas_pictures(run, options, out, save):
    from . import gas_figures, gas_movie, movie
    from .exact import exact_solution

    view = gas_figures.View(run, _chosen_fields(run, options.field), exact_solution(run))
    if not view.fields:
        return
    snapshot = run.snapshots[-1]
    if options.time is not None:
        snapshot = min(run.snapshots, key=lambda candidate: abs(candidate.time - options.time))
    yield save(gas_figures.fields_figure(view, snapshot), "fields")
    if len(run.snapshots) >= SPACE_TIME_SNAPSHOTS:
        mapped = options.field and view.fields or [view.fields[0]]
        for name in mapped:
            yield save(gas_figures.space_time_figure(view, name), f"space_time_{name}")
    if len(run.snapshots) >= 2 and options.movie != "none":
        yield movie.write(out / f"fields.{options.movie}", gas_movie.frames(view))


def _springs_pictures(run, options, out, save):
    from . import movie, springs_figures

    view = springs_figures.View(run)
    snapshot = run.snapshots[-1]
    if options.time is not None:
        snapshot = min(run.snapshots, key=lambda candidate: abs(candidate.time - options.time))
    yield save(springs_figures.figure(view, snapshot), "fields")
    if len(run.snapshots) >= 2 and options.movie != "none":
        yield movie.write(out / f"fields.{options.movie}", springs_figures.frames(view))


def _evidence(options, evidence, out):
    if importlib.util.find_spec("jinja2") is None:
        raise Failure(USAGE, "a page of records needs the Python package jinja2: run scripts/setup.sh, or install it.")
    from . import evidence_page

    yield from evidence_page.write(evidence, out, options.format, options.dpi)


def draw(options: argparse.Namespace):
    """Yields the name of each picture once it is written."""
    from . import evidence_records, style
    from .history_figure import history_figure
    from .options_figure import options_figure
    from .run_directory import read
    from .springs_history import springs_history_figure
    from .study_figure import check_norm, study_figure

    run = read(options.directory)
    # Before the first picture: a mistyped option must leave nothing behind.
    if options.norm is not None:
        check_norm(run, options.norm)
    if options.field:
        _named_fields(options.field, list(run.snapshots[-1].fields) if run.snapshots else [])
    evidence = evidence_records.read(options.directory)
    out = options.out or options.directory

    def save(figure, name):
        return style.save(figure, out / f"{name}.{options.format}", options.dpi)

    if run.snapshots and "x" in run.mesh:
        yield from _gas_pictures(run, options, out, save)
    if run.snapshots and "vertices" in run.mesh:
        yield from _springs_pictures(run, options, out, save)
    draw_history = springs_history_figure if "kinetic" in run.history else history_figure
    if (figure := draw_history(run)) is not None:
        yield save(figure, "history")
    if (figure := options_figure(options.directory)) is not None:
        yield save(figure, "fields")
    if run.study:
        yield save(study_figure(run.scene_name, run.study, options.norm or ""), "study")
    if evidence:
        yield from _evidence(options, evidence, out)


def main(words: list[str] | None = None) -> int:
    """Runs the program; returns its exit code (0 done, 2 usage, 6 unreadable or unwritable file)."""
    try:
        options = arguments(sys.argv[1:] if words is None else words)
        if options.version:
            print(_version())
            return OK
        drawn = 0
        for file in draw(options):
            drawn += 1
            if not options.quiet:
                print(file)
        if drawn == 0:
            raise Failure(USAGE, f"{options.directory} holds nothing to draw: no fields, and too short a history.")
    except Failure as failure:
        print(f"drogue-plot: {failure}", file=sys.stderr)
        return failure.code
    return OK
