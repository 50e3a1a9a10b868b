"""Runs shipped scenes of every mini-app that exists and makes one page of their results and pictures."""

import argparse
import json
import os
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from ..failure import INTERRUPTED, IO_ERROR, OK, USAGE, Failure
from ..checks import check_label, main_check
from . import options, pictures
from .page import write_page


@dataclass(frozen=True)
class App:
    """Mini-app: program and title on the page."""

    program: str
    title: str


APPS = (
    App("drogue-gas", "Gas dynamics"),
    App("drogue-springs", "Cloth and strings"),
    App("drogue-parachute", "Flow and parachutes"),
)
OPTIONS = App("drogue-options", "Options")
BATCH = options.BATCH
# Some of every mini-app, in this order; the last one is an opening parachute.
SHOWN = (
    "sod", "shu-osher", "blast", "catenary", "drum", "table-cloth", BATCH, "taylor-green-2d", "cavity", "shear-layer",
    "c9-flat",
)


@dataclass
class SceneRun:
    """Run of one scene: result, figures, and exit code."""

    app: App
    name: str
    sentence: str
    directory: Path
    command: str = ""
    exit_code: int = OK
    message: str = ""
    result: dict = field(default_factory=dict)
    pictures: list[Path] = field(default_factory=list)

    @property
    def main_check(self) -> dict:
        """Check shown in the table."""
        return main_check(self.result)

    @property
    def passed(self) -> bool:
        return self.exit_code == OK


def _run(*command) -> subprocess.CompletedProcess:
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)


def shipped_scenes(program: Path) -> list[tuple[str, str]]:
    """Names and descriptions of the scenes of a program, without those marked [gpu]; raises Failure (IO_ERROR)."""
    done = _run(program, "--list-scenes")
    if done.returncode != OK:
        raise Failure(IO_ERROR, f"{program} --list-scenes failed: {done.stderr.strip() or done.returncode}.")
    lines = [line.strip() for line in done.stdout.splitlines() if line.strip()]
    return [tuple((line.split(None, 1) + [""])[:2]) for line in lines if not line.endswith("[gpu]")]


def run_scene(program: Path, run: SceneRun) -> None:
    """Runs a scene as shipped and stores its result in `run`; its output goes to a log beside the run directory."""
    run.command = f"{run.app.program} {run.name}"
    done = _run(program, run.name, "--out", run.directory, "--overwrite", "--quiet")
    run.directory.with_suffix(".log").write_text(done.stdout + done.stderr)
    run.exit_code = done.returncode
    file = run.directory / "result.json"
    if file.is_file():
        run.result = json.loads(file.read_text())
    if not run.passed:
        last = (done.stderr.strip() or f"it ended with exit code {done.returncode}").splitlines()[-1]
        run.message = run.result.get("message") or last
    elif not run.result:
        raise Failure(IO_ERROR, f"{run.command} wrote no result.json into {run.directory}.")


_ROW = "{:<28} {:<8} {:>8}  {:<24} {:>10} {:>9}  {}"


def format_seconds(value: float | None) -> str:
    """Time with three significant digits in ms or s."""
    if value is None:
        return "-"
    return f"{value * 1e3:.3g} ms" if value < 1 else f"{value:.3g} s"


def table_row(run: SceneRun) -> str:
    """Line of the printed table."""
    check, result = run.main_check, run.result
    name = check_label(check.get("name", ""))
    error = f"{name} {check['value']:.3g}" if check.get("value") is not None else "-"
    tolerance = f"{check['tolerance']:.3g}" if check else "-"
    time = format_seconds(result.get("timing", {}).get("compute_s"))
    end = "" if run.passed else "FAILED"
    return _ROW.format(
        run.name, result.get("backend", "-"), result.get("steps", "-"), error, tolerance, time, end
    ).rstrip()


def _arguments(words):
    parser = argparse.ArgumentParser(prog="demo", description=__doc__)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the programs")
    parser.add_argument("--out", type=Path, required=True, help="folder of the page")
    parser.add_argument("--all", action="store_true", help="run every shipped scene that needs no GPU")
    parser.add_argument("scenes", nargs="*", help=f"scenes to run (default: {', '.join(SHOWN)})")
    return parser.parse_args(words)


def _selected_runs(arguments) -> list[SceneRun]:
    runs = []
    for app in APPS:
        program = arguments.bin / app.program
        if program.is_file():
            for name, sentence in shipped_scenes(program):
                directory = arguments.out / app.program.removeprefix("drogue-") / name
                runs.append(SceneRun(app, name, sentence, directory))
    if (arguments.bin / OPTIONS.program).is_file():
        sentence = "American and European options by finite differences, against the Fourier methods."
        runs.append(SceneRun(OPTIONS, BATCH, sentence, arguments.out / "options" / BATCH))
    unknown = set(arguments.scenes) - {run.name for run in runs}
    if unknown:
        raise Failure(USAGE, f"There is no scene {sorted(unknown)[0]}: the list is {', '.join(r.name for r in runs)}.")
    if not runs:
        raise Failure(USAGE, f"{arguments.bin} holds no mini-app with scenes: build first.")
    if arguments.all:
        return runs
    wanted = arguments.scenes or SHOWN
    return sorted((run for run in runs if run.name in wanted), key=lambda run: wanted.index(run.name))


def demo(words=None) -> int:
    """Runs the scenes and writes the page; returns 0, or the exit code of the first scene that failed."""
    arguments = _arguments(words)
    runs = _selected_runs(arguments)
    print(_ROW.format("scene", "backend", "steps", "error", "tolerance", "time", "").rstrip())
    for run in runs:
        run.directory.parent.mkdir(parents=True, exist_ok=True)
        program = arguments.bin / run.app.program
        if run.app is OPTIONS:
            options.run_batch(program, run)
        else:
            run_scene(program, run)
        print(table_row(run), flush=True)
    # Figures are drawn after all runs, since drawing would disturb their times.
    with ProcessPoolExecutor(max_workers=os.cpu_count()) as pool:
        jobs = [pool.submit(pictures.draw, run.directory) for run in runs]
        for run, job in zip(runs, jobs):
            run.pictures, problem = job.result()
            if problem and run.passed:
                run.exit_code, run.message = problem
    page = write_page(arguments.out / "index.html", runs)
    print(f"\npage:     {page}\npictures: {arguments.out}/*/*/*.png")
    failed = [run for run in runs if not run.passed]
    if failed:
        more = f" ({len(failed)} of {len(runs)} scenes failed)" if len(failed) > 1 else ""
        print(f"demo: {failed[0].command} failed: {failed[0].message.rstrip('.')}{more}.", file=sys.stderr)
        return failed[0].exit_code
    return OK


def main() -> int:
    try:
        return demo()
    except Failure as failure:
        print(f"demo: {failure}", file=sys.stderr)
        return failure.code
    except OSError as error:
        print(f"demo: {error.filename}: {error.strerror}.", file=sys.stderr)
        return IO_ERROR
    except KeyboardInterrupt:
        print("demo: interrupted.", file=sys.stderr)
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
