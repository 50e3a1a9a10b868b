"""Scripts that make records: arithmetic on files with known results, rows of a stand-in for drogue-parachute."""

import contextlib
import io
import json
import os
import sys
from unittest import mock

import packages  # before modules that need the packages  isort: skip
from folder_test import FolderTest
import h5py
import numpy as np
import record_parachute
import record_springs
import recording

# Scenes that pass, fail, last, and refuse ranks.
PROGRAM = """\
#!/bin/sh
if [ "$1" = --list-scenes ]; then
  printf '%s  A scene.\\n' passes fails lasts alone passes-full
  exit
fi
echo "$1 $3 ${RANKS:-1}" >> FOLDER/runs
case $1 in
  lasts) exec sleep 60 ;;
  alone) if [ -n "$RANKS" ]; then echo "drogue-parachute: works on one rank" >&2; exit 2; fi ;;
esac
mkdir -p "$7"
echo '{"steps": 3, "checks": [], "pressure": {"solver": "fft"}, "timing": {"wall_s": 0.5}}' > "$7/result.json"
if [ "$1" = fails ]; then echo "drogue-parachute: a check failed" >&2; exit 1; fi
"""
# Like mpirun, with words of its own on stderr after a failure.
LAUNCHER = """\
#!/bin/sh
while [ "$1" != -n ]; do shift; done
export RANKS=$2
shift 2
"$@" || { code=$?; echo "mpirun detected that a process failed" >&2; exit $code; }
"""


def _write_strip(file, strain, poisson, columns=10, rows=4):
    """Writes a triangulated strip of 0.1 x 0.02 m that is stretched along x and free to contract."""
    place = {(i, j): j * (columns + 1) + i for j in range(rows + 1) for i in range(columns + 1)}
    rest = np.array([(0.1 * i / columns, 0.02 * j / rows, 0.0) for j in range(rows + 1) for i in range(columns + 1)])
    corners = [(place[i, j], place[i + 1, j], place[i, j + 1], place[i + 1, j + 1])
               for i in range(columns) for j in range(rows)]
    triangles = [triangle for a, b, c, d in corners for triangle in ((a, b, d), (a, d, c))]
    with h5py.File(file, "w") as h5:
        h5["mesh/vertices"], h5["mesh/triangles"] = rest, np.array(triangles)
        h5["steps/000000/position"] = rest
        h5["steps/000001/position"] = rest * [1 + strain, 1 - poisson * strain, 1.0]


class ParachuteRecords(FolderTest):
    def record(self, *words):
        """Exit code, rows by scene and ranks, and printed lines of a record of a stand-in for the program."""
        for name, text in (("drogue-parachute", PROGRAM), ("mpirun", LAUNCHER)):
            (self.folder / name).write_text(text.replace("FOLDER", str(self.folder)))
            (self.folder / name).chmod(0o755)
        folders = ["--bin", self.folder, "--work", self.folder / "work", "--to", self.folder]
        line = ["record_parachute.py", "test", *map(str, folders), "--backends", "serial", *words]
        path = f"{self.folder}{os.pathsep}{os.environ['PATH']}"
        with (mock.patch.object(sys, "argv", line), mock.patch.dict(os.environ, {"PATH": path}),
              contextlib.redirect_stdout(io.StringIO()) as printed):
            code = record_parachute.main()
        rows = json.loads((self.folder / "parachute-test.json").read_text())["runs"]
        return code, {(row["scene"], row["ranks"]): row for row in rows}, printed.getvalue().splitlines()

    def runs(self):
        return (self.folder / "runs").read_text().splitlines()

    def test_every_small_scene_has_a_row_of_each_number_of_ranks(self):
        code, rows, lines = self.record("--ranks", "1,2", "--skip", "lasts")
        self.assertEqual((1, 8), (code, len(rows)))
        passed = [rows["passes", 2][key] for key in ("exit_code", "steps", "solver", "wall_s")]
        self.assertEqual([0, 3, "fft", 0.5], passed)
        self.assertEqual(1, rows["fails", 2]["exit_code"])
        self.assertEqual("drogue-parachute: a check failed", rows["fails", 2]["message"])
        self.assertEqual("drogue-parachute: works on one rank", rows["alone", 2]["refused"])
        self.assertEqual(0, rows["alone", 1]["exit_code"])
        self.assertEqual("left out by --skip 'lasts'", rows["lasts", 1]["not_run"])
        self.assertIn("8 runs, 2 failed", lines)
        self.assertIn("not_run: lasts, serial, ranks 2: left out by --skip 'lasts'", lines)
        self.assertNotIn("lasts serial 1", self.runs())

    def test_limit_stops_a_run_that_a_later_call_repeats(self):
        code, rows, _ = self.record("--ranks", "1", "--only", "^(passes|lasts)", "--limit", "0.5", "--full")
        self.assertEqual({("passes", 1), ("lasts", 1), ("passes-full", 1)}, set(rows))
        self.assertEqual((0, "stopped after 0.5 s"), (code, rows["lasts", 1]["not_run"]))
        _, rows, _ = self.record("--ranks", "1", "--only", "^lasts", "--limit", "0.25", "--add")
        self.assertEqual(3, len(rows))
        self.assertEqual("stopped after 0.25 s", rows["lasts", 1]["not_run"])
        self.assertEqual((1, 2), (self.runs().count("passes serial 1"), self.runs().count("lasts serial 1")))
        _, rows, _ = self.record("--ranks", "2", "--skip", "lasts", "--add")
        self.assertEqual("stopped after 0.25 s", rows["lasts", 1]["not_run"])


    def test_table_counts_scenes_and_names_those_that_did_not_pass(self):
        _, _, lines = self.record("--ranks", "1,2", "--skip", "lasts")
        self.assertEqual(["| ranks | backend | passed | failed | refuse several ranks | not run |", "|---:|---|---:|---|---|---|",
                          "| 1 | serial | 2 of 4 | `fails` |  | `lasts` |", "| 2 | serial | 1 of 4 | `fails` | `alone` | `lasts` |"],
                         [line for line in lines if line.startswith("|")])
        self.assertEqual("| 1 | serial | 0 of 1 |  |  | `new` |",
                         record_parachute.table([{"ranks": 1, "backend": "serial", "scene": "old"}], ["new"]).splitlines()[2])

    def test_readme_holds_the_table_of_the_record(self):
        rows = json.loads((packages.SOURCE / "docs/evidence/parachute-epyc.json").read_text(encoding="utf-8"))["runs"]
        names = sorted(path.stem for path in (packages.SOURCE / "miniapps/parachute/scenes").glob("*.toml"))
        table = record_parachute.table(rows, [name for name in names if not name.endswith("-full")])
        text = (packages.SOURCE / "miniapps/parachute/README.md").read_text(encoding="utf-8")
        self.assertTrue(table + "\n" in text, f"the README lacks:\n{table}")


