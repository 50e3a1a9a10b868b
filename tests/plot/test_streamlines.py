"""Streamlines of exact flows in a plane."""

import unittest

import packages  # before modules that need the packages  isort: skip
import numpy as np
from plot.flow.streamlines import Direction, Window, evenly_spaced_lines

assert packages.SOURCE

STEP, SPACING, SHORTEST = 0.02, 0.1, 0.3


class StreamlinesTest(unittest.TestCase):
    def setUp(self):
        self.x = self.y = (np.arange(64) + 0.5) / 32 - 1
        self.places = self.x + 1j * self.y[:, None]
        self.window = Window((-1.0, 1.0, -1.0, 1.0), SPACING)

    def lines(self, velocity, step=STEP):
        return evenly_spaced_lines(Direction(self.x, self.y, velocity), self.window, step, SHORTEST)

    def test_lines_of_a_stream_are_straight_evenly_spaced_and_cross_the_window(self):
        lines = self.lines(np.full(self.places.shape, 3j))
        self.assertEqual(20, len(lines))
        np.testing.assert_allclose(sorted(line.points[0].real for line in lines), np.arange(20) / 10 - 0.95)
        for line in lines:
            self.assertEqual(0, np.ptp(line.points.real))
            self.assertTrue((np.diff(line.points.imag) > 0).all())
            self.assertGreater(np.ptp(line.points.imag), 2 - 3 * STEP)
            self.assertEqual(self.window.seeds[line.seed], line.points[line.start])

    def test_lines_of_a_rotation_are_circles_to_second_order(self):
        errors = []
        for step in (STEP, STEP / 2):
            radii = [np.abs(line.points) for line in self.lines(1j * self.places, step)]
            radii = [each for each in radii if each.min() > 0.2 and each.max() < 0.95]
            self.assertGreater(len(radii), 4)
            errors.append(max(map(np.ptp, radii)))
        self.assertLess(errors[0], 5e-5)
        self.assertLess(errors[1], errors[0] / 4)

    def test_lines_have_rectangles_of_their_own_and_the_least_length(self):
        x, y = self.places.real, self.places.imag
        lines = self.lines(np.sin(3 * y) + 1j * np.sin(4 * x + 1))
        self.assertGreater(len(lines), 20)
        entered = [set(self.window.rectangles(line.points).tolist()) for line in lines]
        self.assertEqual(sum(map(len, entered)), len(set().union(*entered)))
        for line in lines:
            self.assertGreaterEqual(len(line.points) * STEP, SHORTEST - STEP)

    def test_change_of_flow_leaves_distant_lines_as_they_are(self):
        stream = np.full(self.places.shape, 1j)
        before, after = self.lines(stream), self.lines(stream + (np.abs(self.places - 0.5) < 0.3))
        distant = [[line.points.tolist() for line in lines if line.points.real.max() < 0] for lines in (before, after)]
        self.assertEqual(10, len(distant[0]))
        self.assertEqual(*distant)
        self.assertNotEqual([line.points.tolist() for line in before], [line.points.tolist() for line in after])

    def test_no_line_enters_still_or_undefined_flow(self):
        for value in (0, np.nan):
            with self.subTest(value):
                velocity = np.where(self.places.real > 0, value, 1j)
                lines = self.lines(velocity)
                self.assertEqual(10, len(lines))
                self.assertLess(max(line.points.real.max() for line in lines), 2 / 32)
                self.assertEqual([], self.lines(np.full(self.places.shape, complex(value))))


if __name__ == "__main__":
    unittest.main()
