# ctest-label: no-sanitizer
"""drogue-parachute: grids whose cells grow outside of a core, and grids that are given by their faces."""

import itertools
import math

import parachute_program
from parachute_program import CANOPY, CORE, GROWING

QUIET = ("--quiet", "--backend", "serial")


class Grid(parachute_program.FlowTest):
    def test_files_hold_its_faces(self):
        self.expect(0, self.write(GROWING), *QUIET, "--out", "out")
        fields = self.fields("out")
        faces = {axis: list(fields.values(f"/mesh/{axis}")) for axis in "xyz"}
        self.assertEqual([0, 0.2, 0.35, 0.5, 0.65, 0.8, 1], faces["z"])
        self.assertEqual(3 * 12 * 10 * 6, len(fields.values("/steps/000001/velocity")))
        points = list(fields.values("/mesh/points"))
        self.assertEqual(3 * 13 * 11 * 7, len(points))
        self.assertEqual([1.2, 0.86, 0.5], points[3 * ((8 * 11 + 8) * 7 + 3):][:3])
        self.assertLess(max(self.history("out")["divergence_max"]), 1e-12)

    def test_continues_bit_for_bit_and_refuses_another_grid(self):
        scene = self.write(GROWING)
        self.expect(0, scene, *QUIET, "--out", "whole", sets=["output.restart_every=7"])
        rows = self.history("whole")
        self.assert_continues(rows, scene, ["run.end_time=0.2", "output.times=[0.2]", "output.history_every=1"], ["output.history_every=1"],
                              columns=("kinetic_energy", "momentum_x", "divergence_max"))
        other = self.write(GROWING.replace("0.35, 0.5", "0.36, 0.5"), "other.toml")
        self.assertIn("grid.faces", self.expect(6, other, *QUIET, "--out", "other", "--restart", "whole/restart.h5").stderr)

    def test_uniform_flow_and_norms_know_the_widths(self):
        """A uniform stream stays itself; the mean of x^2 over cells of all widths is that of the domain."""
        still = GROWING.split("[initial]")[0].replace('["1 + 0.3*sin(5*t) + 0.2*y*(1-y)", 0, "0.1*y"]', "[1, 0, 0]").replace(
            'boundary = { x = ["inflow", "outflow"], y = ["wall", "slip"], z = "wall" }\nwall_velocity = { y_low = ["0.5*cos(t)", 0, 0] }\n',
            'boundary = { x = ["inflow", "outflow"], y = "slip", z = "slip" }\n')
        verify = "[run]\nend_time = 0.3\n[verify]\nexact = { x = {}, y = 0, z = 0 }\nlinf_velocity = {}\n[[verify.profile]]\n" \
                 'component = "x"\nalong = "y"\nthrough = [0.7, 0, 0.42]\npoints = [[0, 1], [0.3, 1]]\ntolerance = 0\n'
        self.expect(0, self.write(still + verify.replace("{}", "1", 1).replace("{}", "0")), *QUIET, "--out", "out")
        self.expect(0, self.write(still + verify.replace("{}", '"1-y^2"', 1).replace("{}", "1")), *QUIET, "--out", "mean")
        # By the midpoints of the cells, each with its width.
        faces = [0, 0.06, 0.14, 0.24, 0.36, 0.5, 0.64, 0.76, 0.86, 0.94, 1]
        mean = sum((b - a) * ((a + b) / 2) ** 2 for a, b in itertools.pairwise(faces))
        self.assertAlmostEqual(mean, self.result("mean")["errors"]["l1_velocity"], delta=1e-14)

    def test_canopy_in_a_core_has_less_drag_than_in_a_duct(self):
        sets = ["run.end_time=0.6", "output={fields=['velocity'],times=[0.2,0.6],history_every=2}"]
        for name, text in (("duct", CANOPY), ("core", CORE)):
            self.expect(0, self.write(text), *QUIET, "--out", name, sets=sets)
        last = {name: self.history(name)["canopy_0_drag_coefficient"][-1] for name in ("duct", "core")}
        self.assertGreater(last["duct"], 1.08 * last["core"])
        self.assertGreater(last["core"], 0.5)
        # Forces on the grid are those of the vertices, and a run continues bit for bit.
        self.assertLess(max(self.history("core")["force_balance"]), 1e-14)
        self.assert_continues(self.history("core"), self.write(CORE), [*sets, "run.end_time=0.2", "output.times=[0.2]"], sets)

    def test_canopy_that_leaves_the_core_ends_the_run(self):
        free = CORE.replace("fixed = true", "fixed = false").replace("end_time = 0.2", "end_time = 5").replace("times = [0.1, 0.2]", "times = [5]")
        process = self.expect(4, self.write(free), *QUIET, "--out", "out")
        self.assertRegex(process.stderr, r"canopy\[0\] leaves the core of the grid: its (cloth|payload) at .* m comes closer than two cells to "
                                         r"its end towards z_high after step \d+, t = \S+ s; a larger grid\.core or a shorter run\.end_time may save the run; it leans by \S+ degrees")
        rows = self.history("out")
        self.assertLess(rows["canopy_0_payload_z"][-1], 3.4)
        outside = self.expect(3, self.write(CORE), "--check", sets=["canopy[0].centre=[0,0,-0.9]"]).stderr
        self.assertIn("canopy[0] with its payload reaches from -2.39", outside)
        self.assertIn("beyond the core of the grid less two cells at each end: it must lie strictly between -2.2 and 3.0 m", outside)

    def test_grid_follows_the_middle_of_canopy_and_payload(self):
        """A payload that is pushed aside with its canopy stays in the core, across the stream too."""
        free = CORE.replace("fixed = true", "fixed = false").replace("times = [0.1, 0.2]", "times = [1]").replace(
            'x = "slip", y = "slip"', 'x = ["inflow", "outflow"], y = "slip"').replace("core =", 'frame = "follow"\ncore =')
        sets = ["coupling.gravity=[2, 0, -9.81]", "run.end_time=1", "output={fields=['velocity'],times=[0.4,1],history_every=2}",
                "fluid.velocity=[0,0,4]"]
        self.expect(0, self.write(free), *QUIET, "--out", "out", sets=sets)
        rows = self.history("out")
        self.assertGreater(rows["frame_position_x"][-1], 0.1)
        self.assertGreater(abs(rows["frame_velocity_z"][-1]), 0.5)
        # In the grid, the middle between the payload and the mean of skirt and crown hardly moves.
        start = -math.sqrt(1.8**2 - 1)
        payload = [rows["canopy_0_payload_x"][-1] - rows["frame_position_x"][-1], rows["canopy_0_payload_z"][-1] - rows["frame_position_z"][-1]]
        self.assertLess(abs(payload[0]), 0.5)
        self.assertLess(abs(payload[1] - start), 0.5)
        self.assert_continues(rows, self.write(free), [*sets, "run.end_time=0.4", "output.times=[0.4]"], sets)

    def test_check_prints_the_size(self):
        report = self.start(self.write(CORE), "--check").stdout
        self.assertRegex(report, r"grid +\d+ x \d+ x \d+ cells, \d+ in all\n +along x a core of 20 of 0\.2 m, others up to \S+ m\n"
                                 r" +along y a core of 20 of 0\.2 m, others up to \S+ m\n +along z a core of 30 of 0\.2 m, others up to \S+ m\n"
                                 r"coupling +edge_inset = 0\.66, leak_filter = 0\.5, filter = by the law of the cloth\nmemory +\S+ MiB for its arrays\ntime +about \S+ \S+ on two cores, \S+ \S+ on one H200, an estimate: "
                                 r"\S+ steps at 2\.5 times the speed of the start, each with \S+ of the cloth\n")
        memory = float(report.split("memory")[1].split()[0])
        self.expect(0, self.write(CORE), *QUIET, "--out", "out", sets=["run.end_time=0.02", "output.times=[0.02]", "verify={}"])
        # What scene.toml leaves to defaults.
        used = self.result("out")["coupling"]
        self.assertEqual((0.5, "by the law of the cloth"), (used["leak_filter"], used["filter"]))
        self.assertAlmostEqual(0.66, used["edge_inset"], delta=0.005)
        views = self.result("out")["peak_bytes"]["device"] / 2**20
        self.assertLess(abs(memory / views - 1), 0.35, (memory, views))

    def test_studies_scale_the_width_of_cells(self):
        exact = GROWING.split("[grid]")[0] + '[grid]\ncore = [[0.5, 1.5], [0, 1], [0, 1]]\nspacing = [0.1, 0.1, 1]\ngrowth = 1.1\n' \
            'domain = [[0, 2], [0, 1], [0, 1]]\nboundary = { x = "periodic", y = "periodic" }\n[run]\nend_time = 0.05\n' \
            '[verify]\nexact = { x = "1+0.1*sin(pi*x)", y = 0, z = 0 }\n'
        self.expect(0, self.write(exact), "--quiet", "--backend", "serial", "--out", "study", "--study", "meshes=18:36", sets=["fluid.velocity=[1,0,0]"])
        cells = [int(row["cells"]) for row in self.table("study/study.csv")]
        self.assertLess(abs(cells[1] / cells[0] - 2), 0.3)
        faces = self.expect(2, self.write(GROWING), "--study", "meshes=16:32", sets=["verify.exact={x=1,y=0,z=0}"]).stderr
        self.assertIn("--study with meshes needs grid.cells or grid.core", faces)
