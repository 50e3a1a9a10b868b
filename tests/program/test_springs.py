# ctest-label: no-sanitizer
"""drogue-springs: command line, run directory, failures and verification."""

import json
import math
import re
import resource

import gas_program
import springs_program
from hdf5_file import Hdf5File
from springs_program import DRUM


SOFT_STRING = """app = "springs"
[mesh.string]
from = [0, 0, 0]
to = [1, 0, 0]
vertices = 2
[material]
axial_stiffness = 1
line_density = 2
[time]
end_time = 10
[output]
history_every = 1
probes = [{ at = [1, 0, 0] }]
"""
PULSE = """[[load]]
where = "x>0.5"
force = { x = "exp(-((t-5.05)/0.01)^2)" }
"""
FAST_PIN = """[[pin]]
where = "x<0.5"
motion = { x = "0.1*sin(2*pi*5*t)" }
"""


class CommandLine(springs_program.SpringsTest):
    def test_information_needs_no_scene(self):
        self.assertRegex(self.expect(0, "--version").stdout, r"^drogue-springs \d+\.\d+\.\d+\n")
        self.assertIn("--restart", self.expect(0, "--help").stdout)
        self.assert_lists(springs_program.SCENES)
        self.assertEqual([], list(self.folder.iterdir()))

    def test_only_the_first_rank_prints(self):
        """On several ranks information is printed once, and runs are rejected."""
        of_rank = {"OMPI_COMM_WORLD_SIZE": "2"}
        programs = {name: gas_program.BIN / name for name in ("drogue-springs", "drogue-gas", "drogue-options", "drogue-perf")}
        for name, program in programs.items():
            words = [["--version"], ["--help"], *({"drogue-options": [], "drogue-perf": [["list"]]}.get(name, [["--list-scenes"]]))]
            for line in words:
                for rank in (0, 1):
                    with self.subTest(name, line=line, rank=rank):
                        done = gas_program.run(*line, program=program, environment={**of_rank, "OMPI_COMM_WORLD_RANK": str(rank)})
                        self.assertEqual((0, rank == 0, ""), (done.returncode, done.stdout != "", done.stderr))
        for name, line in (("drogue-springs", ["drum"]), ("drogue-perf", ["run", "--filter", "nothing"])):
            done = gas_program.run(*line, program=programs[name], environment={**of_rank, "OMPI_COMM_WORLD_RANK": "0"})
            self.assertEqual(2, done.returncode)
            self.assertIn("one rank", done.stderr)

    def test_printed_scenes_resolve_to_themselves(self):
        for scene in springs_program.SCENES:
            with self.subTest(scene):
                self.resolved(scene)

    def test_quiet_checks_print_no_quality_of_the_mesh(self):
        self.assertIn("triangles", self.expect(0, "drum", "--check").stdout)
        done = self.expect(0, "drum", "--check", "--quiet")
        self.assertEqual(("", ""), (done.stdout, done.stderr))
        self.assertIn("[mesh]", self.expect(0, "drum", "--print-scene", "--quiet").stdout)

    def test_reports_usage_errors(self):
        for words in (["drumm"], ["drum", "extra"], ["drum", "--backend", "gpu"], ["drum", "--study", "meshes=1:2"], []):
            with self.subTest(words):
                self.expect(2, *(words or ["--quiet"]))
        self.assertEqual([], list(self.folder.iterdir()))

    def test_reports_an_absent_backend(self):
        if "cuda" in gas_program.backends():
            self.skipTest("a CUDA build has that backend")
        self.assertIn("cuda", self.expect(77, self.write(DRUM), "--backend", "cuda").stderr)


    def test_checks_fine_meshes_for_intersections_quickly(self):
        """Flat cloth is the worst case of the intersection check: nearby triangles are coplanar, so that rounded
        determinants cannot decide and exact arithmetic is needed."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        self.expect(0, self.write(springs_program.FALLING), "--check", sets=[
            "mesh.rectangle.vertices=90000", "contact={self=true,thickness=1e-4}"])
        self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, 15.0)


class RunDirectory(springs_program.SpringsTest):
    def test_files_hold_the_documented_layout(self):
        scene = self.write(DRUM)
        self.expect(0, scene, "--backend", "serial", "--out", "out")
        reported = self.result("out")
        self.assertEqual(("drogue.result/1", "drogue-springs", "ok", 0, 0.3),
                         tuple(reported[key] for key in ("schema", "program", "status", "exit_code", "time")))
        self.assertLess(reported["dt_max"] / reported["dt_min"], 1.1)
        self.assertEqual((0, 0), (reported["limiter"]["touches"], reported["limiter"]["cells"]))
        file = self.fields("out")
        vertices, triangles = 61, 96
        for path, count in (("/mesh/vertices", 3 * vertices), ("/mesh/triangles", 3 * triangles),
                            ("/mesh/edges", 2 * (vertices + triangles - 1)), ("/steps/000001/position", 3 * vertices),
                            ("/steps/000000/velocity", 3 * vertices)):
            self.assertEqual(8 * count, len(file.datasets[path]), path)
            self.assertEqual({"units", "centering", "description"}, set(file.attributes[path]))
        self.assertEqual([0.1, 0.3], [file.attributes[f"/steps/{k}"]["time"] for k in file.children("/steps")])
        xdmf = (self.folder / "out/fields.xdmf").read_text(encoding="utf-8")
        for word in ("/mesh/triangles", "/steps/000001/position", 'AttributeType="Vector"', 'Value="0.3"'):
            self.assertIn(word, xdmf)
        printed = self.expect(0, scene, "--print-scene").stdout
        self.assertEqual(printed, (self.folder / "out/scene.toml").read_text(encoding="utf-8"))

    def test_history_lists_energies_and_probes(self):
        self.expect(0, self.write(DRUM), "--backend", "serial", "--out", "out")
        header = (self.folder / "out/history.csv").read_text(encoding="utf-8").splitlines()[0]
        for name in ("time [s]", "kinetic [J]", "elastic [J]", "potential [J]", "energy [J]", "momentum_x [kg m/s]",
                     "probe_0_z [m]"):
            self.assertIn(name, header.split(","))
        rows = self.history("out")
        self.assertEqual((0.0, 0.3), (rows["time"][0], rows["time"][-1]))
        self.assertTrue(all(step % 7 == 0 for step in rows["step"][:-1]))
        # The drum oscillates under gravity and conserves its energy.
        self.assertLess(min(rows["probe_0_z"]), 0.0)
        self.assertAlmostEqual(0.01, rows["probe_0_z"][0])
        spread = max(rows["energy"]) - min(rows["energy"])
        self.assertLess(spread, 1e-3 * max(rows["kinetic"]))
        # Memory for the rows is allocated once, whatever their number.
        self.assertGreater(len(rows["time"]), 20)
        self.assertEqual(0, self.result("out")["ledger"]["device_allocations_after_warmup"])

    def test_rejects_an_existing_run(self):
        scene = self.write(DRUM)
        words = ["--quiet", "--backend", "serial", "--out", "out"]
        self.expect(0, scene, *words)
        self.assertIn("--overwrite", self.expect(2, scene, *words).stderr)
        self.expect(0, scene, *words, "--overwrite")
        self.expect(3, scene, *words, "--overwrite", sets=["time.end_time=-1"])
        self.assertEqual("ok", self.result("out")["status"])

    def test_writes_only_requested_files(self):
        self.expect(0, self.write(DRUM), "--quiet", "--out", "out", sets=["output={history_every=0}"])
        self.assertEqual({"restart.h5", "scene.toml", "result.json"}, {file.name for file in (self.folder / "out").iterdir()})
        self.assertEqual(0, self.result("out")["ledger"]["device_allocations_after_warmup"])

    def test_von_mises_stress_of_uniform_tension(self):
        """Equal principal stresses are the von Mises stress: E / (1 - nu) (e + e^2/2), second Piola-Kirchhoff."""
        self.expect(0, self.write(DRUM), "--quiet", "--out", "out", sets=[
            "initial={prestretch=0.05}", "time.end_time=1e-6", "load=[{gravity=[0,0,0]}]",
            "output={fields=['von_mises'],times=[0]}"])
        stress = self.fields("out").values("/steps/000000/von_mises")
        self.assertEqual(96, len(stress))
        for value in stress:
            self.assertAlmostEqual(1000.0 / 0.7 * (0.05 + 0.05**2 / 2), value, delta=1e-9 * value)

    STRESSES = ("stress", "major_stress", "minor_stress", "major_direction", "minor_direction", "von_mises")

    def test_stresses_of_a_uniaxially_stretched_sheet(self):
        """Cauchy and nominal stress of St Venant-Kirchhoff cloth at triangles and vertices for F = diag(1.1, 1)."""
        names = [centre + measure + name for centre in ("", "vertex_") for measure in ("", "nominal_") for name in self.STRESSES]
        scene = self.write('app = "springs"\n[mesh]\nrectangle = { vertices = 30, distortion = 0.2 }\n'
                           '[initial]\ndisplacement = { x = "0.1*x" }\n[time]\nend_time = 0\n')
        self.expect(0, scene, "--quiet", "--out", "out", sets=[f"output.fields={names}"])
        file = self.fields("out")
        along = 1000.0 / (1 - 0.3**2) * 0.5 * (1.1**2 - 1)
        across = 0.3 * along  # second Piola-Kirchhoff stresses
        rows = {"": len(list(file.values("/mesh/triangles"))) // 3, "vertex_": len(list(file.values("/mesh/vertices"))) // 3}
        for centre, count in rows.items():
            for measure, (s, t) in {"": (1.1 * along, across / 1.1), "nominal_": (1.1 * along, across)}.items():
                expected = ([s, 0, 0, t, 0, 0], [s], [t], [1, 0, 0], [0, 1, 0], [math.sqrt(s * s - s * t + t * t)])
                for name, row in zip(self.STRESSES, expected, strict=True):
                    path = f"/steps/000000/{centre}{measure}{name}"
                    values = list(file.values(path))
                    if "direction" in name:
                        values = list(map(abs, values))
                    self.assertEqual(count * len(row), len(values), path)
                    for k, value in enumerate(values):
                        self.assertAlmostEqual(row[k % len(row)], value, delta=1e-10 * s, msg=path)
                    self.assertEqual("vertex" if centre else "face", file.attributes[path]["centering"])
        xdmf = (self.folder / "out/fields.xdmf").read_text(encoding="utf-8")
        self.assertEqual([4, 8], [xdmf.count(f'AttributeType="{kind}"') for kind in ("Tensor6", "Vector")])

    def test_stress_is_computed_only_if_requested(self):
        """Counts launches: none without stress fields, and equally many for one and for all fields of a kind."""
        scene = self.write(DRUM)

        def launches(*fields):
            self.expect(0, scene, "--quiet", "--backend", "serial", "--overwrite", "--out", "out", sets=[
                f"output.fields={list(fields)}", "time.end_time=0.01", "output.times=[0, 0.01]"])
            return self.result("out")["ledger"]["kernel_launches"]

        none = launches("position")
        self.assertEqual(none, launches("position", "velocity"))
        one = launches("von_mises")
        self.assertGreater(one, none)
        self.assertEqual(one, launches("position", *self.STRESSES))
        self.assertGreater(launches("von_mises", "nominal_von_mises"), one)
        self.assertGreater(launches("vertex_stress"), one)

    def test_baseline_copies_the_state_and_gives_the_same_result(self):
        scene = self.write(DRUM)
        for words in (["--out", "a"], ["--out", "b", "--seed-mode"]):
            self.expect(0, scene, "--quiet", "--backend", "serial", *words)
        self.assertEqual(self.fields("a").datasets, self.fields("b").datasets)
        self.assertGreater(self.result("b")["timing"]["d2h_s"], 0.0)
        self.assertEqual(["plain", "seed"], [self.result(run)["driver"] for run in "ab"])

    def test_reports_the_time_of_the_frequency_bounds(self):
        self.expect(0, self.write(DRUM), "--backend", "serial", "--out", "out")
        timing = self.result("out")["timing"]
        self.assertTrue(0.0 < timing["bound_s"] < timing["wall_s"], timing)

    def test_outputs_keep_the_vertex_order_of_the_file(self):
        """Renumbering for locality does not change the order of the outputs."""
        count = 12
        order = [(5 * k) % count for k in range(count)]
        place = {number: k for k, number in enumerate(order)}
        self.write("".join(f"v {number} 0 0\n" for number in order)
                   + "".join(f"l {place[k] + 1} {place[k + 1] + 1}\n" for k in range(count - 1)), "rope.obj")
        scene = self.write('app = "springs"\n[mesh]\nfile = "rope.obj"\n[[pin]]\nwhere = "x < 0.5"\n'
                           '[initial]\nvelocity = { y = "x" }\n[time]\nend_time = 1e-9\n[output]\n'
                           'fields = ["position", "velocity"]\ntimes = [0]\n')
        self.expect(0, scene, "--quiet", "--out", "out")
        file = self.fields("out")
        self.assertEqual(list(map(float, order)), list(file.values("/steps/000000/position"))[::3])
        self.assertEqual(list(map(float, order)), list(file.values("/steps/000000/velocity"))[1::3])


SHEET = """app = "springs"
mesh.rectangle = { width = 1.0, height = 1.0, vertices = 100 }
pin = [{ where = "x==0" }]
load = [{ gravity = [0, 0, -9.81] }]
time.end_time = 0.05
"""

PAIR = """app = "springs"
mesh.string = { from = [0, 0, 0], to = [1, 0, 0], vertices = 2 }
material = { axial_stiffness = 100.0, line_density = 2.0 }
initial.velocity.x = "0.0001*(2*x-1)"
time.end_time = 1.0
"""

BUNGEE = """app = "springs"
mesh.string = { from = [0, 0, 0], to = [0, 0, -1], vertices = 11 }
material = { axial_stiffness = 50.0, line_density = 0.01 }
initial.displacement.z = "-z"
pin = [{ where = "z==0" }]
mass = [{ where = "z==-1", add = 0.1 }]
load = [{ gravity = [0, 0, -9.81] }]
time.end_time = 0.5
output.history_every = 100
verify.energy_drift = 1e-2
"""


class Failures(springs_program.SpringsTest):
    def test_reports_an_unreachable_end_time(self):
        """The message prints the time in its shortest form."""
        message = self.expect(4, self.write(DRUM), "--quiet", "--out", "out", sets=["time.end_time=1e300", "output.times=[1e300]"]).stderr
        self.assertRegex(message, r"more than 1e15 steps to t = 1e\+300 s")

    def test_intersections_are_reported_by_indices_from_0(self):
        """Two intersecting triangles; indices of vertices and faces are those of fields.h5."""
        self.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.2 0.2 -1\nv 0.3 0.2 -1\nv 0.2 0.2 1\nf 1 2 3\nf 4 5 6\n", "m.obj")
        scene = self.write('app = "springs"\n[mesh]\nfile = "m.obj"\n[contact]\nself = true\n[time]\nend_time = 1\n')
        self.assertRegex(self.expect(3, scene, "--check").stderr, "the edge of vertices [34] and 5 meets face 0")

    def test_reports_a_state_that_is_not_finite(self):
        # Between two times of the check.
        message = self.expect(4, self.write(DRUM), "--quiet", "--out", "out",
                              sets=['load=[{force={z="t<=0.0504 || t>0.0504+0.0003 ? 0.1 : sqrt(-1)"}}]']).stderr
        self.assertRegex(message, r"not finite at vertex \d+ \(at rest at .* m\) at step \d+, t = 0\.05.* s")
        self.assertIn("restart.h5 holds the last good state", message)
        reported = self.result("out")
        self.assertEqual(("numerical-failure", 4), (reported["status"], reported["exit_code"]))
        self.assertIn(reported["message"], message)
        self.assertTrue((self.folder / "out/restart.h5").exists())

    def test_reports_a_time_step_beyond_the_stability_limit(self):
        """Two masses of 1 kg on a spring oscillate with omega^2 = 200/s^2. A few unstable steps do not overflow."""
        for integrator, limit in (("rk4", 8**0.5), ("verlet", 2.0)):
            for share, code in ((1.02, 4), (0.999, 0)):
                with self.subTest(integrator, share=share):
                    dt = share * limit / 200**0.5
                    message = self.expect(code, self.write(PAIR), "--quiet", "--overwrite", "--out", "out", sets=[
                        f'time.integrator="{integrator}"', f"time.dt={dt!r}", f"time.end_time={20 * dt!r}"]).stderr
                    if code == 0:
                        continue
                    self.assertRegex(message, rf"a step of {dt:.6g} s is too long: oscillations of the cloth at 14\.1421 rad/s are unstable at step 0, t = 0 s")
                    self.assertIn("restart.h5 holds the state of step 0", message)
                    self.assertTrue((self.folder / "out/restart.h5").exists())

    def test_reports_an_unstable_time_step_on_a_mesh(self):
        """The time step from the frequency bound is stable and accepted; the exact limit is larger."""
        sets = ['time.integrator="verlet"', "time.end_time=0.01", "output.times=[0.01]"]
        self.expect(0, self.write(DRUM), "--quiet", "--out", "auto", sets=[*sets, "time.safety=1.0"])
        dt = self.result("auto")["dt_max"]
        for share, code in ((1.0, 0), (1.5, 4)):
            self.expect(code, self.write(DRUM), "--quiet", "--out", f"{code}", sets=[*sets, f"time.dt={share * dt!r}"])

    def test_reports_a_time_step_that_becomes_unstable(self):
        """A sheet that is stretched becomes stiffer."""
        scene = self.write(SHEET.replace('pin = [{ where = "x==0" }]\n', 'initial.velocity = { x = "100*x", y = "100*y" }\n'))
        self.expect(0, scene, "--quiet", "--out", "auto", sets=["time.safety=1.0"])
        dt = self.result("auto")["dt_max"]
        self.expect(4, scene, "--quiet", "--out", "out", sets=[f"time.dt={dt!r}"])
        reported = self.result("out")
        self.assertRegex(reported["message"], f"are unstable at step {reported['steps']}, t = ")
        self.assertGreater(reported["steps"], 0)

    def test_reports_damping_too_strong_for_the_time_step(self):
        """Damping beyond the stability limit amplifies the motion."""
        message = self.expect(4, self.write(SHEET), "--quiet", "--out", "out", sets=[
            "time.integrator=rk4", "time.dt=1e-4", "damping.absolute=5e4", "time.end_time=0.002"]).stderr
        self.assertRegex(message, r"a step of 0\.0001 s is too long: cloth moves .* m per step on average, more than the diameter of the mesh at rest")

    def test_fast_motion_is_no_unstable_time_step(self):
        """Cloth that moves farther in a stable step than its own size."""
        self.expect(0, self.write(SHEET.replace('pin = [{ where = "x==0" }]\n', "")), "--quiet", "--out", "out",
                    sets=["initial.velocity.z=1e6", "time.dt=1e-4", "time.end_time=0.003"])

    def test_accepts_a_string_of_zero_initial_length(self):
        self.expect(0, self.write(BUNGEE), "--quiet", "--out", "out", sets=["material.tension_only=true"])
        self.assertGreater(self.result("out")["steps"], 100)

    def test_rejects_values_out_of_range(self):
        for key, value, message in (
            ("initial.velocity.z", "1e200", r"initial\.velocity\.z gives 1e\+?200 .*; it must be less than 1e99"),
            ("initial.displacement.z", "1e150", r"initial\.displacement\.z gives 1e\+?150 .*; it must be less than 1e99"),
            ("pin", '[{where="x==0",motion={z="1e200+t"}}]', r"motion\.z gives 1e\+?200"),
            ("mesh.rectangle.width", "1e101", "has no area"),
            ("mesh.rectangle.width", "1e-200", "has no area"),
        ):
            with self.subTest(key, value=value):
                self.assertRegex(self.expect(3, self.write(SHEET), "--check", sets=[f"{key}={value}"]).stderr, message)

    def test_time_step_follows_suddenly_stiffening_cloth(self):
        """The time step adapts within a few steps: a flat membrane under pressure, a sheet that is torn apart."""
        blown = DRUM.replace("gravity = [0, 0, -9.81]", 'follower_pressure = "5000"').replace("prestretch = 0.05\n", "")
        torn = DRUM.replace('displacement = { z = "0.01*(1-(x^2+y^2)/0.16)" }', 'velocity = { x = "100*x", y = "100*y" }')
        for name, text in (("blown", blown), ("torn", torn)):
            with self.subTest(name):
                self.expect(0, self.write(text, f"{name}.toml"), "--quiet", "--out", name, sets=["time.end_time=0.05", "output.times=[0.05]"])
                reported = self.result(name)
                self.assertLess(reported["dt_min"], 0.7 * reported["dt_max"])

    def test_stable_under_fifty_times_the_load(self):
        """A run of cloth under 50 g, which stretches it to several times its size, succeeds."""
        self.expect(0, self.write(DRUM), "--quiet", "--out", "out", sets=["load=[{gravity=[0,0,-490.5]}]"])
        self.assertGreater(self.result("out")["steps"], 100)

    def test_reports_a_force_that_is_not_finite(self):
        """The last good state precedes the first value that is not finite, at any vertex."""
        force = 'load=[{where="x>0.2",force={z="0.3*sqrt(abs(10*t-1.0055)-0.002)"}}]'  # between the times of the check
        for dt in ("auto", 1e-4):
            with self.subTest(dt):
                message = self.expect(4, self.write(DRUM), "--quiet", "--overwrite", "--out", "out", sets=[force, f"time.dt={dt}"]).stderr
                self.assertRegex(message, r"not finite at vertex \d+ .*, t = 0\.1\d* s")
                self.assertIn("if no expression gives such a number", message)
                reported = self.result("out")
                self.assertEqual(("numerical-failure", 4), (reported["status"], reported["exit_code"]))
                self.assertLessEqual(reported["time"], 0.1008)
                self.assertTrue(all(map(math.isfinite, self.history("out")["kinetic"])))

    def test_steps_resolve_loads_and_pins_that_change(self):
        """A pulse far shorter than the stable step has its impulse, and a fast pin moves the mass little."""
        self.expect(0, self.write(SOFT_STRING + PULSE), "--quiet", "--out", "pulse")
        self.assertAlmostEqual(0.01 * math.sqrt(math.pi), max(self.history("pulse")["momentum_x"]), delta=2e-4)
        square = PULSE.replace("exp(-((t-5.05)/0.01)^2)", "t>5.05 && t<5.07 ? 1 : 0")
        self.expect(0, self.write(SOFT_STRING + square), "--quiet", "--out", "square")
        self.assertAlmostEqual(0.02, max(self.history("square")["momentum_x"]), delta=0.002)
        self.expect(0, self.write(SOFT_STRING + FAST_PIN), "--quiet", "--out", "pin")
        # From rest: 0.1 / (omega^2 - 1) (omega sin t - sin(omega t)), with omega = 10 pi.
        moved = max(abs(x - 1) for x in self.history("pin")["probe_0_x"])
        self.assertAlmostEqual(0.1 / (10 * math.pi), moved, delta=2e-4)
        checked = gas_program.run(str(self.write(SOFT_STRING + FAST_PIN)), "--check", "--set", "time.dt=0.1", program=springs_program.PROGRAM, cwd=self.folder)
        self.assertEqual(0, checked.returncode)
        self.assertRegex(checked.stderr, r"pin\[0\].motion.x: steps that resolve it are at most 0.0\d+ s long, time.dt = 0.1 s")

    def test_motion_may_end_with_the_scene(self):
        ends = DRUM.replace('0.4-1e-9"', '0.4-1e-9"\nmotion = { z = "0.01*sqrt(0.4-t)" }')
        self.expect(0, self.write(ends), "--quiet", "--out", "out")

    def test_reports_a_level_set_that_is_not_finite(self):
        """A level set that is NaN below some height is reported when cloth gets there."""
        message = self.expect(4, self.write(springs_program.FALLING), "--quiet", "--backend", "serial", "--out", "out", sets=[
            'contact={objects=[{kind="level-set",expression="z+0.06+0*sqrt(z+0.03)"}]}', "verify={}"]).stderr
        self.assertRegex(message, r"level-set of contact.objects, or its slope, is not a number at vertex \d+ .* at step \d+")

    def test_moduli_require_a_pulling_pin(self):
        for check in ("young", "poisson"):
            message = self.expect(3, self.write(SHEET), sets=[f"verify.{check}=1"]).stderr
            self.assertIn(f"verify.{check} needs a pin with motion.x, which pulls", message)

    def test_strong_damping_does_not_reverse_motion(self):
        """A moving sheet comes to rest after a distance v/K; no integrator reverses its motion."""
        scene = self.write(SHEET.replace('pin = [{ where = "x==0" }]\nload = [{ gravity = [0, 0, -9.81] }]\n',
                                         'initial.velocity.z = "1"\n'))
        for integrator in ("verlet", "rk4"):
            for damping in (1e3, 1e4, 1e5):
                with self.subTest(integrator, damping=damping):
                    self.expect(0, scene, "--quiet", "--backend", "serial", "--overwrite", "--out", "out", sets=[
                        f'time.integrator="{integrator}"', f"damping.absolute={damping}", "time.end_time=0.02",
                        'output={fields=["position"],times=[0.02]}'])
                    height = self.fields("out").values("/steps/000000/position")[2]
                    self.assertLess(abs(height * damping - 1), 0.1)

    def test_rejects_damping_that_reverses_velocities(self):
        words = ["--quiet", "--overwrite", "--out", "out"]
        for share, code in ((0.99, 0), (1.01, 4)):
            message = self.expect(code, self.write(SHEET), *words, sets=[
                'time.integrator="verlet"', "time.dt=1e-4", f"damping.absolute={4e4 * share}"]).stderr
        self.assertIn("a step of 0.0001 s is too long: damping.absolute = 40400 1/s reverses velocities within a step", message)

    def test_restart_file_holds_the_last_good_state(self):
        """restart.h5 equals the state before the failed step bit for bit."""
        drum = [(["time.integrator=verlet"], 0.06), ([], 0.06), (["mesh.disk.vertices=271"], 0.6)]
        for scene, cases in ((DRUM, drum), (springs_program.FALLING, [(["verify={}"], 0.1)])):
            for sets, end in cases:
                with self.subTest(sets, end=end):
                    self.compare_with_a_continuing_run(scene, sets, end)

    def compare_with_a_continuing_run(self, scene, sets, end):
        words = ["--quiet", "--backend", "serial", "--overwrite", "--out"]
        sets = [*sets, f"time.end_time={1.5 * end}", f"output.times=[{1.5 * end}]", "output.history_every=1"]
        gravity = "{gravity=[0,0,-9.81]}"
        # The force is not finite between two times of the check.
        defined, undefined = (f"t <= {end} ? 1e-6*sqrt({end}-t) : (t > {end}+{0.00175 * end} ? 0 : {after})" for after in ("0*1", "sqrt(-1)"))
        message = self.expect(4, self.write(scene), *words, "out", sets=[*sets, f'load=[{gravity},{{force={{z="{undefined}"}}}}]']).stderr
        lost = int(re.search(r"at step (\d+)", message)[1])
        self.assertIn(f"restart.h5 holds the last good state, of step {lost - 1}", message)
        self.assertEqual(lost - 1, self.history("out")["step"][-1])
        # The same run up to that step, with one restart file.
        self.expect(0, self.write(scene), *words, "whole", sets=[
            *sets, f'load=[{gravity},{{force={{z="{defined}"}}}}]', f"output.restart_every={lost - 1}"])
        found, known = (Hdf5File(self.program, self.folder / folder / "restart.h5") for folder in ("out", "whole"))
        self.assertIn("/position", found.datasets)
        self.assertEqual(known.datasets, found.datasets)

    def test_every_check_detects_a_fault(self):
        """Each check fails for a fault in the computation or in the expected value."""
        faults = {
            "drum": ["material.area_density=0.757", "verify.frequency.value=9.0"],
            "strip": ["verify.young=1e-9", "verify.poisson=1e-9"],
            "catenary": ["time.end_time=0.05", "output.fields=[]"],
            "free-patch": ["time.integrator=rk4"],
            "string-stretch": ["time.end_time=0.05", "output.fields=[]"],
            "chain": ["verify.frequency.value=105.2"],
            "hencky": ["time.end_time=0.1", "verify.hencky=3e-3"],
            "drum-cone": ["time.safety=1.0"],
            "stress-wave": ["verify.front_speed.value=110"],
            "pulled-triangle": ["time.end_time=0.02"],
            "patch": ["material.model=quadratic"],
        }
        small = {"hencky": ["mesh.disk.vertices=217", "output.fields=[]"], "pulled-triangle": ["output.fields=[]"], "drum": ["mesh.disk.vertices=61", "output.fields=[]"], "strip": ["mesh.strip.vertices=40"]}
        for scene, sets in faults.items():
            with self.subTest(scene):
                process = self.expect(5, scene, "--quiet", "--backend", "serial", "--overwrite",
                                      sets=[*sets, *small.get(scene, [])])
                self.assertIn("above its tolerance", process.stderr)
                checks = json.loads((self.folder / f"out/{scene}/result.json").read_text(encoding="utf-8"))["checks"]
                self.assertTrue(any(not check["passed"] for check in checks))

    def test_wrong_materials_and_integrators_fail_shipped_scenes(self):
        """A modulus or ratio off by a thousandth, and a second-order integrator, exceed the tolerances of scenes."""
        for scene, change, names in (
                ("pulled-rectangle", "material.membrane_modulus=1001", {"values_2_displacement_y"}),
                ("pulled-rectangle", "material.poisson=0.301", {"values_2_displacement_y"}),
                ("pulled-triangle", "material.membrane_modulus=1001", {"values_1_area_growth"}),
                ("pulled-triangle", "material.poisson=0.301", {"values_1_area_growth"}),
                ("hung-sheet", "material.membrane_modulus=100.1", {"values_0_elastic_energy"}),
                ("curtain", "material.membrane_modulus=204", {"values_0_displacement_z"}),
                ("twist", "material.poisson=0.301", {"values_0_elastic_energy", "values_2_displacement_y"}),
                ("chain", "time.integrator=verlet", {"frequency", "energy_drift"}),
                ("string-longitudinal", "time.integrator=verlet", {"energy_drift"})):
            with self.subTest(scene, change=change):
                self.expect(5, scene, "--quiet", "--backend", "serial", "--overwrite", "--out", "out",
                            sets=[change, "output.fields=[]"])
                failed = {check["name"] for check in self.result("out")["checks"] if not check["passed"]}
                self.assertLessEqual(names, failed)

    def test_result_states_the_order_in_time(self):
        for integrator, damping, order in (("rk4", 1, 4), ("verlet", 0, 2), ("verlet", 1, 1)):
            with self.subTest(order):
                self.expect(0, "chain", "--quiet", "--backend", "serial", "--overwrite", "--out", "out", sets=[
                    "verify={}", f"time.integrator={integrator}", f"damping.relative={damping}"])
                self.assertEqual({"time": order}, self.result("out")["order"])

    def assert_fails_alone(self, names, scene, *sets):
        """Expects exactly the named checks to fail; returns the history of the run."""
        self.expect(5, scene, "--quiet", "--backend", "serial", "--overwrite", "--out", "out", sets=sets)
        self.assertEqual(names, {check["name"] for check in self.result("out")["checks"] if not check["passed"]})
        return self.history("out")

    def test_contact_energy_gain_is_reported_and_bounded(self):
        """Cloth that starts closer to a table than the thickness is lifted to the thickness and not farther."""
        for dt in (3e-4, 3e-5):
            with self.subTest(dt):
                rows = self.assert_fails_alone(
                    {"energy_balance", "penetration"}, "table-cloth",
                    'contact.objects=[{kind="disk",centre=[0.25,0.25,-0.0005],radius=0.15,friction=0.1}]',
                    f"time.dt={dt}", "time.end_time=0.003", "output={history_every=1}")
                self.assertGreater(rows["contact_work"][-1], 0.0)
                self.assertLess(max(rows["kinetic"]), 0.2 * 0.5**2 * 10.0 * 0.0025)

    def test_reports_cloth_driven_through_a_body(self):
        rows = self.assert_fails_alone(
            {"intersections"}, self.write(springs_program.FALLING), "output={history_every=7}",
            'pin=[{where="x<1",motion={z="-t"}}]', "verify.penetration=0.5")
        self.assertEqual((0, 0), (rows["intersections"][0], rows["intersections"][-1]))

    def test_energy_check_does_not_depend_on_history_rows(self):
        """Cloth that fell and rests at the end: the last row does not show the initial energy."""
        scene = self.write(springs_program.FALLING)
        values = []
        for every in (20, 100000):
            self.expect(0, scene, "--quiet", "--backend", "serial", "--overwrite", "--out", "out", sets=[
                'contact={thickness=0.003,objects=[{kind="plane",centre=[0,0,-0.01],friction=0.3}]}',
                "time.end_time=0.3", f"output={{history_every={every}}}", "verify={energy_balance=2e-2}"])
            values.append(self.result("out")["errors"]["energy_balance"])
        self.assertLess(values[1], 1.01 * values[0])

    def test_static_friction_holds_a_sheet(self):
        """Cloth on a plane with gravity inclined by 20 degrees, below the friction angle of 27 degrees."""
        for integrator in ("rk4", "verlet"):
            with self.subTest(integrator):
                self.expect(0, self.write(springs_program.FALLING), "--quiet", "--backend", "serial", "--overwrite", "--out", "out", sets=[
                    f'time.integrator="{integrator}"', "mesh.rectangle.vertices=36", 'initial.displacement.z="0.003"',
                    "load=[{gravity=[3.3552,0,-9.2184]}]", "verify={}", "time.end_time=0.5", "output.times=[0.5]",
                    'contact={thickness=0.003,objects=[{kind="plane",centre=[0,0,0],friction=0.5}]}'])
                file = self.fields("out")
                rest, now = file.values("/mesh/vertices")[::3], file.values("/steps/000000/position")[::3]
                # A drift of half an impulse per step would give 0.4 mm.
                self.assertLess(max(abs(a - b) for a, b in zip(rest, now)), 5e-6)
                self.assertLess(abs(self.result("out")["energy"]["friction_work"]), 1e-7)

    def test_checks_over_rows_state_how_many_and_warn_of_few(self):
        words = ["--backend", "serial", "--out", "out", "--overwrite"]
        for every, is_few in ((1, False), (100, True)):
            sets = [f"output.history_every={every}", "verify={energy_drift=1}", "time.end_time=0.05", "output.times=[0.05]"]
            process = gas_program.run(self.write(DRUM), *words, sets=sets, cwd=self.folder, program=self.program)
            said = process.stderr
            self.assertEqual(0, process.returncode, said)
            result, rows = self.result("out"), len(self.history("out")["time"])
            self.assertEqual([rows], [check["rows"] for check in result["checks"]])
            self.assertEqual(is_few, rows < 10)
            warning = f"energy_drift is computed from {rows} rows of history.csv, which may miss"
            self.assertEqual(is_few, warning in said)
            self.assertEqual(is_few, any(warning in sentence for sentence in result.get("warnings", [])))

    def test_states_the_energy_that_steps_lose(self):
        """A slack membrane that a constant pressure blows up: the default steps keep its energy, long Runge-Kutta steps do not."""
        blown = DRUM.replace("gravity = [0, 0, -9.81]", "follower_pressure = 200").replace("prestretch = 0.05\n", "") + "[material]\ntension_only = true\n"
        scene = self.write(blown)
        words = ["--backend", "serial", "--out", "out", "--overwrite"]
        sets = ["time.end_time=1", "output.times=[1]", "output.history_every=1"]
        printed = self.expect(0, scene, *words, sets=[*sets, "verify={energy_drift=0.1}"]).stdout
        energy, rows = self.result("out")["energy"], self.history("out")
        self.assertRegex(printed.splitlines()[0], r" of energy (lost|gained) \(\S+ %\)$")
        self.assertLess(abs(energy["lost_share"]), 0.01)
        self.assertEqual(energy["lost"], rows["energy"][0] - rows["energy"][-1])
        self.assertEqual(len(rows["time"]), energy["lost_rows"])
        self.assertLess(abs(energy["lost_share"]), 1.0001 * self.result("out")["errors"]["energy_drift"])
        self.assertLess(min(rows["potential"]), -0.5)
        self.expect(0, scene, *words, sets=[*sets, "time.integrator=rk4", "time.safety=0.8"])
        self.assertGreater(self.result("out")["energy"]["lost_share"], 0.1)
        # Nothing is stated where energy is spent or supplied on purpose.
        for change in ("damping.absolute=1", 'load=[{follower_pressure="200*t"}]', 'load=[{follower_pressure="200*(x>0)"}]',
                       'pin=[{where="sqrt(x^2+y^2)>0.4-1e-9",motion={x="0.01*t"}}]', 'pin=[{where="x>0.3"}]', "output.history_every=0"):
            with self.subTest(change):
                printed = self.expect(0, scene, *words, sets=[*sets, "time.end_time=0.02", "output.times=[0.02]", change]).stdout
                self.assertNotIn(" of energy ", printed)
                self.assertNotIn("lost", self.result("out")["energy"])

    def test_energy_balance_includes_friction_work(self):
        scene = self.write(springs_program.FALLING)
        self.expect(0, scene, "--quiet", "--backend", "serial", "--out", "out", sets=["verify={energy_balance=2e-2}"])
        rows = self.history("out")
        reported = self.result("out")["energy"]
        self.assertEqual({name: rows[name][-1] for name in ("kinetic", "elastic", "potential", "contact_work", "friction_work")},
                         {name: value for name, value in reported.items() if not name.startswith("lost")})
        works = sum(rows[name][-1] - rows[name][0] for name in ("contact_work", "friction_work"))
        self.assertAlmostEqual(rows["energy"][0] - rows["energy"][-1] + works, reported["lost"], delta=1e-12)
        scale = max(a - b for a, b in zip([rows["potential"][0]] * len(rows["time"]), rows["potential"]))
        lost = rows["energy"][-1] - rows["energy"][0]
        self.assertLess(abs(lost - reported["contact_work"] - reported["friction_work"]), 2e-2 * scale)
        self.assertGreater(abs(lost - reported["contact_work"]), 4e-2 * scale)
        for earlier, later in zip(rows["friction_work"], rows["friction_work"][1:]):
            self.assertLessEqual(later, earlier)
        self.expect(0, scene, "--quiet", "--backend", "serial", "--out", "none", sets=[
            "contact.friction=0", "contact.objects.0.friction=0"])
        self.assertEqual({0.0}, set(self.history("none")["friction_work"]))

    def test_frequency_converges_with_second_order(self):
        """Frequency of the drum; with equal masses the order is one."""
        def error(vertices, mass):
            self.expect(0, "drum", "--quiet", "--backend", "serial", "--overwrite", sets=[
                f"mesh.disk.vertices={vertices}", f"material.mass={mass}", "verify.frequency.tolerance=1",
                "verify.energy_drift=1", "output.fields=[]"])
            return self.result("out/drum")["errors"]["frequency"]

        slope = math.log2(error(61, "area") / error(217, "area"))
        self.assertAlmostEqual(2.0, slope, delta=0.15)
        self.assertLess(math.log2(error(61, "equal") / error(217, "equal")), 1.6)
