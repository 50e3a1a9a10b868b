"""The hard cases of drogue-options: finite differences meet their tolerances against the Fourier methods, whose prices are kept."""

import csv
import os
import pathlib
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

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
        self.told = {told["id"]: told for told in self.prices()}

    def test_table(self):
        self.assertEqual(list(EXPECTED), list(CONTRACTS))
        self.assertGreaterEqual(len(EXPECTED), 40)

    def test_tolerances(self):
        for name, expected in EXPECTED.items():
            if expected["price"]:
                with self.subTest(name):
                    tolerance = float(expected["tolerance"]) + float(expected["uncertainty"])
                    self.assertAlmostEqual(float(expected["price"]), float(self.told[name]["price"]), delta=tolerance)

    def test_errors_cover_the_truth(self):
        """In nine of ten rows."""
        kept = [name for name, expected in EXPECTED.items() if expected["price"]]
        covered = [name for name in kept if abs(float(EXPECTED[name]["price"]) - float(self.told[name]["price"]))
                   <= float(self.told[name]["error"]) + float(EXPECTED[name]["uncertainty"])]
        self.assertGreaterEqual(len(covered), 0.9 * len(kept), set(kept) - set(covered))

    def test_where_no_price_is_kept(self):
        """Within what no law allows to leave: the European price and the strike."""
        lines = [",".join({**CONTRACTS[name], "style": "european"}.values()) for name, expected in EXPECTED.items()
                 if not expected["price"]]
        self.assertEqual(1, len(lines))
        self.expect(0, "price", self.write(options_program.batch(lines)), "--quiet", "--out", "e.csv", *options_program.FAST)
        for european in self.prices("e.csv"):
            name = european["id"]
            price, error = float(self.told[name]["price"]), float(self.told[name]["error"])
            self.assertGreaterEqual(price, float(european["price"]) - error)
            self.assertLessEqual(price, float(CONTRACTS[name]["strike"]))

    def test_kept_prices(self):
        """Those that the Fourier integral gives in no time, anew."""
        kept = [name for name, contract in CONTRACTS.items() if contract["style"] == "european"]
        lines = [",".join(CONTRACTS[name].values()) for name in kept]
        self.expect(0, "price", self.write(options_program.batch(lines)), "--quiet", "--out", "e.csv", *options_program.FAST)
        for told in self.prices("e.csv"):
            self.assertAlmostEqual(float(EXPECTED[told["id"]]["price"]), float(told["price"]), delta=1e-12)


if __name__ == "__main__":
    unittest.main()
