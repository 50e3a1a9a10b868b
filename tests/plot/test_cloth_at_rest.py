"""The program that finds the rest of cloth on its own, and that it has the cloth of the scenes."""

import math
import tomllib
import unittest

import packages  # noqa: F401, before modules that need the packages  isort: skip
import cloth_at_rest as at_rest
import numpy as np

SCENES = packages.SOURCE / "miniapps/springs/scenes"


def scene(name):
    return tomllib.loads((SCENES / f"{name}.toml").read_text(encoding="utf-8"))


class ClothAtRest(unittest.TestCase):
    def test_has_the_cloth_of_the_scenes(self):
        sheet, strip = scene("hung-sheet"), scene("twist")
        self.assertEqual(2 * [at_rest.SIZE], [sheet["mesh"]["rectangle"][side] for side in ("width", "height")])
        self.assertEqual([at_rest.LENGTH, at_rest.WIDTH], [strip["mesh"]["strip"][side] for side in ("length", "width")])
        for values, tension_only in ((sheet, True), (strip, False)):
            material = values["material"]
            self.assertEqual((at_rest.POISSON, at_rest.DENSITY, tension_only),
                             (material["poisson"], material["area_density"], material.get("tension_only", False)))
        self.assertEqual([[0.0, 0.0, -at_rest.GRAVITY]], [load["gravity"] for load in sheet["load"]])
        _, start, free = at_rest.hung(4, 1.0)
        for place, corner in zip(start[free[:, 0] == 0], (0.0, 0.5), strict=True):
            expected = (corner + 0.2 * (0.25 - corner), 0.5, 0.02 * math.sin(3 * corner + 2.5))
            np.testing.assert_allclose(place, expected, atol=1e-15)

    def test_strip_covers_its_rectangle(self):
        for vertices in (60, 200):
            cloth, _, _ = at_rest.pulled(vertices, 1.0)
            self.assertAlmostEqual(at_rest.LENGTH * at_rest.WIDTH, cloth.area.sum(), delta=1e-15)
            self.assertGreater(cloth.area.min(), 0.0)
            self.assertLess(abs(len(cloth.vertices) / vertices - 1), 0.2)

    def test_energy_and_stress_of_stretched_sheet(self):
        """Tension along both axes, one axis, and neither."""
        cloth = at_rest.Membrane(at_rest.square(3), 50.0, tension_only=True)
        x, y = cloth.vertices.T
        along, across, slack = (0.5 * (stretch**2 - 1) for stretch in (1.1, 1.05, 0.9))
        area, stiff = at_rest.SIZE**2, 50.0 / (1 - 0.3**2)
        both = 0.5 * stiff * (along**2 + across**2 + 0.6 * along * across) * area
        for stretch, expected in ((1.05, both), (0.9, 0.5 * 50.0 * along**2 * area)):
            energy, _ = cloth.elastic(np.stack([1.1 * x, 0 * y, stretch * y], axis=1))
            self.assertAlmostEqual(expected, energy, delta=1e-14)
        self.assertEqual(0.0, cloth.elastic(np.stack([0.9 * x, 0.8 * y, 0 * x], axis=1))[0])
        stiffer = at_rest.Membrane(at_rest.square(3), 50.0)
        energy, _ = stiffer.elastic(np.stack([1.1 * x, 0 * y, 0.9 * y], axis=1))
        self.assertAlmostEqual(0.5 * stiff * (along**2 + slack**2 + 0.6 * along * slack) * area, energy, delta=1e-14)
        first, second = stiff * (along + 0.3 * across) * 1.1 / 1.05, stiff * (across + 0.3 * along) * 1.05 / 1.1
        expected = math.sqrt(first**2 - first * second + second**2)
        self.assertAlmostEqual(expected, cloth.von_mises(np.stack([1.1 * x, 1.05 * y, 0 * x], axis=1), 5), delta=1e-12)

    def test_gradient_is_the_derivative_of_the_energy(self):
        cloth, position, _ = at_rest.hung(3, 80.0)
        position += 0.02 * np.random.default_rng(7).standard_normal(position.shape)
        _, gradient = cloth.potential(position)
        for vertex in range(len(position)):
            for axis in range(3):
                ends = []
                for step in (1e-6, -1e-6):
                    position[vertex, axis] += step
                    ends.append(cloth.potential(position)[0])
                    position[vertex, axis] -= step
                self.assertAlmostEqual((ends[0] - ends[1]) / 2e-6, gradient[vertex, axis], delta=1e-7)

    def test_corners_bear_the_weight(self):
        cloth, start, free = at_rest.hung(4, 100.0)
        position, force = at_rest.rest(cloth, start, free)
        self.assertLess(force, 1e-7)
        _, gradient = cloth.potential(position)
        weight = at_rest.GRAVITY * at_rest.DENSITY * at_rest.SIZE**2
        np.testing.assert_allclose(gradient[free[:, 0] == 0].sum(axis=0), (0, 0, weight), atol=2e-6)

    def test_rest_of_the_strip_is_what_the_scene_ends_with(self):
        values = {value["quantity"]: value["value"] for value in scene("twist")["verify"]["values"]}
        cloth, start, free = at_rest.pulled(200, 500.0)
        position, _ = at_rest.rest(cloth, start, free, 1e-10)
        edge = cloth.nearest((at_rest.LENGTH / 2, at_rest.WIDTH))
        found = {
            "elastic_energy": cloth.elastic(position)[0],
            "von_mises": cloth.von_mises(position, cloth.nearest((at_rest.LENGTH / 2, at_rest.WIDTH / 2))),
            "displacement_y": position[edge, 1] - cloth.vertices[edge, 1],
        }
        for name, value in found.items():
            self.assertAlmostEqual(1.0, value / values[name], delta=2e-7, msg=name)
