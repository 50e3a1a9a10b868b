#!/usr/bin/env python3
"""Stub of drogue-gas for the test of the demo: three scenes, one of which fails on demand."""

import json
import os
import sys
from pathlib import Path

import packages  # noqa: F401, before modules that need the packages  isort: skip
import synthetic

_TOLERANCE = 6.5e-3


def main():
    words = sys.argv[1:]
    if words == ["--list-scenes"]:
        print("sod         Sod's shock tube.\nlax         Lax's shock tube.\nsod-full    The same, fine. [gpu]")
        return 0
    name, directory = words[0], Path(words[words.index("--out") + 1])
    synthetic.write_sod(directory, cells=60, snapshots=9)
    fails = name == os.environ.get("FAKE_FAILURE")
    value = 2 * _TOLERANCE if fails else 0.8 * _TOLERANCE
    checks = [
        {"name": "conservation", "value": 3e-16, "tolerance": 1e-12, "passed": True},
        {"name": "l1_density", "value": value, "tolerance": _TOLERANCE, "passed": not fails},
    ]
    result = {
        "version": "0.1.0", "git": "abc", "backend": "openmp", "threads": 2, "steps": 1234, "checks": checks,
        "errors": {"l1_density": value}, "limiter": {"touches": 0}, "timing": {"compute_s": 0.0123},
        "provenance": {"cpu": "a processor", "gpu": "", "compiler": "gcc", "date": "today"},
        "message": f"l1_density is {value:g}, above its tolerance {_TOLERANCE:g}." if fails else "",
    }
    (directory / "result.json").write_text(json.dumps(result))
    return 5 if fails else 0


sys.exit(main())
