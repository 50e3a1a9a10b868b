"""Every shipped gas scene meets its tolerances unchanged."""

import gas_program


class Shipped(gas_program.GasTest):
    def assert_all_pass(self, backend):
        self.assertGreaterEqual(len(gas_program.SCENES), 18)
        for scene in gas_program.SCENES:
            with self.subTest(scene):
                self.expect(0, scene, "--backend", backend)
                reported = self.result(f"out/{scene}")
                self.assertEqual(("ok", backend, scene), (reported["status"], reported["backend"], reported["scene"]))
                self.assertIn("conservation", [check["name"] for check in reported["checks"]])
                self.assertGreaterEqual(len(reported["checks"]), 2)
                self.assertTrue(all(check["passed"] and check["value"] <= check["tolerance"] for check in reported["checks"]))
                outputs = gas_program.fields(self.folder / "out" / scene).children("/steps")
                self.assertGreaterEqual(len(outputs), 2)

    def test_serial_meets_the_tolerances(self):
        self.assert_all_pass("serial")

    @gas_program.needs_openmp
    def test_openmp_meets_the_tolerances(self):
        self.assert_all_pass("openmp")
