#!/usr/bin/env python3
"""Rest of the cloth at the end of the scenes hung-sheet and twist, independently of the solver in kernels/fabric.

    scripts/studies/cloth_at_rest.py hung-sheet [--vertices 900] [--modulus 100]    energy and height of the middle
    scripts/studies/cloth_at_rest.py twist      [--vertices 200] [--modulus 500]    energy, von Mises stress and contraction of the middle

A state at rest is the least of the total potential energy: that of St Venant and Kirchhoff by triangles, relaxed as in Pipkin (1986)
where cloth bears no compression, and that of gravity, with a third of the mass of each triangle at its corners. The script searches
that least by quasi-Newton steps, without dynamics, springs, damping or contact. hung-sheet hangs from two corners that are nearer than
at rest; its folds may differ from run to run, its energy does not. twist ends as a strip that is pulled straight between its grips, as
if it had never been twisted: bending has hardly any energy there. Needs numpy, as in build/venv.
"""

import argparse
import collections
import math
import sys

import numpy as np

POISSON = 0.3
DENSITY = 0.2  # kg/m^2
GRAVITY = 9.81  # m/s^2
SIZE = 0.5  # m, of the hung sheet
LENGTH, WIDTH, PULL = 0.4, 0.06, 0.004  # m, of the strip
BALANCED = 1e-10  # largest force on a vertex of cloth at rest, N
LARGEST_STEP = 0.02  # m, of a vertex
REMEMBERED = 40  # steps from which the curvature is estimated


def square(cells):
    """Positions (m) of the vertices of a square, row by row, and its triangles with alternating diagonals."""
    line = SIZE * np.arange(cells + 1) / cells
    vertices = np.array([(x, y) for y in line for x in line])
    triangles = []
    for row in range(cells):
        for column in range(cells):
            a = row * (cells + 1) + column
            b, c, d = a + 1, a + cells + 1, a + cells + 2
            triangles += [(a, b, d), (a, d, c)] if (row + column) % 2 == 0 else [(a, b, c), (b, d, c)]
    return vertices, np.array(triangles)


def strip(vertices):
    """Rows of nearly equilateral triangles, about as many vertices as given; odd rows are shifted by half an edge."""
    height = 2 * WIDTH / math.sqrt(3)
    half, area = 0.5 * (LENGTH + height), LENGTH * height
    per_metre = (math.sqrt(half**2 + area * (vertices - 1)) - half) / area
    columns, rows = round(LENGTH * per_metre), round(height * per_metre)
    lines = [np.arange(columns + 1.0), np.clip(np.arange(columns + 2) - 0.5, 0, columns)]
    places, first = [], []
    for row in range(rows + 1):
        first.append(len(places))
        places += [(LENGTH * place / columns, WIDTH * row / rows) for place in lines[row % 2]]
    triangles = []
    for row in range(rows):
        even, odd = (first[row], first[row + 1]) if row % 2 == 0 else (first[row + 1], first[row])
        found = [(even + i, odd + i + 1, odd + i) for i in range(columns + 1)]
        found += [(even + i, even + i + 1, odd + i + 1) for i in range(columns)]
        triangles += found if row % 2 == 0 else [(a, c, b) for a, b, c in found]
    return np.array(places), np.array(triangles)


