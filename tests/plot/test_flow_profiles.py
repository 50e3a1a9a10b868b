"""Velocities of synthetic flows along lines, compared with those that their scenes expect."""


import packages  # before modules that need the packages  isort: skip
import numpy as np
from drawn import PictureTest, plot, texts_of
from plot.flow.profiles import SampledLine, comparisons, sample
from plot.flow.profiles_figure import profiles_figure
from plot.run_directory import read_run
from synthetic_flow import write_flow

assert packages.SOURCE

LENGTHS = (2.0, 1.0, 1.0)
END = "[run]\nend_time = 2.0\n"
POINTS = """[[verify.profile]]
component = "x"
along = "y"
through = [1.0, 0.0, 0.5]
points = [[0.05, 0.05], [0.5, 0.4]]
tolerance = 0.2
minimum = { value = 0.0, tolerance = 0.1, at = 0.1 }
[[verify.profile]]
component = "y"
along = "x"
through = [0.0, 0.5, 0.5]
maximum = { value = 2.0, tolerance = 0.1 }
"""
EXACT = """[verify]
linf_velocity = 0.5
[verify.exact]
x = "y*t"
y = 3
z = "sin(pi*x)"
"""


def linear(time, x, y, z):
    """Velocity that is linear in each direction, u = y + 10 x + 100 z and v = x, the same at all times."""
    return {"velocity": np.stack([y + 10 * x + 100 * z, x, 0 * x], axis=-1)}


def exact(time, x, y, z):
    """Velocity of EXACT with 0.25 added to u in the upper half."""
    return {"velocity": np.stack([y * time + 0.25 * (y > 0.5), 3 + 0 * x, np.sin(np.pi * x)], axis=-1)}


