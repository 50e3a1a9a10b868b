"""The exact Riemann solver against tabulated states, conservation laws and symmetry."""

import unittest

import packages  # noqa: F401, before modules that need the packages  isort: skip
import numpy as np
from plot.gas.riemann import State, opens_vacuum, sample, star_region

# left, right, gamma -> p*, u*, rho*L, rho*R; Toro (2009) table 4.3 and the literature, seven digits.
_TABLE = {
    "sod": ((1, 0, 1), (0.125, 0, 0.1), 1.4, (0.3031302, 0.9274526, 0.4263194, 0.2655737)),
    "lax": ((0.445, 0.698, 3.528), (0.5, 0, 0.571), 1.4, (2.466098, 1.528723, 0.3445685, 1.304085)),
    "toro-1": ((1, 0.75, 1), (0.125, 0, 0.1), 1.4, (0.4662936, 1.360906, 0.5798667, 0.3397002)),
    "toro-2": ((1, -2, 0.4), (1, 2, 0.4), 1.4, (0.001893873, 0, 0.02185212, 0.02185212)),
    "toro-3": ((1, 0, 1000), (1, 0, 0.01), 1.4, (460.8938, 19.59745, 0.5750623, 5.999241)),
    "toro-4": ((5.99924, 19.5975, 460.894), (5.99242, -6.19633, 46.0950), 1.4, (1691.647, 8.689774, 14.28235, 31.0426)),
    "leblanc": ((1, 0, 2e-1 / 3), (1e-3, 0, 2e-10 / 3), 5 / 3, (5.155779e-4, 0.6218387, 0.05407934, 0.003999998)),
    "mach-2000": ((5, 800, 0.4127), (0.5, 0, 0.4127), 5 / 3, (246279.5, 607.7975, 19.99987, 1.999987)),
}


def _conserved(rho, u, p, gamma):
    return np.array([rho, rho * u, p / (gamma - 1) + 0.5 * rho * u * u])


def _flux(state, gamma):
    energy = state.p / (gamma - 1) + 0.5 * state.rho * state.u**2
    return np.array([state.rho * state.u, state.rho * state.u**2 + state.p, state.u * (energy + state.p)])


class ExactRiemannSolver(unittest.TestCase):
    def test_star_states_match_tables(self):
        for name, (left, right, gamma, expected) in _TABLE.items():
            with self.subTest(name):
                left, right = State(*left), State(*right)
                p, u = star_region(left, right, gamma)
                tiny = 1e-7 * left.sound_speed(gamma)
                rho, _, _ = sample(np.array([u - tiny, u + tiny]), left, right, gamma)
                for value, wanted in zip((p, u, *rho), expected):
                    self.assertAlmostEqual(value, wanted, delta=1e-6 * max(abs(wanted), 1e-9))

    def test_solution_conserves_mass_momentum_and_energy(self):
        rng = np.random.default_rng(20)
        for _ in range(25):
            gamma = rng.uniform(1.1, 1.9)
            left, right = (State(*rng.uniform((0.1, -3, 0.1), (4, 3, 9))) for _ in range(2))
            half_width = 12 + 2 * max(left.sound_speed(gamma), right.sound_speed(gamma))
            edges = np.linspace(-half_width, half_width, 400_001)
            xi = 0.5 * (edges[1:] + edges[:-1])
            total = _conserved(*sample(xi, left, right, gamma), gamma).sum(1) * (edges[1] - edges[0])
            start = [_conserved(side.rho, side.u, side.p, gamma) for side in (left, right)]
            expected = half_width * (start[0] + start[1]) + _flux(left, gamma) - _flux(right, gamma)
            np.testing.assert_allclose(total, expected, rtol=2e-3, atol=2e-3)

    def test_mirrored_problem_has_mirrored_solution(self):
        left, right = State(1, 0.75, 1), State(0.125, -0.2, 0.1)
        xi = np.linspace(-3, 3, 601) + 1e-4
        rho, u, p = sample(xi, left, right, 1.4)
        mirrored = sample(-xi, State(0.125, 0.2, 0.1), State(1, -0.75, 1), 1.4)
        for values, other in zip((rho, u, p), mirrored * np.array([[1], [-1], [1]])):
            np.testing.assert_allclose(values, other, atol=1e-12)

    def test_vacuum_opens_between_fast_receding_states(self):
        left, right = State(7, -1, 0.2), State(7, 1, 0.2)
        self.assertTrue(opens_vacuum(left, right, 1.4))
        self.assertFalse(opens_vacuum(left, State(7, 0.99, 0.2), 1.4))
        rho, _, p = sample(np.array([-1.4, -0.05, 0.0, 0.05, 1.4]), State(7, -1.1, 0.2), State(7, 1.1, 0.2), 1.4)
        self.assertEqual(list(rho[1:4]), [0, 0, 0])
        self.assertEqual(list(p[1:4]), [0, 0, 0])
        self.assertEqual(list(rho[[0, 4]]), [7, 7])
