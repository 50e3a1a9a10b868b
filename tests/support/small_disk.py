"""A file system of its own for tests that fill it."""

import contextlib
import subprocess
import unittest


@contextlib.contextmanager
def mounted(place, options):
    """Mounts a file system in memory at `place`, a folder that is created if missing."""
    place.mkdir(exist_ok=True)
    if subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", place], capture_output=True).returncode:
        raise unittest.SkipTest("no right to mount")
    try:
        yield place
    finally:
        subprocess.run(["umount", place], check=True)
