"""Every shipped small scene of a parachute meets its bounds."""

import os
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import gas_program
import parachute_program


class ShippedParachutes(parachute_program.FlowTest):
    @gas_program.needs_openmp
    def test_openmp_meets_the_bounds(self):
        scenes = [name for name in parachute_program.SMALL_SCENES if name.startswith("c9-")]
        self.assertGreaterEqual(len(scenes), 6)
        for scene in scenes:
            with self.subTest(scene):
                self.expect(0, scene, "--backend", "openmp")
                told = self.result(f"out/{scene}")
                self.assertEqual(("ok", scene), (told["status"], told["scene"]))
                self.assertGreaterEqual(len(told["checks"]), 3)


if __name__ == "__main__":
    unittest.main()
