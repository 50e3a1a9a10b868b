"""`matplotlib` as it was installed: without the user's backend, matplotlibrc and styles. Import it before its parts."""

import logging
import os
from pathlib import Path


def _import():
    """matplotlib reads the first matplotlibrc of the working folder, MATPLOTLIBRC and the user's settings, and fails on a bad one."""
    os.environ.pop("MPLBACKEND", None)
    os.environ["MATPLOTLIBRC"] = os.devnull
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # it warns of an MPLCONFIGDIR that it cannot make
    working_folder = os.open(".", os.O_PATH)
    try:
        os.chdir(Path(__file__).parent)
        import matplotlib
    finally:
        os.fchdir(working_folder)
        os.close(working_folder)
    # The styles of the user's settings are read with pyplot.
    matplotlib.get_configdir = matplotlib.get_data_path
    matplotlib.use("Agg")
    return matplotlib


matplotlib = _import()
