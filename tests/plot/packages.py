"""Re-executes a test in an interpreter that has the packages of the pictures. Import it before all others."""

import importlib.util
import os
import sys
from pathlib import Path

SOURCE = Path(os.environ.get("DROGUE_SOURCE") or Path(__file__).resolve().parents[2])
sys.path[:0] = [str(SOURCE / "scripts"), str(SOURCE / "scripts/studies")]

if not all(importlib.util.find_spec(name) for name in ("numpy", "matplotlib", "h5py", "PIL", "jinja2")):
    _venv = Path(os.environ.get("DROGUE_VENV") or SOURCE / "build" / "venv")
    if not (_venv / "bin" / "python3").is_file() or os.path.samefile(sys.prefix, _venv):
        raise RuntimeError(
            f"{_venv} has no Python with the packages of scripts/requirements.txt: run scripts/setup.sh."
        )
    os.execv(_venv / "bin" / "python3", [str(_venv / "bin" / "python3"), *sys.orig_argv[1:]])
