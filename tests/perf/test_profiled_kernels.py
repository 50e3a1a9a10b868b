"""Kernels in the recorded profiles, and those that docs/perf-reference.md names as missing there, are all that the sources have."""

import json
import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["DROGUE_SOURCE"])
NAME = re.compile(r"\w+Functor")


def in_sources():
    """Names of the functors of kernels/."""
    files = [*(SOURCE / "kernels").rglob("*.hpp"), *(SOURCE / "kernels").rglob("*.cpp")]
    return {name for file in files for name in re.findall(r"\bstruct (\w+Functor)\b", file.read_text(encoding="utf-8"))}


def in_records():
    """Names of the functors in the records of profiles."""
    files = sorted((SOURCE / "docs/evidence").glob("occupancy-profile-*.jsonl"))
    facts = [json.loads(line)["facts"] for file in files for line in file.read_text(encoding="utf-8").splitlines()]
    return {name for row in facts for name in NAME.findall(row.get("kernel", ""))}


def in_table():
    """Names in the table of functors without a row, and their number with repetitions."""
    text = (SOURCE / "docs/perf-reference.md").read_text(encoding="utf-8").partition("| functors | why |")[2].partition("\n\n")[0]
    rows = [line.split("|")[1] for line in text.splitlines() if line.startswith("| `")]
    return [name for row in rows for name in NAME.findall(row)]


class ProfiledKernels(unittest.TestCase):
    def test_every_kernel_is_profiled_or_named(self):
        sources, records, table = in_sources(), in_records(), in_table()
        self.assertGreater(len(records & sources), 90)
        self.assertEqual(sorted(set(table)), sorted(table))
        self.assertEqual(sorted(sources - records), sorted(table))
