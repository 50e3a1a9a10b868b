"""Expressions of scenes: values against numpy, and rejection of invalid expressions."""

import unittest

import packages  # noqa: F401, before modules that need the packages  isort: skip
import numpy as np
from plot.expression import evaluate
from plot.failure import Failure


class Expressions(unittest.TestCase):
    def test_evaluates_like_numpy(self):
        x = np.linspace(-1.5, 2.0, 8)
        cases = {
            "1 + 0.2*sin(pi*x)": 1 + 0.2 * np.sin(np.pi * x),
            "-x^2": -(x**2),
            "2^3^2": np.full(8, 512.0),
            "x < -4 ? 27/7 : 1 + 0.2*sin(5*x)": 1 + 0.2 * np.sin(5 * x),
            "(x > 0 && x < 1) || x >= 1.9": ((x > 0) & (x < 1)) | (x >= 1.9),
            "max(x, 0.5, 2*x) - min(1, x)": np.maximum(np.maximum(x, 0.5), 2 * x) - np.minimum(1, x),
            "exp(-x)*1e-3": np.exp(-x) * 1e-3,
            "3": np.full(8, 3.0),
        }
        for text, expected in cases.items():
            with self.subTest(text):
                np.testing.assert_allclose(evaluate(text, x=x), expected, rtol=1e-14)
        np.testing.assert_array_equal(evaluate(2, x=x), np.full(8, 2.0))

    def test_bessel_function_matches_table(self):
        # Abramowitz and Stegun, table 9.1
        for order, at, value in ((0, 1.0, 0.7651976866), (1, 5.0, -0.3275791376), (2, 17.5, 0.0844338303)):
            self.assertAlmostEqual(float(evaluate(f"besselj({order}, x)", x=np.array(at))), value, delta=1e-10)

    def test_rejects_invalid_expressions(self):
        for text in ("1 +", "sin(x", "q + 1", "x x", "x ? 1"):
            with self.subTest(text), self.assertRaises(Failure):
                evaluate(text, x=np.zeros(2))
