"""The spectral method for the vortices of Taylor and Green against their power series in time, and the scenes against both."""

import tomllib
import unittest
from fractions import Fraction

import packages  # noqa: F401, before modules that need the packages  isort: skip
import taylor_green

SCENES = packages.SOURCE / "miniapps/parachute/scenes"
TABLE = packages.SOURCE / "docs/evidence/taylor-green-1600.txt"


def rows_of(text):
    return {row[0]: (row[1], row[2]) for row in (tuple(map(float, line.split())) for line in text.splitlines()[1:])}


class TaylorGreen(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.series = taylor_green.enstrophy_series(5)

    def series_at(self, time, viscosity):
        """Energy and dissipation by the series of the enstrophy, whose mean is 3/8 at the start."""
        rate = 2 * viscosity * 0.375 * taylor_green.VOLUME
        powers = [sum(float(value) * viscosity**m for m, value in enumerate(line)) for line in self.series]
        energy = taylor_green.VOLUME / 8 - rate * sum(c * time ** (n + 1) / (n + 1) for n, c in enumerate(powers))
        return energy, rate * sum(c * time**n for n, c in enumerate(powers))

    def test_series_is_that_of_taylor_and_green_1937(self):
        """Their coefficients for equal wave numbers, with Reynolds number 1 / nu."""
        self.assertEqual([1], self.series[0])
        self.assertEqual([0, -6], self.series[1])
        self.assertEqual([Fraction(5, 48), 0, 18], self.series[2])
        self.assertEqual([0, Fraction(-5, 3), 0, -36], self.series[3])
        self.assertEqual([Fraction(50, 99 * 64), 0, Fraction(1835, 9 * 16), 0, 54], self.series[4])

    def test_spectral_method_follows_the_series(self):
        for reynolds, end, tolerance in ((1600, 0.4, 1e-5), (50, 0.2, 1e-5)):
            *_, (time, energy, dissipation) = taylor_green.curve(8, end, end / 2, reynolds)
            expected = self.series_at(time, 1 / reynolds)
            self.assertEqual(end, time)
            self.assertAlmostEqual(1, energy / expected[0], delta=1e-8)
            self.assertAlmostEqual(1, dissipation / expected[1], delta=tolerance)

    def test_viscosity_takes_the_energy_that_the_flow_loses(self):
        rows = list(taylor_green.curve(12, 2.0, 0.02, 400))
        for (t0, before, _), (t1, _, rate), (t2, after, _) in zip(rows, rows[1:], rows[2:], strict=False):
            self.assertAlmostEqual(1, (before - after) / (t2 - t0) / rate, delta=1e-4, msg=str(t1))

    def test_table_holds_the_early_curve(self):
        table = rows_of(TABLE.read_text(encoding="utf-8"))
        for time, energy, dissipation in taylor_green.curve(26, 3.0, 1.0, 1600):
            self.assertAlmostEqual(1, energy / table[time][0], delta=1e-6)
            self.assertAlmostEqual(1, dissipation / table[time][1], delta=1e-4)

    def test_scenes_expect_the_table(self):
        table = rows_of(TABLE.read_text(encoding="utf-8"))
        for name in ("taylor-green-3d", "taylor-green-3d-full"):
            verify = tomllib.loads((SCENES / f"{name}.toml").read_text(encoding="utf-8"))["verify"]
            for key, column in (("kinetic_energy_curve", 0), ("dissipation_curve", 1)):
                points = [point for curve in verify[key] for point in curve["points"]]
                self.assertEqual(list(range(1, 10)), [time for time, _ in points], (name, key))
                for time, value in points:
                    self.assertAlmostEqual(1, value / table[time][column], delta=5e-5, msg=f"{name} {key} {time}")
