"""Entry point of drogue-plot: runs the program, in an interpreter that has the required packages."""

import contextlib
import importlib.util
import os
import sys
from pathlib import Path

from .failure import USAGE
from .program import run_program

_NEEDED = ("numpy", "matplotlib", "h5py", "PIL")


def _run_with_packages() -> int:
    if all(importlib.util.find_spec(name) for name in _NEEDED):
        try:
            from . import style  # noqa: F401  it imports all but h5py
            import h5py  # noqa: F401
        except ImportError as error:
            reason = str(error).strip().splitlines()[0]
            print(f"drogue-plot: a Python package cannot be imported: {reason}.", file=sys.stderr)
            return USAGE
        from .cli import main

        return main()
    source = Path(__file__).resolve().parents[2]
    venv = Path(os.environ.get("DROGUE_VENV") or source / "build" / "venv")
    python = venv / "bin" / "python3"
    # DROGUE_PLOT_MOVED prevents an endless loop if that environment lacks the packages too.
    # An environment of another user may be unreadable, which counts as absent.
    with contextlib.suppress(OSError):
        if python.is_file() and "DROGUE_PLOT_MOVED" not in os.environ:
            os.environ["DROGUE_PLOT_MOVED"] = "1"
            start = Path(__file__).with_name("start.py")
            os.execv(python, [str(python), "-I", "-X", "utf8", str(start), "plot", *sys.argv[1:]])
    print(
        f"drogue-plot: Python packages are missing ({', '.join(_NEEDED)}): run scripts/setup.sh, or set DROGUE_VENV "
        "to an environment made from scripts/requirements.txt.",
        file=sys.stderr,
    )
    return USAGE


sys.exit(run_program(_run_with_packages))
