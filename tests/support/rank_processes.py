"""Programs on several ranks of MPI."""

import os
import pathlib
import shutil

from gas_program import ENVIRONMENT

LAUNCHER = shutil.which("mpirun")
# One thread per rank, since ranks and tests share the cores. Open MPI refuses to run as root by default, and leaks memory
# at its end, which a sanitizer would report.
RANK_ENVIRONMENT = {**ENVIRONMENT, "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
           "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"}


def processes_of(launcher):
    """Process of each rank, by its number."""
    found = {}
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            parent = int((folder / "stat").read_text().rsplit(")", 1)[1].split()[1])
            if parent == launcher.pid:
                words = (folder / "environ").read_bytes().split(b"\0")
                found.update({int(word.split(b"=")[1]): int(folder.name) for word in words
                              if word.startswith(b"OMPI_COMM_WORLD_RANK=")})
        except (OSError, ValueError):
            continue  # the process has ended
    return found
