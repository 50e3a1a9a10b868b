"""A contact at rest is kept bit for bit: no scheme or limiter may move it."""

import itertools
import os
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import gas_program
import hard_cases

BARS = [f"verify.{norm}_{quantity}=0.0" for norm in ("l1", "l2", "linf") for quantity in
        ("density", "velocity", "pressure")]


class StationaryContact(gas_program.GasTest):
    def assert_kept(self, backend, *sets):
        self.expect(0, "contact-stationary", "--quiet", "--overwrite", "--out", "run", "--backend", backend,
                    sets=[*sets, *BARS, "output.times=[0.0, 2.0]"])
        told = self.result("run")
        self.assertTrue(told["steps"] > 100 and all(value == 0.0 for value in told["errors"].values()))
        file = gas_program.fields(self.folder / "run")
        first, last = file.children("/steps")
        for field in ("rho", "u", "p"):
            self.assertEqual(file.datasets[f"/steps/{first}/{field}"], file.datasets[f"/steps/{last}/{field}"])

    def test_schemes(self):
        for scheme, limiter in itertools.product(("js", "z1", "z2", "teno5"), ("off", "on", "auto")):
            for backend in {"serial", gas_program.threaded()}:
                with self.subTest(scheme=scheme, limiter=limiter, backend=backend):
                    self.assert_kept(backend, f'scheme.positivity="{limiter}"', *hard_cases.scheme_sets(scheme))

    def test_contact_at_a_cell_centre(self):
        """An odd mesh: initial state and exact solution agree on which side x0 belongs to."""
        self.assert_kept("serial", "mesh.cells=101")

    def test_other_choices(self):
        choices = [('scheme.weno="m"',), ('scheme.time="ssprk43"', "scheme.cfl=1.2")]
        choices.append(('scheme.splitting="lf-global"',))  # lf-single smears it: alpha of the contact's field is c
        choices += [(f'scheme.mean="{mean}"',) for mean in ("conserved", "roe")]
        for sets in choices:
            with self.subTest(sets=sets):
                self.assert_kept("serial", *sets)


if __name__ == "__main__":
    unittest.main()