class FlowProfiles(PictureTest):
    def run_of(self, fields_at, verify, cells=(16, 8, 1), times=(2.0,), **options):
        """Path of a run directory whose scene ends in END and `verify`."""
        folder = write_flow(self.folder / "run", cells, LENGTHS, fields_at, times, **options)
        with (folder / "scene.toml").open("a") as scene:
            scene.write(END + verify)
        return folder

    def comparisons_of(self, *arguments, **options):
        run = read_run(self.run_of(*arguments, **options))
        return comparisons(run, run.snapshots[-1])

    def test_interpolates_cubic_polynomials_exactly(self):
        """Up to half a cell beyond the outermost centres, where walls are."""
        places = (np.arange(6) + 0.5) / 6

        def cubic(x):
            return 1 - 2 * x + 3 * x**2 - 4 * x**3

        at = np.array([0.0, 0.1, 0.25, 0.3, 0.77, 1.0])
        for where in (places, places**2):
            np.testing.assert_allclose(SampledLine(where, cubic(where))(at), cubic(at), atol=1e-13)

    def test_finds_extremes_between_cells(self):
        places = (np.arange(20) + 0.5) / 20
        line = SampledLine(places, -((places - 0.487) ** 2))
        np.testing.assert_allclose(line.extremum(1), (0.487, 0), atol=1e-3)
        np.testing.assert_allclose(line.extremum(-1), (places[-1], -((places[-1] - 0.487) ** 2)))

    def test_line_passes_through_point(self):
        """Values between cells are linear across the line; the outermost ones hold up to an open side."""
        run = read_run(self.run_of(linear, "", cells=(16, 8, 4), is_open=True))
        for through, x, z in (((1.03, 0.0, 0.4), 1.03, 0.4), ((0.0, 0.0, 0.5), 0.0625, 0.5)):
            with self.subTest(through=through):
                line = sample(run, run.snapshots[0], 0, 1, through)
                np.testing.assert_allclose(line([0.2, 0.7]), np.array([0.2, 0.7]) + 10 * x + 100 * z)

    def test_line_passes_through_point_of_a_stretched_grid(self):
        """Linear velocities are met exactly, also between the outermost cells across a periodic side."""
        for is_open, through, expected in ((True, (1.03, 0.0, 0.4), 1.03), (True, (0.0, 0.0, 0.4), None), (False, (0.0, 0.0, 0.4), None)):
            run = read_run(self.run_of(linear, "", cells=(16, 8, 4), is_open=is_open, growth=1.1))
            faces = run.mesh["x"].values
            first, last = faces[1] / 2, (faces[-1] + faces[-2]) / 2
            before = first + 2.0 - last  # distance of both over the side
            x = expected or (first if is_open else (first * (before - first) + last * first) / before)
            line = sample(run, run.snapshots[0], 0, 1, through)
            np.testing.assert_allclose(line([0.2, 0.7]), np.array([0.2, 0.7]) + 10 * x + 100 * 0.4)

    def test_line_at_periodic_side_uses_both_sides(self):
        run = read_run(self.run_of(linear, ""))
        line = sample(run, run.snapshots[0], 0, 1, (0.0, 0.0, 0.5))
        np.testing.assert_allclose(line([0.2]), 0.2 + 10 * (0.0625 + 1.9375) / 2 + 50)
        # A place outside the domain is that of its periodic image.
        np.testing.assert_allclose(sample(run, run.snapshots[0], 0, 1, (2.3, 0.0, 0.5))([0.2]), 0.2 + 3 + 50)

    def test_deviation_is_that_of_points(self):
        first, second = self.comparisons_of(linear, POINTS)
        np.testing.assert_allclose(first.deviations(), [[0.05, 0.5], [60.0, 60.1]])
        self.assertEqual((0.2, ((-1, 0.1, 0.0, 0.1),)), (first.tolerance, first.extremes))
        self.assertEqual((0, ((1, None, 2.0, 0.1),)), (len(second.points), second.extremes))

    def test_exact_velocity_is_compared_where_it_varies(self):
        found = self.comparisons_of(exact, EXACT)
        self.assertEqual([(2, 0), (0, 1)], [(item.component, item.along) for item in found])
        np.testing.assert_allclose(found[0].deviations()[1], 0, atol=1e-14)
        places, deviation = found[1].deviations()
        np.testing.assert_allclose(deviation, np.where(places > 0.5, 0.25, 0), atol=1e-14)
        self.assertEqual(0.5, found[1].tolerance)

    def test_exact_velocity_is_that_of_the_centre_of_two_faces(self):
        """The mean of x^2 at both faces is larger than x^2 at the centre by a quarter of the squared width."""

        def of_faces(time, x, y, z):
            faces = [(x + side * LENGTHS[0] / 32) ** 2 for side in (-1, 1)]
            return {"velocity": np.stack([sum(faces) / 2, 0 * x, 0 * x], axis=-1)}

        (found,) = self.comparisons_of(of_faces, '[verify]\nlinf_velocity = 0.5\nexact = { x = "x^2", y = 0, z = 0 }\n')
        np.testing.assert_allclose(found.deviations()[1], 0, atol=1e-14)

    def test_velocities_are_expected_at_end_only(self):
        run = read_run(self.run_of(exact, EXACT + POINTS, times=(1.0, 2.0)))
        self.assertEqual([0, 4], [len(comparisons(run, snapshot)) for snapshot in run.snapshots])
        self.assertIsNone(profiles_figure(run, run.snapshots[0]))

    def test_lines_of_few_or_undefined_values_are_left_out(self):
        def undefined(time, x, y, z):
            return {"velocity": np.where(y[..., None] > 0.5, np.nan, linear(time, x, y, z)["velocity"])}

        self.assertEqual([], self.comparisons_of(linear, POINTS, cells=(3, 3, 1)))
        self.assertEqual([], self.comparisons_of(undefined, POINTS))
        self.assertEqual([], self.comparisons_of(lambda time, x, y, z: {"pressure": x}, POINTS))

    def test_program_draws_profiles_at_end(self):
        folder = self.run_of(linear, POINTS, times=(0.0, 2.0))
        for words, expected in ((("--time", "0"), False), ((), True)):
            code, files, _ = plot(folder, "--movie", "none", *words)
            self.assertEqual((0, expected), (code, "profiles.png" in files))

    def test_shows_deviation_with_tolerance(self):
        run = read_run(self.run_of(exact, EXACT))
        deviation, values = profiles_figure(run, run.snapshots[0]).axes[2:]
        self.assertEqual("velocity along x (m/s)", values.get_title(loc="left"))
        self.assertEqual("y (m) at x = 1.062 m", deviation.get_xlabel())
        self.assertEqual("off by 0.25 m/s (tolerance 0.5)", deviation.get_title(loc="left"))
        levels = [line.get_ydata()[0] for line in deviation.lines if line.get_linestyle() == "--"]
        self.assertEqual([-0.5, 0.5], levels)

    def test_round_off_does_not_look_like_deviation(self):
        run = read_run(self.run_of(exact, EXACT))
        deviation = profiles_figure(run, run.snapshots[0]).axes[0]
        self.assertEqual([], list(deviation.lines))
        self.assertEqual("off by round-off (tolerance 0.5)", deviation.get_title(loc="left"))

    def assert_is_legible(self, figure):
        """No drawn text overlaps another one or an axis line above it, or leaves the figure."""
        texts = texts_of(figure)
        for box, text in zip(self.assert_apart(texts, figure.bbox), texts):
            self.assertFalse(any(box.overlaps(axes.bbox) for axes in figure.axes), text.get_text())
        return texts

    def test_text_is_legible(self):
        run = read_run(self.run_of(exact, EXACT + POINTS))
        self.assertGreater(len(self.assert_is_legible(profiles_figure(run, run.snapshots[0]))), 40)

    def test_small_deviations_are_legible(self):
        """Powers of ten make titles and labels long, in the figure of one column too."""

        def shifted(time, x, y, z):
            return {"velocity": np.stack([y + 9.77e-4, 0 * x, 0 * x], axis=-1)}

        verify = '[verify]\nlinf_velocity = 1.12e-3\nexact = { x = "y", y = 0, z = 0 }\n'
        run = read_run(self.run_of(shifted, verify))
        self.assert_is_legible(profiles_figure(run, run.snapshots[0]))
