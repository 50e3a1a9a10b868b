"""A contact at rest is preserved bit for bit by every scheme and limiter."""

import itertools

import gas_program
import hard_cases

BARS = [f"verify.{norm}_{quantity}=0.0" for norm in ("l1", "l2", "linf") for quantity in
        ("density", "velocity", "pressure")]


class StationaryContact(gas_program.GasTest):
    def assert_kept(self, backend, *sets):
        self.expect(0, "contact-stationary", "--quiet", "--overwrite", "--out", "run", "--backend", backend,
                    sets=[*sets, *BARS, "output.times=[0.0, 2.0]"])
        reported = self.result("run")
        self.assertTrue(reported["steps"] > 100 and all(value == 0.0 for value in reported["errors"].values()))
        file = gas_program.fields(self.folder / "run")
        first, last = file.children("/steps")
        for field in ("rho", "u", "p"):
            self.assertEqual(file.datasets[f"/steps/{first}/{field}"], file.datasets[f"/steps/{last}/{field}"])

    def test_every_scheme_preserves_the_contact(self):
        for scheme, limiter in itertools.product(("js", "z1", "z2", "teno5"), ("off", "on", "auto")):
            for backend in {"serial", gas_program.threaded()}:
                with self.subTest(scheme=scheme, limiter=limiter, backend=backend):
                    self.assert_kept(backend, f'scheme.positivity="{limiter}"', *hard_cases.scheme_sets(scheme))

    def test_preserves_a_contact_at_a_cell_centre(self):
        """On an odd mesh the initial state and the exact solution assign x0 to the same side."""
        self.assert_kept("serial", "mesh.cells=101")

    def test_other_settings_preserve_the_contact(self):
        choices = [('scheme.weno="m"',), ('scheme.time="ssprk43"', "scheme.cfl=1.2")]
        choices.append(('scheme.splitting="lf-global"',))  # lf-single smears the contact: alpha of its field is c
        choices += [(f'scheme.mean="{mean}"',) for mean in ("conserved", "roe")]
        for sets in choices:
            with self.subTest(sets=sets):
                self.assert_kept("serial", *sets)
