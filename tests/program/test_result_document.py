"""result.json of all programs: docs/result.md has every key, its times add up, its flags are those of the compile commands."""

import json
import re
import shlex

import gas_program
import options_program
import parachute_program
import springs_program

PAGE = (gas_program.SOURCE / "docs/result.md").read_text(encoding="utf-8")
DOCUMENTED = set(re.findall(r"`([a-z0-9_.I]+)`", PAGE))
PARTS = ["setup_s", "compute_s", "h2d_s", "d2h_s", "io_s", "bound_s", "verify_s"]
GAS = ["verify.l1_density=1.0", "mesh.cells=100"]
# A canopy and a body in a stream, with checks of each kind that has numbers of its own; not to be passed.
CHECKED = parachute_program.CANOPY.replace("end_time = 0.2", "end_time = 0.04").replace("times = [0.1, 0.2]", "times = [0.04]") + """
history = [{ column = "canopy_0_drag_coefficient", statistic = "mean", from = 0.02, to = 0.04, value = 1, tolerance = 1e9 }]
leak = [{ from = 0.02, to = 0.04, tolerance = 1e9 }]
peak_force = [{ force = [-1e9, 1e9], time = [0, 1] }]
"""


def flags_of(command):
    """Words of a compile command that change machine code."""
    words, kept = shlex.split(command)[1:], []
    while words:
        word = words.pop(0)
        if word in ("-o", "-c", "-x", "-I", "-D", "-isystem", "-include", "-MF", "-MT"):
            words.pop(0)
        elif word == "-DNDEBUG" or not re.match(r"(-Xcompiler=)?-(I|D|W|M|isystem|-diag|-Werror|forward)", word):
            kept.append(word)
    return kept


class Document(springs_program.SpringsTest):
    def reported(self, program, scene, *words, sets=(), code=0, environment=None):
        process = gas_program.run(scene, "--backend", "serial", "--quiet", "--overwrite", "--out", "out", *words, sets=sets,
                                  cwd=self.folder, program=program, environment=environment)
        self.assertEqual(code, process.returncode, process.stderr)
        return self.result("out")

    def runs(self):
        """A name and a result of runs of all programs, with the groups that they can have."""
        gas, springs, parachute = gas_program.PROGRAM, springs_program.PROGRAM, parachute_program.PROGRAM
        yield "gas", self.reported(gas, "sod", sets=GAS)
        yield "gas that failed", self.reported(gas, "sod", sets=[*GAS, "run.max_steps=5"], code=4)
        yield "springs", self.reported(springs, self.write(springs_program.DRUM + "[verify]\nenergy_drift = 1\n"))
        yield "springs with contact", self.reported(springs, self.write(springs_program.FALLING))
        yield "flow", self.reported(parachute, self.write(parachute_program.VORTICES))
        yield "bodies", self.reported(parachute, self.write(parachute_program.PLATE))
        yield "canopies", self.reported(parachute, self.write(CHECKED))
        yield "cloth", self.reported(parachute, self.write(parachute_program.CLOTH))
        self.write(options_program.batch([options_program.row("a")]), "batch.csv")
        process = gas_program.run("price", "batch.csv", *options_program.FAST, "--result", "result.json", "--backend", "serial",
                                  cwd=self.folder, program=options_program.PROGRAM)
        self.assertEqual(0, process.returncode, process.stderr)
        yield "options", self.result(".")

    def test_figure_of_merit_is_work_over_its_time(self):
        work = {"gas": ("cell_steps_per_s", 100), "flow": ("cell_steps_per_s", None), "cloth": ("vertex_steps_per_s", None)}
        for name, result in self.runs():
            merit, seconds = result["figure_of_merit"], result["timing"]["compute_s"]
            if name == "options":
                self.assertAlmostEqual(1.0, merit["options_per_s"] * seconds)
                continue
            key, items = work.get(name, (None, None))
            self.assertAlmostEqual(result["time"], merit["simulated_s_per_s"] * seconds, delta=1e-9 * result["time"])
            if key:
                done = merit[key] * seconds / result["steps"]
                self.assertAlmostEqual(round(done), done, delta=1e-6 * done)
                if items:
                    self.assertEqual(items, round(done))

    def test_page_has_every_key(self):
        found = set()
        for name, result in self.runs():
            keys = set()
            for key, value in result.items():
                if key == "errors":
                    keys |= set(value)
                elif isinstance(value, dict):
                    keys |= {f"{key}.{part}" for part in value}
                keys |= {key} if not isinstance(value, dict) or key == "errors" else set()
            for check in result["checks"]:
                keys |= set(check)
            keys = {re.sub(r"_\d+(?=_|\.|$)", "_I", key) for key in keys}
            self.assertEqual(set(), keys - DOCUMENTED, f"{name}: keys that docs/result.md lacks")
            found |= keys
        # The other way round: groups of the page that none of these runs writes, on one rank and without a study.
        groups = {key.split(".")[0] for key in DOCUMENTED if re.fullmatch(r"[a-z0-9_]+\.[a-zA-Z0-9_]+", key)}
        written = {key.split(".")[0] for key in found if "." in key}
        self.assertEqual({"messages", "result", "study"}, groups - written)

    def test_times_add_up(self):
        cases = (
            # The reference is a finer run of many seconds on slow machines.
            (gas_program.PROGRAM, "shu-osher", ["mesh.cells=100", "verify.l1_density=10", "verify.reference.cells=800"]),
            (springs_program.PROGRAM, self.write(springs_program.FALLING), []),
            (parachute_program.PROGRAM, self.write(parachute_program.CANOPY, "canopy.toml"), ["run.end_time=0.04", "output.times=[0.04]"]),
        )
        for program, scene, sets in cases:
            with self.subTest(program.name):
                timing = self.reported(program, scene, sets=sets)["timing"]
                self.assertEqual({"wall_s", *PARTS}, set(timing))
                self.assertGreaterEqual(min(timing.values()), 0.0)
                self.assertLess(abs(timing["wall_s"] - sum(timing[part] for part in PARTS)), 0.02 + 0.05 * timing["wall_s"], timing)
                if program == gas_program.PROGRAM:
                    # Eight times the cells and steps: the reference takes longer than the run.
                    self.assertGreater(timing["verify_s"], timing["compute_s"], timing)

    def test_flags_are_those_of_the_compile_commands(self):
        commands = json.loads((gas_program.BIN.parent / "compile_commands.json").read_text(encoding="utf-8"))
        kernels = [entry["command"] for entry in commands if re.search(r" -o \S*drogue_kernels\.dir/\S*(/instances/|_united|unity_)", entry["command"])]
        self.assertTrue(kernels)
        reported = self.reported(gas_program.PROGRAM, "sod", sets=GAS)["provenance"]["flags"].split()
        for command in kernels:
            self.assertEqual(flags_of(command), reported)
        # Options that targets of Kokkos add are among them.
        openmp = "openmp" in gas_program.backends()
        self.assertEqual(openmp, any("openmp" in flag for flag in reported), reported)