class Membrane:
    """Potential energy of a flat mesh and its gradient; `modulus` in N/m, `gravity` along -z in m/s^2."""

    def __init__(self, mesh, modulus, gravity=0.0, tension_only=False):
        self.vertices, self.triangles = mesh
        self.modulus, self.gravity, self.tension_only = modulus, gravity, tension_only
        corners = self.vertices[self.triangles]
        self.inverse = np.linalg.inv(np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2))
        self.area = 0.5 / np.linalg.det(self.inverse)
        third = np.repeat(DENSITY * self.area / 3, 3)
        self.mass = np.bincount(self.triangles.ravel(), third, len(self.vertices))

    def stresses(self, position):
        """Energy per area (J/m^2), second Piola-Kirchhoff stress (N/m) and deformation gradient (3, 2) of each triangle."""
        corners = position[self.triangles]
        deformation = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2) @ self.inverse
        metric = np.swapaxes(deformation, 1, 2) @ deformation
        e11, e22, e12 = 0.5 * (metric[:, 0, 0] - 1), 0.5 * (metric[:, 1, 1] - 1), 0.5 * metric[:, 0, 1]
        mean, half = 0.5 * (e11 + e22), 0.5 * (e11 - e22)
        radius = np.hypot(half, e12)
        major, minor = mean + radius, mean - radius
        taut = (major > 0) & (minor > -POISSON * major) if self.tension_only else np.full(len(major), True)
        wrinkled = np.where(major > 0, major, 0)
        stiff = self.modulus / (1 - POISSON**2)
        both = 0.5 * stiff * (major**2 + minor**2 + 2 * POISSON * major * minor)
        energy = np.where(taut, both, 0.5 * self.modulus * wrinkled**2)
        # Principal stresses, then their tensor: the mean and the difference along the principal directions.
        first = np.where(taut, stiff * (major + POISSON * minor), self.modulus * wrinkled)
        second = np.where(taut, stiff * (minor + POISSON * major), 0)
        share = 0.5 * (first - second) / np.where(radius > 0, radius, 1)
        stress = np.empty_like(metric)
        stress[:, 0, 0] = 0.5 * (first + second) + share * half
        stress[:, 1, 1] = 0.5 * (first + second) - share * half
        stress[:, 0, 1] = stress[:, 1, 0] = share * e12
        return energy, stress, deformation

    def elastic(self, position):
        """Elastic energy (J) and its gradient (N) at positions of shape (n, 3)."""
        energy, stress, deformation = self.stresses(position)
        pull = self.area[:, None, None] * (deformation @ stress) @ np.swapaxes(self.inverse, 1, 2)
        at_corners = np.stack([-pull.sum(axis=2), pull[:, :, 0], pull[:, :, 1]], axis=1).reshape(-1, 3)
        where = self.triangles.ravel()
        gradient = [np.bincount(where, at_corners[:, axis], len(position)) for axis in range(3)]
        return energy @ self.area, np.stack(gradient, axis=1)

    def potential(self, position):
        """Elastic energy and that of gravity (J), and the gradient (N)."""
        energy, gradient = self.elastic(position)
        gradient[:, 2] += self.gravity * self.mass
        return energy + self.gravity * self.mass @ position[:, 2], gradient

    def nearest(self, place):
        """Number of the vertex that is nearest to a place at rest."""
        return np.argmin(np.sum((self.vertices - place) ** 2, axis=1))

    def von_mises(self, position, vertex):
        """Von Mises stress (N/m) at a vertex of flat cloth: Cauchy's stress, mean of its triangles weighted by areas at rest."""
        _, stress, deformation = self.stresses(position)
        flat = deformation[:, :2]
        cauchy = flat @ stress @ np.swapaxes(flat, 1, 2) / np.linalg.det(flat)[:, None, None]
        near = np.any(self.triangles == vertex, axis=1)
        (xx, xy), (_, yy) = np.average(cauchy[near], axis=0, weights=self.area[near])
        return math.sqrt(xx**2 - xx * yy + yy**2 + 3 * xy**2)


def hung(cells, modulus):
    """The sheet, a curved state below its corners, which are where the scene holds them, and the vertices that are free (1 or 0)."""
    cloth = Membrane(square(cells), modulus, GRAVITY, tension_only=True)
    x, y = cloth.vertices.T
    held = (np.minimum(x, SIZE - x) < 1e-9) & (y > SIZE - 1e-9)
    start = np.stack([x + 0.2 * (0.25 - x), y, 0.02 * np.sin(3 * x + 5 * y)], axis=1)
    start[:, 1] = np.where(held, y, SIZE + 0.15 * (SIZE - y) + 0.003 * np.sin(40 * x))
    fallen = start[held, 2].mean() - 0.97 * (SIZE - y) - 0.05 * np.sin(np.pi * x / SIZE)
    start[:, 2] = np.where(held, start[:, 2], fallen)
    return cloth, start, np.where(held, 0.0, 1.0)[:, None]


