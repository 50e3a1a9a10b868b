"""Every shipped scene of cloth and strings meets its own bars, as it is shipped."""

import os
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import gas_program
import springs_program


# Ten thousand launches of hundreds of vertices take threads seconds; both backends have the same kernels.
MANY_SMALL_STEPS = {"catenary", "curtain", "hencky", "pulled-rectangle", "strip", "swing-chord", "table-cloth", "twist"}


class Shipped(springs_program.SpringsTest):
    def assert_all_pass(self, backend, scenes):
        self.assertGreaterEqual(len(scenes), 7)
        for scene in scenes:
            with self.subTest(scene):
                self.expect(0, scene, "--backend", backend)
                told = self.result(f"out/{scene}")
                self.assertEqual(("ok", backend, scene), (told["status"], told["backend"], told["scene"]))
                self.assertGreaterEqual(len(told["checks"]), 1)
                self.assertTrue(all(check["passed"] and check["value"] <= check["bar"] for check in told["checks"]))

    def test_serial(self):
        self.assert_all_pass("serial", springs_program.SCENES)

    @gas_program.needs_openmp
    def test_openmp(self):
        self.assert_all_pass("openmp", [name for name in springs_program.SCENES if name not in MANY_SMALL_STEPS])


if __name__ == "__main__":
    unittest.main()
