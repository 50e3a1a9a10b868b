"""Arithmetic of scripts/record_springs.py and scripts/recording.py on files with known results."""

import shutil
import tempfile
import unittest
from pathlib import Path

import packages  # before modules that need the packages  isort: skip
import h5py
import numpy as np
import record_springs
import recording


def _write_strip(file, strain, poisson, columns=10, rows=4):
    """Writes a triangulated strip of 0.1 x 0.02 m that is stretched along x and free to contract."""
    place = {(i, j): j * (columns + 1) + i for j in range(rows + 1) for i in range(columns + 1)}
    rest = np.array(
        [(0.1 * i / columns, 0.02 * j / rows, 0.0) for j in range(rows + 1) for i in range(columns + 1)]
    )
    corners = [(place[i, j], place[i + 1, j], place[i, j + 1], place[i + 1, j + 1])
               for i in range(columns) for j in range(rows)]  # fmt: skip
    triangles = [triangle for a, b, c, d in corners for triangle in ((a, b, d), (a, d, c))]
    with h5py.File(file, "w") as h5:
        h5["mesh/vertices"], h5["mesh/triangles"] = rest, np.array(triangles)
        h5["steps/000000/position"] = rest
        h5["steps/000001/position"] = rest * [1 + strain, 1 - poisson * strain, 1.0]


class Records(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

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
            (folder / "fields.h5").unlink()
            (folder / "history.csv").write_text(text)
        self.assertEqual(
            ([], ["history.csv"]), (recording.differing_results(a, b), recording.differing_results(a, c))
        )


if __name__ == "__main__":
    unittest.main()
