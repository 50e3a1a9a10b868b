#!/usr/bin/env python3
"""Energy and dissipation of the vortices of Taylor and Green from a spectral method, independently of the solver in kernels/flow.

    scripts/studies/taylor_green.py [--modes 64] [--end 10] [--every 1] [--reynolds 1600]    table of time, energy and dissipation
    scripts/studies/taylor_green.py --series 4                                                 power series of the mean enstrophy in time

The velocity (sin x cos y cos z, -cos x sin y cos z, 0) keeps its symmetries: its components are sums of sine and cosine products whose
three wave numbers are all even or all odd (Brachet et al. 1983, J. Fluid Mech. 130:411). The method is Fourier-Galerkin with
the wave numbers below 2 MODES, as of a grid of (6 MODES)^3 points of which a third is cut off: rotational form, classical
Runge-Kutta steps. Energies are totals in (2 pi)^3 with density 1, as in the scenes taylor-green-3d. The table needs numpy, as in
build/venv.

The series is exact: rational arithmetic on Fourier modes, with powers of the viscosity kept apart.
"""

import argparse
import itertools
import math
from fractions import Fraction

VOLUME = (2 * math.pi) ** 3


def add_products(total, a, b):
    """Adds the projected rate of change sum (a(p) . q) b(q) of the modes p + q; velocities are i times these real coefficients."""
    for p, left in a.items():
        for q, right in b.items():
            carried = sum(x * y for x, y in zip(left, q, strict=True))
            if carried == 0:
                continue
            k = tuple(x + y for x, y in zip(p, q, strict=True))
            square = sum(x * x for x in k)
            if square == 0:
                continue
            along = sum(x * y for x, y in zip(k, right, strict=True)) / Fraction(square)
            old = total.get(k, (0, 0, 0))
            total[k] = tuple(o + carried * (r - along * x) for o, r, x in zip(old, right, k, strict=True))


def enstrophy_series(order):
    """Coefficients of the mean enstrophy, relative to the first: entry [n][m] is that of t^n nu^m."""
    start = {}
    for signs in itertools.product((1, -1), repeat=3):
        start[signs] = (Fraction(-signs[0], 8), Fraction(signs[1], 8), Fraction(0))
    velocity = [[start]]  # [n][m]: modes of t^n nu^m
    for n in range(order):
        velocity.append([])
        for m in range(n + 2):
            rate = {}
            for i in range(n + 1):
                for low in range(max(0, m - (n - i)), min(i, m) + 1):
                    add_products(rate, velocity[i][low], velocity[n - i][m - low])
            if 0 < m:
                for k, value in velocity[n][m - 1].items():
                    square = sum(x * x for x in k)
                    rate[k] = tuple(r - square * v for r, v in zip(rate.get(k, (0, 0, 0)), value, strict=True))
            velocity[n + 1].append({k: tuple(x / (n + 1) for x in value) for k, value in rate.items() if any(value)})

    def product(a, b):
        return sum(sum(x * x for x in k) * sum(v * w for v, w in zip(value, b[k], strict=True))
                   for k, value in a.items() if k in b)

    def coefficient(n, m):
        return sum((product(velocity[i][low], velocity[n - i][m - low])
                    for i in range(n + 1) for low in range(max(0, m - (n - i)), min(i, m) + 1)), start=Fraction(0))

    first = coefficient(0, 0)
    return [[coefficient(n, m) / first for m in range(n + 1)] for n in range(order + 1)]


