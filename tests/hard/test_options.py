"""The hard cases of drogue-options: finite differences meet their tolerances against the Fourier methods, whose prices are kept."""

import csv
import pathlib

import options_program

FOLDER = pathlib.Path(__file__).parent


def table(file):
    with file.open(encoding="utf-8", newline="") as stream:
        return {line["id"]: line for line in csv.DictReader(stream)}


EXPECTED = table(FOLDER / "options.csv")
CONTRACTS = table(options_program.BATCHES / "hard_cases.csv")


class HardCases(options_program.OptionsTest):
    def setUp(self):
        super().setUp()
        self.expect(0, "price", "hard_cases", "--backend", "serial", "--quiet")
        self.priced = {row["id"]: row for row in self.prices()}

    def test_every_contract_has_a_price(self):
        self.assertEqual(list(EXPECTED), list(CONTRACTS))
        self.assertGreaterEqual(len(EXPECTED), 40)

    def test_prices_meet_their_tolerances(self):
        for name, expected in EXPECTED.items():
            if expected["price"]:
                with self.subTest(name):
                    tolerance = float(expected["tolerance"]) + float(expected["uncertainty"])
                    self.assertAlmostEqual(float(expected["price"]), float(self.priced[name]["price"]), delta=tolerance)

    def test_small_prices_converge(self):
        """Relative tolerances of small prices on fine meshes, three to five times the errors on one core."""
        for mesh, steps, names in ((1024, 512, {"day-out": 6e-6, "deep-out": 6e-4, "european-deep-out": 1.8e-5}),
                                   (2048, 1024, {"deep-out-call": 8e-2}), (4096, 64, {"european-day": 0.2})):
            content = options_program.batch([",".join(CONTRACTS[name].values()) for name in names])
            self.expect(0, "price", self.write(content), "--backend", "serial", "--quiet", "--mesh", mesh, "--steps", steps)
            for row in self.prices():
                with self.subTest(row["id"]):
                    price = float(EXPECTED[row["id"]]["price"])
                    self.assertAlmostEqual(price, float(row["price"]), delta=names[row["id"]] * price)

    def test_error_estimates_cover_the_reference(self):
        """The estimates of nine in ten rows cover the deviation from the reference."""
        kept = [name for name, expected in EXPECTED.items() if expected["price"]]
        covered = [name for name in kept if abs(float(EXPECTED[name]["price"]) - float(self.priced[name]["price"]))
                   <= float(self.priced[name]["error"]) + float(EXPECTED[name]["uncertainty"])]
        self.assertGreaterEqual(len(covered), 0.9 * len(kept), set(kept) - set(covered))

    def test_bounds_american_price_without_reference(self):
        """Bounds of an American put by arbitrage: the European price and the strike."""
        lines = [",".join({**CONTRACTS[name], "style": "european"}.values()) for name, expected in EXPECTED.items()
                 if not expected["price"]]
        self.assertEqual(1, len(lines))
        self.expect(0, "price", self.write(options_program.batch(lines)), "--quiet", "--out", "e.csv", *options_program.FAST)
        for european in self.prices("e.csv"):
            name = european["id"]
            price, error = float(self.priced[name]["price"]), float(self.priced[name]["error"])
            self.assertGreaterEqual(price, float(european["price"]) - error)
            self.assertLessEqual(price, float(CONTRACTS[name]["strike"]))

    def test_reproduces_european_prices(self):
        """European prices, which the Fourier integral computes quickly, against the table."""
        kept = [name for name, contract in CONTRACTS.items() if contract["style"] == "european"]
        lines = [",".join(CONTRACTS[name].values()) for name in kept]
        self.expect(0, "price", self.write(options_program.batch(lines)), "--quiet", "--out", "e.csv", *options_program.FAST)
        for row in self.prices("e.csv"):
            self.assertAlmostEqual(float(EXPECTED[row["id"]]["price"]), float(row["price"]), delta=1e-12)
