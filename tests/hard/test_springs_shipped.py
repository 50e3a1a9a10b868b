"""Every shipped springs scene meets its tolerances unchanged."""

import math

import gas_program
import springs_program


# Ten thousand launches on few vertices take seconds with threads; both backends have the same kernels.
MANY_SMALL_STEPS = {"catenary", "curtain", "hencky", "patch", "pulled-rectangle", "reinforced-strip", "strip",
                    "swing-chord", "table-cloth", "twist"}


class Shipped(springs_program.SpringsTest):
    def test_serial_meets_the_tolerances(self):
        self.assert_all_pass("serial", springs_program.SCENES, also=self.assert_within)

    @gas_program.needs_openmp
    def test_openmp_meets_the_tolerances(self):
        self.assert_all_pass("openmp", [name for name in springs_program.SCENES if name not in MANY_SMALL_STEPS],
                             also=self.assert_within)

    def test_patch_reproduces_uniform_strain(self):
        """Patch test: triangles of any shape reproduce a uniform strain exactly at all vertices."""
        self.expect(0, "patch", "--backend", "serial", "--quiet")
        file = self.fields("out/patch")
        rest = list(file.values("/mesh/vertices"))
        now = list(file.values(f"/steps/{file.children('/steps')[-1]}/position"))
        # The transverse second Piola-Kirchhoff stress is zero: the Green strains have the ratio -nu.
        along, across = 1.05, math.sqrt(1 - 0.3 * (1.05**2 - 1))
        for axis, factor in enumerate((along, across, 0.0)):
            self.assertLess(max(abs(x - factor * X) for x, X in zip(now[axis::3], rest[axis::3], strict=True)), 1e-9)
        # The distorted mesh and the initial disturbance make the test significant.
        cells = {round(x, 6) for x in rest[0::3]}
        self.assertGreater(len(cells), 100)
        start = list(file.values("/steps/000000/position"))
        self.assertGreater(max(abs(x - along * X) for x, X in zip(start[0::3], rest[0::3], strict=True)), 1e-3)

    def test_twisted_strip_would_not_unwind_without_contact(self):
        """Layers that pass one another leave turns in the strip, whose energy shows them."""
        lines = self.expect(0, "twist", "--print-scene").stdout.replace("intersections = 0.0", "").splitlines()
        start = lines.index("[contact]")
        end = next(k for k in range(start + 1, len(lines)) if lines[k].startswith("["))
        scene = self.write("\n".join(lines[:start] + lines[end:]))
        self.expect(5, scene, "--backend", "serial", "--quiet", "--out", "through")
        self.assertGreater(self.result("through")["errors"]["values_0_elastic_energy"], 5.0)

    def test_curtain_gathers_in_folds(self):
        """The top edge keeps its length in folds, which are in contact, and the curtain opens again."""
        self.expect(0, "curtain", "--backend", "serial", "--quiet")
        file = self.fields("out/curtain")
        numbers = list(file.values("/mesh/vertices"))
        rest = [numbers[k:k + 3] for k in range(0, len(numbers), 3)]
        top = sorted((i for i, place in enumerate(rest) if place[1] > 0.3 - 1e-9), key=lambda i: rest[i][0])
        widths = []
        for step in file.children("/steps"):
            numbers = list(file.values(f"/steps/{step}/position"))
            line = [numbers[3 * i:3 * i + 3] for i in top]
            edges = [math.dist(a, b) for a, b in zip(line, line[1:])]
            self.assertAlmostEqual(0.6, sum(edges), delta=0.03)
            for edge in edges:
                self.assertAlmostEqual(0.6 / len(edges), edge, delta=0.1 * edge)
            widths.append(line[-1][0] - line[0][0])
        self.assertLess(min(widths), 0.3 * widths[0])
        self.assertAlmostEqual(widths[0], widths[-1], delta=1e-12)
        self.assertLess(self.history("out/curtain")["contact_work"][-1], 0.0)