def pulled(vertices, modulus):
    """The strip, evenly stretched, and the vertices that are free (1 or 0): all but those of the grips."""
    cloth = Membrane(strip(vertices), modulus)
    x, y = cloth.vertices.T
    start = np.stack([x * (1 + PULL / LENGTH), y, 0 * x], axis=1)
    return cloth, start, np.where((x < 1e-9) | (x > LENGTH - 1e-9), 0.0, 1.0)[:, None]


def direction_of(gradient, steps):
    """Quasi-Newton direction by the method of Nocedal (1980) with limited memory."""
    direction, weights = gradient.copy(), []
    for moved, changed in reversed(steps):
        weights.append(np.vdot(moved, direction) / np.vdot(moved, changed))
        direction -= weights[-1] * changed
    if steps:
        moved, changed = steps[-1]
        direction *= np.vdot(moved, changed) / np.vdot(changed, changed)
    else:
        direction *= 1e-3 / np.abs(direction).max()
    for (moved, changed), weight in zip(steps, reversed(weights), strict=True):
        direction += moved * (weight - np.vdot(changed, direction) / np.vdot(moved, changed))
    return -direction


def rest(cloth, start, free, balanced=1e-7, most_steps=100_000):
    """Positions (m) of the least potential energy, and the largest force (N) that is left there; stops below `balanced`."""
    position = start
    energy, gradient = cloth.potential(position)
    gradient *= free
    steps = collections.deque(maxlen=REMEMBERED)
    for _ in range(most_steps):
        if np.abs(gradient).max() < balanced:
            break
        direction = direction_of(gradient, steps)
        slope = np.vdot(direction, gradient)
        if slope >= 0:
            steps.clear()
            continue
        # Bisection for the conditions of Wolfe.
        length, low, high = min(1.0, LARGEST_STEP / np.abs(direction).max()), 0.0, None
        for _ in range(40):
            there = position + length * direction
            energy_there, gradient_there = cloth.potential(there)
            gradient_there *= free
            if energy_there > energy + 1e-4 * length * slope + 1e-15:
                high = length
            elif np.vdot(direction, gradient_there) < 0.9 * slope:
                low = length
            else:
                break
            length = 0.5 * (low + high) if high else 2 * length
        moved, changed = there - position, gradient_there - gradient
        if np.vdot(moved, changed) > 0:
            steps.append((moved, changed))
        position, energy, gradient = there, energy_there, gradient_there
    return position, np.abs(gradient).max()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", choices=("hung-sheet", "twist"))
    parser.add_argument("--vertices", type=int)
    parser.add_argument("--modulus", type=float)
    arguments = parser.parse_args()
    if arguments.scene == "hung-sheet":
        cells = round((arguments.vertices or 900) ** 0.5) - 1
        cloth, start, free = hung(cells, arguments.modulus or 100.0)
    else:
        cloth, start, free = pulled(arguments.vertices or 200, arguments.modulus or 500.0)
    position, force = rest(cloth, start, free, BALANCED)
    print(f"vertices {len(cloth.vertices)}, largest force {force:.1e} N")
    print(f"elastic energy {cloth.elastic(position)[0]:.7e} J")
    if arguments.scene == "hung-sheet":
        print(f"height of the middle {position[cloth.nearest((SIZE / 2, SIZE / 2)), 2]:.7f} m")
    else:
        print(f"von Mises stress {cloth.von_mises(position, cloth.nearest((LENGTH / 2, WIDTH / 2))):.7f} N/m")
        edge = cloth.nearest((LENGTH / 2, WIDTH))
        print(f"displacement of the edge along y {position[edge, 1] - cloth.vertices[edge, 1]:.7e} m")
    if force > BALANCED:
        print(f"not at rest: a force of {force:.1e} N is left, more than {BALANCED:g} N", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
