"""Figures of the output of drogue-options, and the comparison of its prices in the demo."""

import packages  # before modules that need the packages  isort: skip
from folder_test import FolderTest
from drawn import plot
from PIL import Image
from plot import cli
from plot.demo.options import largest_difference
from plot.options.prices_figure import prices_figure

assert packages.SOURCE

SURFACE = "id,strike,maturity,price\na,1,0.5,0.1\na,2,0.5,1.1\na,1,1,0.2\na,2,1,1.2\nb,1,1,7\nbad,,,\n"
BOUNDARY = "id,time,spot,maturity\na,0,0.8,1\na,0.5,0.9,1\n"


class OptionsPictures(FolderTest):
    def write(self, **files):
        for name, text in files.items():
            (self.folder / f"{name}.csv").write_text(text)

    def test_draws_surface_and_boundary(self):
        self.write(surface=SURFACE, boundary=BOUNDARY)
        self.assertEqual(0, cli.main([str(self.folder), "--quiet"]))
        with Image.open(self.folder / "fields.png") as picture:
            self.assertGreater(picture.size[1], 700)
        first, second = prices_figure(self.folder).axes
        self.assertEqual([[0.1, 1.1], [0.2, 1.2]], [list(line.get_ydata()) for line in first.lines])
        self.assertEqual([[0.8, 0.9]], [list(line.get_ydata()) for line in second.lines])

    def test_label_counts_equal_curves(self):
        """Without the count, a curve drawn over an equal one would be invisible."""
        self.write(boundary=BOUNDARY + "b,0,0.8,1\nb,0.5,0.9,1\nc,0,0.7,1\nc,0.5,0.9,1\n")
        (panel,) = prices_figure(self.folder).axes
        self.assertEqual(2, len(panel.lines))
        self.assertEqual({"a (2 equal)", "c"}, {text.get_text() for text in panel.texts})

    def test_shows_a_week_and_ten_years_on_one_axis(self):
        """Curves of times to expiry that differ by more than ten times lie over the share of their times, before whose ends they end."""
        week = 7 / 365
        self.write(boundary=f"id,time,spot,maturity\nlong,0,70,10\nlong,5,80,10\nlong,7.5,100,10\n"
                            f"short,0,95,{week}\nshort,{week / 2},97,{week}\nshort,{0.75 * week},100,{week}\n")
        (panel,) = prices_figure(self.folder).axes
        self.assertEqual([[0.0, 0.5, 0.75]] * 2, [list(line.get_xdata()) for line in panel.lines])
        self.assertEqual({"long, 10 a", "short, 7 d"}, {text.get_text() for text in panel.texts})
        self.assertIn("share", panel.get_xlabel())
        self.write(boundary="id,time,spot,maturity\nlong,0,70,10\nlong,10,100,10\nshort,0,95,1\nshort,1,100,1\n")
        (panel,) = prices_figure(self.folder).axes
        self.assertEqual([[0.0, 10.0], [0.0, 1.0]], [list(line.get_xdata()) for line in panel.lines])
        self.assertEqual("time (years)", panel.get_xlabel())

    def test_rejects_file_in_place_of_folder(self):
        self.write(prices="id,price\na,1\n", surface=SURFACE)
        for name, hint in (("prices", "surface.csv"), ("surface", str(self.folder))):
            code, _, errors = plot(self.folder / f"{name}.csv")
            self.assertEqual(2, code)
            self.assertIn("takes the folder", errors)
            self.assertIn(hint, errors)

    def test_draws_nothing_without_prices(self):
        self.write(surface="id,strike,maturity,price\nbad,,,\n")
        self.assertIsNone(prices_figure(self.folder))

    def test_rejects_damaged_surface(self):
        for text in ("id,strike\n1,2\n", "id,strike,maturity,price\na,1,1,x\n"):
            self.write(surface=text)
            self.assertEqual(6, cli.main([str(self.folder), "--quiet"]))

    def test_demo_finds_largest_difference_of_prices(self):
        self.write(batch="id,strike\na,1\nb,100\n", one="id,price\na,0.1\nb,5\n", other="id,price\na,0.2\nb,6\n")
        files = [self.folder / f"{name}.csv" for name in ("one", "other", "batch")]
        self.assertAlmostEqual(0.1, largest_difference(*files))
