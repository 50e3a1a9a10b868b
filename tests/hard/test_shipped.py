"""Every shipped gas scene meets its tolerances unchanged."""

import gas_program


class Shipped(gas_program.GasTest):
    def assert_conserved(self, reported):
        self.assertIn("conservation", [check["name"] for check in reported["checks"]])
        self.assert_within(reported)
        self.assertGreaterEqual(len(self.fields(f"out/{reported['scene']}").children("/steps")), 2)

    def test_serial_meets_the_tolerances(self):
        self.assertGreaterEqual(len(gas_program.SCENES), 18)
        self.assert_all_pass("serial", gas_program.SCENES, 2, self.assert_conserved)

    @gas_program.needs_openmp
    def test_openmp_meets_the_tolerances(self):
        self.assert_all_pass("openmp", gas_program.SCENES, 2, self.assert_conserved)
