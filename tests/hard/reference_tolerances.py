"""Rows of tolerances.csv whose reference is a finer run, which is made once and compared here."""

import bisect

import gas_program
import hard_cases


def rows(wanted):
    return [row for row in hard_cases.rows("tolerances.csv") if ":" in row["reference"] and wanted(row)]


def interpolate(xs, values, x):
    """Linear interpolation between cell centres."""
    right = min(max(bisect.bisect_right(xs, x), 1), len(xs) - 1)
    weight = (x - xs[right - 1]) / (xs[right] - xs[right - 1])
    return (1.0 - weight) * values[right - 1] + weight * values[right]


def l1_difference(xs, values, reference):
    dx = xs[1] - xs[0]
    return sum(abs(value - interpolate(*reference, x)) for x, value in zip(xs, values)) * dx


class ReferenceTest(gas_program.GasTest):
    references = {}

    def density(self, case, backend, sets):
        """Cell centres and density at the end of a run without verification."""
        scene = hard_cases.unverified(self, case)
        self.expect(0, scene, "--quiet", "--overwrite", "--out", "run", "--backend", backend,
                    sets=[*sets, 'output.fields=["rho"]', "output.history_every=0"])
        return gas_program.final_values(self.folder / "run")

    def reference(self, row):
        """Reference solution, computed on first use."""
        key = row["case"], row["reference"]
        if key not in self.references:
            scheme, cells = row["reference"].split(":")
            limited = row["case"] == "blast"
            self.references[key] = self.density(row["case"], "serial", hard_cases.row_sets({
                "scheme": scheme, "N": cells, "splitting": "lf-stencil", "limiter": "on" if limited else "off",
                "cfl": "0.4" if limited else "0.6"}))
        return self.references[key]

    def assert_all_met(self, chosen, backend):
        self.assertTrue(chosen)
        for row in chosen:
            with self.subTest(hard_cases.label(row)):
                density = self.density(row["case"], backend, hard_cases.row_sets(row))
                error = l1_difference(*density, self.reference(row))
                self.assertLessEqual(error, 1.05 * float(row["tolerance"]))
                self.assertGreater(error, 0.5 * float(row["tolerance"]))  # a reference on the same mesh would give 0
