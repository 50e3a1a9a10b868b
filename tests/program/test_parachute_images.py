# ctest-label: no-sanitizer
"""drogue-parachute: sheets that reach images beyond periodic sides, where contact does not act."""

import parachute_program
from parachute_program import DRIFT

QUIET = ("--quiet", "--backend", "serial")
BALLS = "".join(f'[[body]]\nkind = "sphere"\ncentre = [0.6, 0.8, 0.{z}]\nradius = 0.25\nedge_length = 0.07\n' for z in (7, 9))


class Images(parachute_program.FlowTest):
    def test_sheet_that_meets_the_image_of_a_disk_ends_the_run(self):
        """At the first step after which it does, whatever is written, and again if the run is continued."""
        scene = self.write(DRIFT)
        sentence = self.expect(4, scene, *QUIET, "--out", "whole").stderr
        self.assertRegex(sentence, r"canopy\[0\] meets the image of body\[0\] beyond the periodic sides at "
                                   r"\(\S+, \S+, 1\.7\d+\) m after step \d+, t = 0\.4\d* s; ")
        self.assertEqual("numerical-failure", self.result("whole")["status"])
        last = self.history("whole")["time"][-1]
        self.assertIn(f"t = {last:.9g} s", sentence)
        self.assertEqual(sentence, self.expect(4, scene, *QUIET, "--out", "whole", "--restart", "auto").stderr)
        self.assertEqual(sentence, self.expect(4, scene, *QUIET, "--out", "rows", sets=["output.history_every=1"]).stderr)
        self.expect(0, scene, *QUIET, "--out", "part", sets=["run.end_time=0.3"])
        contact = self.write(DRIFT.replace("[run]", "[coupling]\ncontact = true\nthickness = 0.01\n[run]"), "contact.toml")
        self.assertIn("canopy[0] meets the image of body[0]", self.expect(4, contact, *QUIET, "--out", "contact").stderr)
        # The end has changed the steps before it.
        words = sentence.split(" m after ")[1]
        self.assertIn(words, self.expect(4, scene, *QUIET, "--out", "part", "--restart", "auto").stderr)
        # The same flow without an image.
        self.expect(0, scene, *QUIET, "--out", "wide", sets=["grid.domain=[[0,1.6],[0,1.6],[0,2.4]]", "grid.cells=[16,16,24]"])

    def test_output_at_the_end_of_a_run_is_looked_at(self):
        """Sheets may meet in the last step."""
        scene = self.write(DRIFT)
        self.expect(4, scene, *QUIET, "--out", "whole", sets=["output.history_every=1"])
        times = self.history("whole")["time"]
        self.expect(0, scene, *QUIET, "--out", "before", sets=[f"run.end_time={times[-2]!r}"])
        self.expect(4, scene, *QUIET, "--out", "at", sets=[f"run.end_time={times[-1]!r}"])

    def test_canopies_that_move_apart_meet_images(self):
        heavy = 'cloth = "custom"\narea_density = 20\nporosity = { law = "none" }\n'
        first = DRIFT[DRIFT.index("[[canopy]]"):DRIFT.index("[run]")]
        scene = DRIFT[:DRIFT.index("[[body]]")] + first.replace("1.2]", "0.4]") + heavy + first.replace("1.2]", "1.4]") + DRIFT[DRIFT.index("[run]"):]
        sentence = self.expect(4, self.write(scene), *QUIET, "--out", "out", sets=["run.end_time=2"]).stderr
        self.assertIn("canopy[1] meets the image of canopy[0] beyond the periodic sides", sentence)

    def test_flags_meet_images(self):
        """Flags fall, a long one through the lower side onto the image of a short one."""
        flag = ('[[flag]]\nleading_edge = {}\nlength = {}\nangle = 18\narea_density = 1.5\nbending_stiffness = 0.0015\n'
                'membrane_modulus = 200\nedge_length = 0.0625\n')
        scene = (DRIFT[:DRIFT.index("[grid]")] + "[grid]\ncells = [40, 16, 1]\ndomain = [[-1, 4], [-1, 1], [0, 0.125]]\n"
                 'boundary = { x = ["inflow", "outflow"], y = "periodic" }\n' + flag.format("[0.5, -0.6]", 1.2) + flag.format("[0.8, 0.51]", 0.3) +
                 "[coupling]\ngravity = [0, -20, 0]\n[run]\nend_time = 2\nmax_dt = 0.02\n")
        sentence = self.expect(4, self.write(scene), *QUIET, "--out", "out", sets=["fluid.velocity=[0.3,0,0]"]).stderr
        self.assertIn("flag[1] meets the image of flag[0] beyond the periodic sides at (0.8, 0.51, ", sentence)

    def test_bodies_may_overlap_within_the_domain(self):
        """Two that coincide have the force of one, and both have it where they cross periodic sides together."""
        scene = self.write(DRIFT[:DRIFT.index("[[body]]")] + BALLS + DRIFT[DRIFT.index("[run]"):].replace("0.6", "0.2"))
        ball = self.write(scene.read_text().replace(BALLS, BALLS[:len(BALLS) // 2]), "ball.toml")

        def forces(out, *sets, of=scene):
            process = self.start(of, *QUIET, "--out", out, sets=["grid.boundary.x=['inflow','outflow']", "fluid.velocity=[2,0,0]", *sets])
            self.assertEqual(0, process.returncode, process.stderr)
            rows = self.history(out)
            return [rows[name][-1] for name in ("body_0_force_x", "body_1_force_x") if name in rows]

        one, = forces("one", of=ball)
        self.assertGreater(one, 0.1)
        both = forces("both", "body[1].centre=[0.6,0.8,0.7]")
        self.assertAlmostEqual(one, sum(both), delta=1e-12 * one)
        self.assertAlmostEqual(both[0], both[1], delta=1e-12 * one)
        inside, across = forces("inside"), forces("across", "body[0].centre=[0.6,0.8,1.5]", "body[1].centre=[0.6,0.8,1.7]")
        self.assertGreater(sum(inside), 1.05 * one)
        for a, b in zip(inside, across):
            self.assertAlmostEqual(a, b, delta=1e-6 * one)