class Records(FolderTest):
    def test_response_of_strip_is_that_of_material(self):
        _write_strip(self.folder / "fields.h5", 1e-6, 0.3)
        found = record_springs.response(self.folder / "fields.h5", 5000.0, 0.3)
        self.assertAlmostEqual(found["modulus"], 1.0, delta=1e-5)
        self.assertAlmostEqual(found["poisson"], 0.3, delta=1e-6)
        self.assertAlmostEqual(found["largest_poisson"], 0.3, delta=1e-6)
        # Four edges pull at the end, the corner has half of one.
        self.assertAlmostEqual(found["modulus_without_a_corner"], 7 / 8, delta=1e-5)
        _, _, force = record_springs.end_forces(self.folder / "fields.h5", 5000.0, 0.3)
        self.assertLess(np.abs(force.sum(axis=0)).max(), 1e-12)
        other = record_springs.response(self.folder / "fields.h5", 2500.0, 0.0)
        self.assertAlmostEqual(other["modulus"], 1.0, delta=1e-5)

    def test_mean_difference_weights_by_time(self):
        time, first, second = [0.0, 3.0, 4.0], [1.0, 1.0, 5.0], [3.0, 3.0, 5.0]
        self.assertAlmostEqual(record_springs.mean_difference(time, first, second), 7 / 4)
        self.assertAlmostEqual(record_springs.mean_difference(time, first, second, 2), np.sqrt(14 / 4))

    def test_finds_datasets_and_histories_that_differ(self):
        for name, strain in (("a", 1e-6), ("b", 1e-6), ("c", 1e-6)):
            (self.folder / name).mkdir()
            _write_strip(self.folder / name / "fields.h5", strain, 0.3)
        a, b, c = (self.folder / name for name in "abc")
        with h5py.File(c / "fields.h5", "r+") as h5:
            h5["steps/000001/position"][3, 0] = np.nextafter(h5["steps/000001/position"][3, 0], 1.0)
        self.assertEqual([], recording.differing_results(a, b))
        self.assertEqual(["000001/position"], recording.differing_results(a, c))
        for folder, text in ((a, "1\n"), (b, "1\n"), (c, "2\n")):
            (folder / "history.csv").write_text(text)
        self.assertEqual([], recording.differing_results(a, b))
        self.assertEqual(["000001/position", "history.csv"], recording.differing_results(a, c))
        (b / "fields.h5").unlink()
        self.assertEqual(["fields.h5 of one run alone"], recording.differing_results(a, b))
        for folder in (a, c):
            (folder / "fields.h5").unlink()
        self.assertEqual(([], ["history.csv"]), (recording.differing_results(a, b), recording.differing_results(a, c)))
        for folder in (a, b):
            (folder / "history.csv").unlink()
        self.assertEqual(["neither fields nor history"], recording.differing_results(a, b))
