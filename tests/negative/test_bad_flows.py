"""Invalid scenes of drogue-parachute end with exit code 3 and a sentence that names file, line and key."""

import re

import bad_bodies
import bad_canopies
import bad_flags
import bad_flows
import mutations
import parachute_program


class BadFlows(parachute_program.FlowTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write(bad_flows.GOOD)

    def accept(self, *sets):
        process = self.start(self.scene, "--check", sets=sets)  # which may warn of a canopy
        self.assertEqual(0, process.returncode, process.stderr)

    def sound(self, text, *sets):
        """Writes a scene, which must be valid."""
        self.write(text)
        self.accept(*sets)

    def refusal(self, *sets):
        process = self.expect(3, self.scene, "--check", sets=sets)
        self.assertEqual("", process.stdout)
        return process.stderr

    def test_unchanged_scene_is_valid(self):
        self.accept()

    def assert_lines_are_rejected(self, good, bad_lines):
        self.sound(good)
        for number, text, blamed, words in bad_lines:
            with self.subTest(line=number, text=text):
                lines = good.splitlines(keepends=True)
                lines[number - 1] = text + "\n"
                self.write("".join(lines))
                message = self.refusal()
                self.assertTrue(message.startswith(f"{self.scene}:{blamed}: "), message)
                for word in words:
                    self.assertIn(word, message)

    def test_rejects_invalid_lines(self):
        self.assertGreaterEqual(len(bad_flows.BAD_LINES), 60)
        self.assert_lines_are_rejected(bad_flows.GOOD, bad_flows.BAD_LINES)

    def test_rejects_invalid_bodies(self):
        self.assertGreaterEqual(len(bad_bodies.BAD_LINES), 30)
        self.assert_lines_are_rejected(bad_bodies.GOOD, bad_bodies.BAD_LINES)

    def test_rejects_bodies_that_close_a_channel_with_a_prescribed_flow_rate(self):
        closed = bad_bodies.GOOD.replace('y = "slip"', 'y = "periodic"').replace("[0.4, 0.8]", "[0.8, 0.8]")
        closed = closed[:closed.index("[verify]")]
        self.sound(closed)
        none = "body[0].porosity={law='none'}"
        self.assertIn("body[0] closes the channel along x and is impermeable", self.refusal(none))
        self.accept(none, "body[0].lengths=[0.6,0.8]")
        self.accept(none, "grid.boundary.x='periodic'")
        self.assertIn("closes the channel", self.refusal(none, "coupling.method='sharp'", "grid.boundary.y='wall'", "grid.boundary.z='slip'"))
        box = ("fluid.velocity=[0,0,0]", "grid.boundary.x='wall'", none)
        self.accept(*box)
        moving = "body[0].motion={x='0.1*sin(t)'}"
        self.assertIn("closes the channel", self.refusal(*box, moving))
        self.accept(*box[:2], moving)
        second = '[[body]]\nkind = "plate"\nnormal = "x"\ncentre = [0.4, 0.4, 0.4]\nlengths = [0.8, 0.8]\nedge_length = 0.05\n'
        self.write(closed.replace("[coupling]", second + "[coupling]"))
        periodic = ("grid.boundary.x='periodic'", none)
        self.accept(*periodic)
        self.assertIn("as another body that moves otherwise", self.refusal(*periodic, moving))

    def test_notes_bodies_that_nearly_close_a_channel(self):
        text = bad_bodies.GOOD[:bad_bodies.GOOD.index("[verify]")].replace('y = "slip"', 'y = "periodic"')
        self.write(text.replace("max_dt = 0.01\n", ""))
        process = self.start(self.scene, "--check", sets=["body[0].lengths=[0.65,0.8]"])
        self.assertEqual(0, process.returncode)
        self.assertIn("body[0] covers most of the channel along x: its force follows sudden changes", process.stderr)
        self.accept("body[0].lengths=[0.65,0.8]", "run.max_dt=0.01")
        self.accept()

    def test_notes_cloth_that_closes_a_channel_or_nearly_does(self):
        drop = '[flow]\npressure_drop = [20, 0, 0]\n'
        box = drop.join(('app = "parachute"\n[fluid]\n[grid]\ncells = [24, 12, 12]\ndomain = [[0, 2], [0, 1], [0, 1]]\n'
                         'boundary = { x = "periodic", y = "periodic", z = "periodic" }\n',
                         '[coupling]\ngravity = [0, 0, -0.5]\n[run]\nend_time = 0.3\n'))
        drum = ('[[canopy]]\nkind = "drum"\ndiameter = 0.9\ngores = 8\nvent = 0\nedge_length = 0.05\n'
                'centre = [1, 0.5, 0.5]\nangle = 90\ntension = 2000\ncloth = "custom"\narea_density = 5\n')
        flag = ('[[flag]]\nleading_edge = [1, 0]\nlength = 1\nangle = 90\narea_density = 1\nbending_stiffness = 100\n'
                'edge_length = 0.05\n')
        for name, text, shape in (("canopy[0]", box + drum, "canopy[0].diameter=0.7"),
                                  ("flag[0]", box.replace("12, 12]", "12, 1]") + flag, "flag[0].length=0.5")):
            with self.subTest(name):
                self.write(text)
                process = self.start(self.scene, "--check")
                self.assertEqual(0, process.returncode, process.stderr)
                self.assertIn(f"{name} covers most of the channel along x at the start: its force follows", process.stderr)
                for sets in ([shape], ["run.max_dt=0.01"]):
                    self.assertNotIn("covers", self.start(self.scene, "--check", sets=sets).stderr)

    def test_rejects_oblique_sheets_that_close_a_channel_without_a_largest_step(self):
        closed = bad_bodies.GOOD.replace('y = "slip"', 'y = "periodic"').replace('x = ["inflow", "outflow"]', 'x = "periodic"')
        closed = closed.replace('kind = "plate"\nnormal = "x"', 'kind = "file"').replace("lengths = [0.4, 0.8]\nedge_length = 0.05", 'file = "oblique.obj"')
        self.write(closed[:closed.index("[verify]")].replace("max_dt = 0.01\n", ""))
        n = 20
        points = [(0.4 * i / n - 0.2, 0.8 * i / n - 0.4, 0.8 * k / n - 0.4) for i in range(n + 1) for k in range(n + 1)]
        faces = [f for i in range(n) for k in range(n) for a in [(n + 1) * i + k + 1] for f in ((a, a + n + 1, a + n + 2), (a, a + n + 2, a + 1))]
        (self.folder / "oblique.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in points)
                                                 + "".join(f"f {a} {b} {c}\n" for a, b, c in faces), encoding="utf-8")
        self.assertIn('missing key "run.max_dt"', self.refusal())
        self.accept("run.max_dt=0.01")

        halves = "".join(f'[[body]]\nkind = "plate"\nnormal = "x"\ncentre = [0.8, {y}, 0.4]\nlengths = [0.4, 0.8]\nedge_length = 0.05\n'
                         f'porosity = {{ law = "{law}" }}\n' for y, law in ((0.2, "forchheimer"), (0.6, "none")))
        self.write(closed[:closed.index("[[body]]")] + halves + "[run]\nend_time = 1\n")
        self.assertIn("body[0] with others closes the channel along x", self.refusal())
        self.accept("run.max_dt=0.01")
        self.accept("body[1].centre=[0.4,0.6,0.4]")
        stream = ("grid.boundary.x=['inflow','outflow']", "run.max_dt=0.01")
        self.accept(*stream)
        self.assertIn("and is impermeable", self.refusal(*stream, "body[0].porosity.law='none'"))

    def test_rejects_bodies_that_move_through_others_and_notes_shared_forces(self):
        spheres = ('app = "parachute"\n[fluid]\nvelocity = [1, 0, 0]\n[grid]\ncells = [20, 10, 10]\ndomain = [[0, 2], [0, 1], [0, 1]]\n'
                   'boundary = { x = ["inflow", "outflow"], y = "periodic", z = "periodic" }\n'
                   + "".join(f'[[body]]\nkind = "sphere"\ncentre = [{x}, 0.5, 0.5]\nradius = 0.2\nedge_length = 0.06\n' for x in (0.5, 0.8))
                   + "[run]\nend_time = 1\n")
        self.write(spheres)

        def notice(*sets):
            process = self.start(self.scene, "--check", sets=sets)
            self.assertEqual(0, process.returncode, process.stderr)
            return process.stderr

        self.assertIn("body[1] overlaps body[0]: each has a share of the force", notice())
        self.assertNotIn("overlaps", notice("body[1].centre=[0.91,0.5,0.5]"))
        apart = ("body[1].centre=[1.2,0.5,0.5]",)
        self.accept(*apart)
        self.assertIn("body[1] crosses body[0] at t = ", self.refusal(*apart, "body[1].motion={x='-0.7*t'}"))
        same = ("body[0].motion={x='0.1*t'}", "body[1].motion={x='0.1*t'}")
        self.accept(*apart, *same)
        self.assertIn("body[1] overlaps body[0]", notice(*same))
        # Plates may touch along an edge and in a corner.
        plates = spheres[:spheres.index("[[body]]")] + "".join(
            f'[[body]]\nkind = "plate"\nnormal = "{n}"\ncentre = {c}\nlengths = [0.4, 0.4]\nedge_length = 0.05\n'
            for n, c in (("x", "[0.5, 0.5, 0.5]"), ("y", "[0.7, 0.3, 0.5]"))) + "[run]\nend_time = 1\n"
        self.write(plates)
        self.assertNotIn("overlaps", notice())
        self.assertIn("overlaps", notice("body[1].centre=[0.63,0.43,0.5]"))

    def test_rejects_lines_of_canopies_through_bodies(self):
        body = '[[body]]\nkind = "sphere"\ncentre = CENTRE\nradius = 0.12\nedge_length = 0.05\n'
        free = bad_canopies.GOOD[:bad_canopies.GOOD.index("[verify]")]
        for centre, crosses in (([-1, 0, -0.8], True), ([0, 0, 0], False)):
            self.write(free.replace("[coupling]", body.replace("CENTRE", str(centre)) + "[coupling]"))
            if crosses:
                self.assertIn("crosses body[0] at the start", self.refusal())
            else:
                self.accept()

    def test_rejects_grids_that_cannot_follow_a_payload(self):
        follow = 'grid.frame="follow"'
        self.assertIn('grid.frame = "follow" applies only with a [[canopy]]', self.refusal(follow))
        free = bad_canopies.GOOD[:bad_canopies.GOOD.index("[verify]")].replace("fixed = true", "fixed = false")
        self.sound(free, follow)
        self.assertIn("canopy[0].payload.fixed is true", self.refusal(follow, "canopy[0].payload.fixed=true"))
        guided = "canopy[0].payload={mass=0.5,guided=true}"
        self.accept(follow, guided)
        self.assertIn("moves along x, whose sides are open; canopy[0].payload.guided",
                      self.refusal(follow, guided, 'grid.boundary.x=["inflow","outflow"]'))
        for side in ("periodic", "slip", "wall"):
            self.assertIn('needs an axis whose sides are "inflow" or "outflow"',
                          self.refusal(follow, "fluid.velocity=[0, 0, 0]", f'grid.boundary.z="{side}"'))
        self.assertIn("fluid.velocity = 5+0*t must be a number", self.refusal(follow, 'fluid.velocity=[0, 0, "5+0*t"]'))
        self.assertIn("grid.wall_velocity.x_low = t must be a number",
                      self.refusal(follow, 'grid.boundary.x="wall"', 'grid.wall_velocity.x_low=[0, 0, "t"]'))
        body = '[[body]]\nkind = "plate"\nnormal = "z"\ncentre = [0, 0, 0.5]\nlengths = [0.2, 0.2]\nedge_length = 0.05\n'
        self.sound(free.replace("[coupling]", body + "[coupling]"))
        self.assertIn("cannot be combined with a [[body]]", self.refusal(follow))

    def test_rejects_invalid_canopies(self):
        self.assertGreaterEqual(len(bad_canopies.BAD_LINES), 50)
        self.assert_lines_are_rejected(bad_canopies.GOOD, bad_canopies.BAD_LINES)

    def test_rejects_ratios_to_a_speed_of_zero(self):
        self.write(bad_canopies.GOOD)
        still = ("fluid.velocity=[0, 0, 0]", "verify={leak=[{canopy=CANOPY,from=0.05,to=0.1,tolerance=1}]}")

        def still_air(canopy):
            return [text.replace("CANOPY", str(canopy)) for text in still]

        self.assertIn("verify.leak[0] is relative to the speed of the fluid far upstream, which is 0: fluid.velocity is 0 and "
                      "canopy[0].payload.fixed is true", self.refusal(*still_air(0)))
        # The other payload moves, and the speed is that of the payload.
        self.accept(*still_air(1))
        risers = ["canopy[0].riser={length=0.05}", "canopy[1].riser={length=0.05}", "canopy[1].payload={shared=0}", "canopy[1].angle=60",
                  "canopy[0].angle=-60", "canopy[0].centre=[0, 0, 0]", "grid.domain=[[-4, 4], [-4, 4], [-4, 4]]", "grid.cells=[80, 80, 80]"]
        self.accept(*risers, still_air(1)[1])
        self.assertIn("canopy[0].payload.fixed is true", self.refusal(*risers, *still_air(1)))
        self.write(bad_canopies.DRUM)
        self.assertIn('canopy[0].kind is "drum"', self.refusal(still_air(0)[1]))

    def test_rejects_flows_in_cloth_drops(self):
        self.sound(parachute_program.CLOTH)
        for key in ("grid={cells=[8,8,8],domain=[[0,1],[0,1],[0,1]]}", "flow.time=ab2", "initial.velocity=[1,0,0]",
                    "body=[{kind='sphere',centre=[0,0,0],radius=1,edge_length=0.1}]", "tuning.step.driver=plain", "coupling.method=spread",
                    "coupling.filter=0.5", "canopy[0].porosity.law=none", "canopy[0].lines.strength=100", "canopy[0].lines.drag={}", "run.cfl=0.5",
                    "run.max_dt=0.01", "verify.divergence=1", "verify.momentum=1", "verify.energy_growth=1",
                    "verify.speed_growth=1", "verify.force_balance=1", "verify.exact={x=0,y=0,z=0}"):
            name = re.search(r": (\S+) applies only with \[fluid\]", self.refusal(key))
            self.assertIsNotNone(name, key)
            self.assertTrue(key.startswith(name[1]), key)
        def mean(column):
            return f"verify.history=[{parachute_program.statistic(column, 'mean', 1, 1)}]"

        for key, words in {mean("canopy_0_drag_coefficient"): "which needs [fluid]", mean("canopy_0_airspeed"): "which needs [fluid]",
                           mean("outflow_x_low"): "no column", "output.fields=['velocity']": '"velocity" needs [fluid]', "run.dt=0": "run.dt",
                           "output.fields=['position','vorticity']": '"vorticity" needs [fluid]',
                           "canopy[0].edge_length=1e-4": "2^20", "coupling.gravity=[0,0,1e30]": "an edge of canopy[0]", "coupling.allow_unstable=true": "coupling.allow_unstable",
                           "canopy[0].lines.length=0.9": "do not reach the payload"}.items():
            self.assertIn(words, self.refusal(key), key)
        self.assertIn('missing table "grid" (needed with [fluid])', self.refusal("fluid.density=1"))

    def test_rejects_checks_of_energy_that_is_not_conserved(self):
        self.write(parachute_program.CLOTH)
        drift = "verify.energy_drift=1e-3"
        self.accept(drift)
        for key, words in {"coupling.contact=true": "contact of cloth", "canopy[0].payload.release=0.1": "lines of canopy[0] are cut",
                           "canopy[0].reefing={length=5.9,cut=0.2}": "reefing", "output.history_every=0": "history_every"}.items():
            self.assertIn(words, self.refusal(drift, key), key)
        self.write(bad_canopies.GOOD)
        self.assertIn("verify.energy_drift applies only without [fluid]", self.refusal(drift))
        self.write('app = "parachute"\n[run]\nend_time = 1\n')
        self.assertIn('missing table "fluid"', self.refusal())

    def test_rejects_lines_of_sheets(self):
        sheet = bad_canopies.GOOD.replace('[[canopy]]\nkind = "flat-circular"\ndiameter = 1.2\ngores = 8\nedge', '[[canopy]]\nkind = "sheet"\ndiameter = 1.2\ngores = 8\nedge')
        sheet = sheet.replace("centre = [1, 0, 0]\nlines = { length = 1.1 }\n", "centre = [1, 0, 0]\n")
        self.write(sheet)
        self.assertIn("verify.peak_force[0].canopy: this canopy has no lines", self.refusal())
        self.sound(sheet.replace("[{ canopy = 1, force", "[{ canopy = 0, force"))
        # A sheet has no payload to follow or to share.
        self.write(bad_canopies.GOOD)
        first = 'canopy[0].kind="sheet"'
        self.accept(first)
        self.assertIn("needs a payload; canopy[0] has none", self.refusal(first, 'grid.frame="follow"'))
        shared = ("canopy[1].payload={shared=0}", "canopy[1].riser={length=1}")
        self.assertIn("this canopy has no payload of its own", self.refusal(first, *shared))
        # All canopies on a payload have a riser, and room.
        first = "canopy[0].riser={length=0.05}"
        self.assertIn('missing key "canopy[1].riser"', self.refusal(first, shared[0]))
        message = self.refusal(first, shared[0], "canopy[1].riser={length=0.05}")
        self.assertIn("canopy[1] overlaps canopy[0]", message)

    def test_rejects_invalid_drums(self):
        self.assert_lines_are_rejected(bad_canopies.DRUM, bad_canopies.BAD_DRUM_LINES)

    def test_rejects_invalid_flags(self):
        self.assert_lines_are_rejected(bad_flags.GOOD, bad_flags.BAD_LINES)
        for cells, sentence in (("[40, 24, 4]", 'missing key "flag[0].width" (needed with several cells along z)'),
                                ("[40, 1, 24]", "flag[0] needs a grid with several cells along x and y")):
            flat = bad_flags.GOOD.replace("[40, 24, 1]", cells).replace('y = "slip" }', 'y = "periodic", z = "periodic" }')
            self.write(flat)
            self.assertIn(sentence, self.refusal())
        self.sound(bad_flags.WIDE)
        self.assertIn("flag[0] reaches from 0.5 to 1.0 m along z", self.refusal("flag[0].middle=0.75"))
        self.assertIn("flag[0].edge_length = 0.09 m is too coarse", self.refusal("flag[0].edge_length=0.09", "flag[0].width=0.9"))
        self.accept("flag[0].edge_length=0.09", "flag[0].width=0.7")
        self.assertIn("flag[0].width = 1.3 m: the flag meets itself",
                      self.refusal('grid.boundary.z="periodic"', "flag[0].width=1.3"))
        plate = '[[body]]\nkind = "plate"\nnormal = "x"\ncentre = [2, 0, 0.0625]\nlengths = [0.5, 0.125]\nedge_length = 0.0625\n'
        self.write(bad_flags.GOOD.replace("[coupling]", plate + "[coupling]"))
        self.assertIn("flag[0] cannot be combined with a [[body]] or a [[canopy]]", self.refusal())
        second = '[[flag]]\nleading_edge = [0, 0.5]\nlength = 1\narea_density = 1\nbending_stiffness = 0.1\nedge_length = 0.0625\n'
        self.write(bad_flags.GOOD.replace("[coupling]", second + "[coupling]"))
        self.assertIn("flag[1].bending_stiffness differs from that of flag[0]", self.refusal())

    def test_rejects_canopies_on_a_plane(self):
        self.write(bad_canopies.GOOD.replace("cells = [40, 20, 24]", "cells = [40, 1, 24]"))
        self.assertIn("canopy[0]: the grid has one cell along y", self.refusal())

    def test_rejects_requests_without_canopies(self):
        for key, words in {"coupling.gravity=[0, 0, -9.81]": "[[canopy]]", "output.fields=['position']": "[[canopy]]",
                           "verify.force_balance=1": "[[canopy]]",
                           "verify.peak_force=[{force=[1,2]}]": "verify.peak_force[0] needs a [[canopy]]"}.items():
            with self.subTest(key):
                self.assertIn(words, self.refusal(key))

    def test_rejects_invalid_round_bodies(self):
        self.sound(bad_bodies.ROUND, "body[0].centre=[0.5,0.4,0.1]")  # across periodic sides
        self.assert_lines_are_rejected(bad_bodies.ROUND, bad_bodies.BAD_ROUND_LINES)

    def test_rejects_canopies_that_meet_images_of_others(self):
        scene = bad_canopies.GOOD[:bad_canopies.GOOD.index("[verify]")].replace(
            'x = "slip"', 'x = "periodic"').replace("centre = [-1, 0, 0]", "centre = [-1.1, 0, 0]")
        self.sound(scene)
        away = "grid.domain=[[-1.5,1.5],[-1,1],[-1.4,1]]"
        cells = "grid.cells=[30,20,24]"
        self.assertIn("canopy[1] overlaps the image, beyond periodic sides, of canopy[0] at the start", self.refusal(away, cells))
        one = scene[:scene.index("angle")] + scene[scene.index("centre"):scene.rindex("[[canopy]]")] + scene[scene.index("[coupling]"):]
        self.sound(one, away, cells)
        narrow = ("grid.domain=[[-1.5,-0.7],[-1,1],[-1.4,1]]", "grid.cells=[8,20,24]")
        self.assertIn("canopy[0] overlaps the image, beyond periodic sides, of canopy[0]", self.refusal(*narrow))
        # The lines of a canopy reach through the cloth of its image below.
        below = ('grid.boundary.z="periodic"', "grid.domain=[[-2,2],[-1,1],[-0.4,0.6]]", "grid.cells=[40,20,10]")
        self.assertIn("canopy[0] with its lines crosses the image of canopy[0] beyond the periodic sides at the start", self.refusal(*below))

    def test_rejects_bodies_that_meet_images_of_others(self):
        """Bodies may touch images at the sides, but not cross the image of another one."""
        ball = 'kind = "sphere"\ncentre = [0.5, 0.4, 0.4]\nradius = 0.2\nedge_length = 0.05\n'
        second = "[[body]]\n" + ball.replace("0.4, 0.4]", "0.4, 0.6]")
        head = bad_bodies.GOOD[:bad_bodies.GOOD.index("kind")]
        scene = head + ball + second + "[run]\nend_time = 0.5\nmax_dt = 0.01\n"
        self.sound(scene, "body[0].centre=[0.5,0.4,0.2]")  # touch at one point
        across = "body[0].centre=[0.5,0.4,0.05]"
        message = self.refusal(across)
        self.assertIn("body[1] crosses the image of body[0] beyond the periodic sides at the start", message)
        self.assertIn(":15: ", message)
        self.accept(across, "body[1].centre=[1.1,0.4,0.6]")
        moves = "body[1].motion={z='0.4*t'}"
        between = ("body[0].centre=[0.5,0.4,0.1]", "body[1].centre=[0.5,0.4,0.5]", "body[1].radius=0.15")
        self.accept(*between)
        self.assertRegex(self.refusal(*between, moves),
                         r"body\[1\] crosses the image of body\[0\] beyond the periodic sides at t = 0\.1[2-4]\d* s")
        # Plates of a duct that spans the domain meet along edges that touch their images at the sides.
        wall = 'kind = "plate"\nnormal = "y"\ncentre = [0.8, 0.2, 0.4]\nlengths = [0.4, 0.8]\nedge_length = 0.05\n'
        side = '[[body]]\nkind = "plate"\nnormal = "x"\ncentre = [0.6, 0.4, 0.4]\nlengths = [0.4, 0.8]\nedge_length = 0.05\n'
        self.sound(scene.replace(ball + second, wall + side))

    def test_rejects_flags_that_meet_images_of_others(self):
        """Two flags lean apart, and one crosses the image of the other."""
        first = bad_flags.GOOD[bad_flags.GOOD.index("[[flag]]"):bad_flags.GOOD.index("[coupling]")]
        second = first.replace("0.02]", "-1.4]").replace("angle = 18", "angle = -18")
        scene = bad_flags.GOOD.replace('y = "slip"', 'y = "periodic"').replace(first, first.replace("0.02]", "1.2]") + second)
        self.write(scene)
        self.assertIn("flag[1] crosses the image of flag[0] beyond the periodic sides at the start", self.refusal())
        self.accept("flag[0].angle=-18")

    def test_rejects_surfaces_with_one_side_and_turns_the_faces_of_others(self):
        scene = bad_bodies.ROUND.replace('kind = "sphere"', 'kind = "file"\nfile = "body.obj"').replace("radius = 0.2\nedge_length = 0.05\n", "", 1)
        self.write(scene.replace("velocity = [1, 0, 0]", "velocity = [0, 0, 0]"))  # a stream has warnings
        mesh = self.scene.parent / "body.obj"
        corners = "v 0.03 0 -.01\nv 0.03 0 .01\nv -.015 .026 -.01\nv -.015 .026 .01\nv -.015 -.026 -.01\nv -.015 -.026 .01\n"
        mesh.write_text(corners + "f 1 3 2\nf 2 3 4\nf 3 5 4\nf 4 5 6\nf 5 2 6\nf 6 2 1\n", encoding="utf-8")
        slip, no_slip = "body[0].slip=true", "body[0].slip=false"
        self.assertIn("has one side, as a Moebius strip", self.refusal(slip))
        self.assertIn("has one side", self.refusal(no_slip))  # a porous one
        self.assertEqual("", self.expect(0, self.scene, "--check", sets=[no_slip, "body[0].porosity={law='none'}", "body[1].retraction=0"]).stderr)
        mesh.write_text(corners + "f 1 3 4 2\nf 3 4 6 5\nf 5 1 2 6\n", encoding="utf-8")
        notice = self.start(self.scene, "--check", sets=[slip])
        self.assertEqual(0, notice.returncode)
        self.assertIn("body[0].file: 2 of 6 triangles of ", notice.stderr)
        self.assertIn("surface      1 part, 0 closed, 6 free edges\n", notice.stdout)
        self.assertEqual("", self.expect(0, self.scene, "--check", "--quiet", sets=[slip]).stderr)
        mesh.write_text(corners + "f 1 3 4 2\nf 3 5 6 4\nf 5 1 2 6\nv 0.03 0 .01000000001\nv 0.02 0 0\nf 2 7 8\n", encoding="utf-8")
        self.assertRegex(self.start(self.scene, "--check", sets=[slip]).stderr, r"body.obj:10: vertex 7 of the file lies nearer to vertex 2 ")
        self.assertIn("body[0].scale = 1e-300: ", self.refusal("body[0].scale=1e-300"))

    def test_rejects_elements_of_arrays_that_the_scene_lacks(self):
        self.assertIn("the scene has no [[body]] to change", self.refusal("body[0].radius=1"))

    def test_rejects_expressions_with_a_short_sentence(self):
        for text, words in (("--x", "two signs in a row"), ("2*--x", "two signs in a row"), ("+".join(["x"] * 3000) + "+q", "unknown name"),
                            ("+".join(["t"] * 3000), "longer than 96 operations")):
            with self.subTest(words):
                message = self.refusal(f'fluid.velocity=["{text}", 0, 0]')
                self.assertIn(words, message)
                self.assertLess(len(message), 600)
        # The velocity along a wall belongs to faces that begin at its edge.
        self.assertIn("fluid.velocity", self.refusal('fluid.velocity=["ln(-x)", 0, 0]'))
        self.assertIn("is not finite at (0, ", self.refusal('grid.wall_velocity.y_low=["ln(x)+0*t", 0, 0]'))

    def test_rejects_invalid_springs_of_plates(self):
        self.assert_lines_are_rejected(bad_bodies.PISTON, bad_bodies.BAD_PISTON_LINES)
        self.sound(bad_bodies.PISTON, 'coupling.method="explicit"', "coupling.allow_unstable=true")
        lines = bad_bodies.PISTON.splitlines(keepends=True)
        self.write("".join(line for line in lines if "mount" not in line))
        self.assertIn('verify.history[0].column = "body_0_displacement" is no column', self.refusal())
        canopy = '[[canopy]]\nkind = "sheet"\ndiameter = 0.3\ngores = 6\nvent = 0\nedge_length = 0.05\ncentre = [0.3, 0.4, 0.4]\n'
        self.write(bad_bodies.PISTON.replace("[coupling]", canopy + "[coupling]"))
        self.assertIn("body[0].mount cannot be combined with a [[canopy]]", self.refusal())

    def test_rejects_bodies_of_unfit_files(self):
        scene = bad_bodies.ROUND.replace('kind = "sphere"', 'kind = "file"\nfile = "body.obj"').replace("radius = 0.2\nedge_length = 0.05\n", "", 1)
        self.write(scene)
        mesh = self.scene.parent / "body.obj"
        self.assertIn("body[0].file: there is no file ", self.refusal())
        triangle = "v 0 0 0\nv 0.05 0 0\nv 0 0.05 0\nf 1 2 3\n"
        for text, words in {
                "# empty\n": "the file has no vertex", "v 0 0 0\nv 1 0 0\nl 1 2\n": "has no face", "v 0 0\n": "body.obj:1: ",
                triangle + "l 1 2\n": "has lines (l), which have no area", triangle + "f 1 3 2\n": "repeats face 1",
                triangle.replace("0.05", "0.2"): "body[0].file: edges of 0.28",
                triangle.replace("0.05 0 0", "5 0 0"): "body[0].file: edges of 5"}.items():
            with self.subTest(words):
                mesh.write_text(text, encoding="utf-8")
                self.assertIn(words, self.refusal())
        mesh.write_text(triangle, encoding="utf-8")
        self.accept()
        self.assertIn("body[0].scale = 0", self.refusal("body[0].scale=0"))
        self.assertIn("between 0.1 and 1.5", self.refusal("body[0].centre=[1.49, 0.4, 0.4]"))

    def test_rejects_conserved_momentum_with_bodies(self):
        shipped = parachute_program.gas_program.SOURCE / "miniapps/parachute/scenes/porous-channel.toml"
        text = shipped.read_text(encoding="utf-8").replace("pressure_drop = [30, 0, 0]", "body_force = [0, 0, 0]")
        self.write(text.replace("[verify]", "[verify]\nmomentum = 1e-12"))
        self.assertIn("verify.momentum: the forces of a [[body]]", self.refusal())

    def test_rejects_bodies_that_do_not_span_an_axis_with_one_cell(self):
        self.sound(bad_bodies.GOOD.replace("[16, 8, 8]", "[16, 8, 1]"))
        self.assertIn("body[0].lengths is 0.5 m along z", self.refusal("body[0].lengths=[0.4, 0.5]"))
        body = 'kind = "cylinder"\naxis = "z"\nradius = 0.2\nlength = 0.8\n'
        self.sound(bad_bodies.GOOD.replace("[16, 8, 8]", "[16, 8, 1]").replace(
            'kind = "plate"\nnormal = "x"\n', body).replace("lengths = [0.4, 0.8]\n", ""))
        self.assertIn("body[0].length is 0.4 m along z, where the grid has one cell: it must be the width of the domain, 0.8 m",
                      self.refusal("body[0].length=0.4"))

    def test_rejects_sheets_that_cannot_be_sharp(self):
        sharp = 'coupling.method="sharp"'
        self.sound(bad_bodies.GOOD, sharp)
        self.assertIn("coupling.edge_inset", self.refusal(sharp, "coupling.edge_inset=0.55"))
        for key in ("leak_filter=0.5", 'corrections="plain"'):
            self.assertIn("coupling." + key.split("=")[0], self.refusal(sharp, "coupling." + key))
        self.accept("coupling.edge_inset=0.55")
        self.assertIn("coupling.edge_inset", self.refusal("coupling.edge_inset=1.5"))
        self.assertIn('body[0].slip = false: with coupling.method = "sharp" the fluid slips along plates and disks',
                      self.refusal(sharp, "body[0].slip=false"))
        self.sound(bad_bodies.ROUND, sharp, "body[0].slip=false")
        self.assertIn("body[0].slip = true", self.refusal(sharp))
        self.assertIn('body[0].retraction: coupling.method = "sharp" has no delta function',
                      self.refusal(sharp, "body[0].slip=false", "body[0].retraction=0.3"))
        self.write(bad_canopies.GOOD)
        self.assertIn("takes a [[body]] and no [[canopy]]", self.refusal(sharp))
        shipped = parachute_program.gas_program.SOURCE / "miniapps/parachute/scenes/piston.toml"
        self.write(shipped.read_text(encoding="utf-8"))
        self.assertIn('body[0].mount: coupling.method = "sharp" needs bodies at rest', self.refusal(sharp))

    def test_rejects_a_retraction_that_contact_would_feel(self):
        shipped = parachute_program.gas_program.SOURCE / "miniapps/parachute/scenes/sphere-drop.toml"
        self.write(shipped.read_text(encoding="utf-8"))
        self.assertIn("body[0].retraction: with coupling.contact", self.refusal("body[0].retraction=0.3"))
        self.accept("body[0].retraction=0")

    def test_rejects_motion_along_an_axis_with_one_cell(self):
        flat = bad_bodies.GOOD.replace("[16, 8, 8]", "[16, 8, 1]")
        self.sound(flat)
        self.write(flat.replace("edge_length", "motion = { z = 0 }\nedge_length"))
        self.assertIn("body[0].motion.z: the grid has one cell along z", self.refusal())

    def test_rejects_coupling_without_bodies(self):
        self.assertIn("[[body]]", self.refusal("coupling.filter=0.5"))
        force = parachute_program.statistic("body_0_force_x", "last", 1, 1)
        self.assertIn('"body_0_force_x" is no column', self.refusal(f"verify.history=[{force}]"))

    def test_rejects_contradicting_assignments(self):
        for sets, blamed, words in bad_flows.BAD_SETS:
            with self.subTest(sets=sets):
                message = self.refusal(*sets)
                self.assertTrue(message.startswith("--set " + blamed), message)
                for word in words:
                    self.assertIn(word, message)

    def test_rejects_forces_where_momentum_is_conserved(self):
        self.write(bad_flows.GOOD.replace(bad_flows.GOOD.splitlines(keepends=True)[9], bad_flows.PERIODIC)
                              .replace("wall_velocity = { y_low = [1, 0, 0] }\n", ""))
        self.accept("verify.momentum=1")
        self.assertIn("body_force", self.refusal("verify.momentum=1", "flow.body_force=[0, 1, 0]"))

    def test_damaged_scenes_are_rejected_or_read(self):
        """The program never ends by a signal or with another exit code."""
        for seed in range(60):
            with self.subTest(seed):
                self.scene.write_bytes(mutations.mutate(bad_flows.GOOD.encode(), seed))
                process = self.start(self.scene, "--check")
                self.assertIn(process.returncode, (0, 3), process.stderr)
                self.assertEqual(1 if process.returncode else 0, len(process.stderr.splitlines()))