class SpectralFlow:
    """Sine and cosine coefficients of the velocity: [family][component], arrays [x][y][z]; family 0 has the even wave numbers."""

    def __init__(self, modes, reynolds):
        import numpy as np

        self._np, self.viscosity, count = np, 1.0 / reynolds, np.arange(modes)
        # Products of two fields do not alias into wave numbers below 2 `modes`.
        self.points = math.ceil(1.5 * modes)
        place = (np.arange(self.points) + 0.5) * math.pi / (2 * self.points)
        self._waves, self._to_points, self._to_modes = [], [], []
        for family in (0, 1):
            k = 2.0 * count + family
            norm = np.where(k == 0, self.points, self.points / 2)
            matrices = {"s": np.sin(np.outer(place, k)), "c": np.cos(np.outer(place, k))}
            self._to_points.append(matrices)
            self._to_modes.append({name: (matrix / norm).T.copy() for name, matrix in matrices.items()})
            self._waves.append((k[:, None, None], k[None, :, None], k[None, None, :]))
        self._squares = [sum(k * k for k in waves) for waves in self._waves]
        self._inverse = [1.0 / np.where(square == 0, 1.0, square) for square in self._squares]
        self.velocity = np.zeros((2, 3, modes, modes, modes))
        self.velocity[1, 0, 0, 0, 0] = 1.0
        self.velocity[1, 1, 0, 0, 0] = -1.0

    def _transform(self, field, matrices, parity):
        np = self._np
        x, y, z = (matrices[name] for name in parity)
        return np.matmul(np.matmul(y, np.tensordot(x, field, 1)), z.T)

    def rate(self, velocity):
        """Rate of change of the coefficients of the velocity."""
        np = self._np
        parity_u, parity_w = ("scc", "csc", "ccs"), ("css", "scs", "ssc")
        u, w = [], []
        for family, (kx, ky, kz) in enumerate(self._waves):
            a, b, c = velocity[family]
            curl = (kz * b - ky * c, kx * c - kz * a, ky * a - kx * b)
            u.append([self._transform(f, self._to_points[family], p) for f, p in zip((a, b, c), parity_u, strict=True)])
            w.append([self._transform(f, self._to_points[family], p) for f, p in zip(curl, parity_w, strict=True)])
        result = np.empty_like(velocity)
        # Products of fields of one family are even, those of two families odd.
        for family, pairs in enumerate((((0, 0), (1, 1)), ((0, 1), (1, 0)))):
            waves, force = self._waves[family], []
            for axis in range(3):
                i, j = (axis + 1) % 3, (axis + 2) % 3
                product = sum(u[p][i] * w[q][j] - u[p][j] * w[q][i] for p, q in pairs)
                force.append(self._transform(product, self._to_modes[family], parity_u[axis]))
            along = sum(k * f for k, f in zip(waves, force, strict=True)) * self._inverse[family]
            damping = self.viscosity * self._squares[family]
            for axis in range(3):
                result[family, axis] = force[axis] - waves[axis] * along - damping * velocity[family, axis]
        return result

    def step(self, dt):
        """One classical Runge-Kutta step."""
        first = self.rate(self.velocity)
        second = self.rate(self.velocity + 0.5 * dt * first)
        third = self.rate(self.velocity + 0.5 * dt * second)
        fourth = self.rate(self.velocity + dt * third)
        self.velocity += dt / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)

    def _mean_square(self, weights):
        """Half of the volume integral of the squares, times weights of the modes."""
        np, total = self._np, 0.0
        for family, waves in enumerate(self._waves):
            # The mean of a squared sine or cosine is 1/2, but 1 of a cosine without waves.
            for axis in range(3):
                means = 1.0
                for other, k in enumerate(waves):
                    means = means * np.where((k == 0) & (other != axis), 1.0, 0.5)
                total += float(np.sum(means * weights[family] * self.velocity[family, axis] ** 2))
        return 0.5 * VOLUME * total

    def energy(self):
        return self._mean_square((1.0, 1.0))

    def dissipation(self):
        """Rate at which viscosity takes energy from the flow."""
        return 2.0 * self.viscosity * self._mean_square(self._squares)


def curve(modes, end, every, reynolds):
    """Rows (time, energy, dissipation) from 0 to `end`, `every` apart; yields them as they are reached."""
    flow = SpectralFlow(modes, reynolds)
    yield 0.0, flow.energy(), flow.dissipation()
    # |u| + |v| + |w| stays below 2.2, wave numbers below 2 `modes`, and the scheme is stable to 2.8 on the imaginary axis.
    steps = math.ceil(every * modes / 0.6)
    for row in range(1, round(end / every) + 1):
        for _ in range(steps):
            flow.step(every / steps)
        yield row * every, flow.energy(), flow.dissipation()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--modes", type=int, default=64, help="modes per axis of each of the two families")
    parser.add_argument("--end", type=float, default=10.0)
    parser.add_argument("--every", type=float, default=1.0)
    parser.add_argument("--reynolds", type=float, default=1600.0)
    parser.add_argument("--series", type=int, metavar="ORDER", help="print the power series instead")
    arguments = parser.parse_args()
    if arguments.series is not None:
        for n, powers in enumerate(enstrophy_series(arguments.series)):
            print(f"t^{n}: " + " + ".join(f"{value} nu^{m}" for m, value in enumerate(powers) if value))
        return
    print("time energy dissipation")
    for time, energy, dissipation in curve(arguments.modes, arguments.end, arguments.every, arguments.reynolds):
        print(f"{time:g} {energy:.7g} {dissipation:.7g}", flush=True)


if __name__ == "__main__":
    main()
