"""The backend that `--backend auto` takes, and the notice on shared cores."""

import json
import os
import resource
import subprocess
import unittest

import gas_program
import options_program
import parachute_program
import springs_program
from options_program import row
from perf_program import CACHE

CORES = len(os.sched_getaffinity(0))
GAS = ["run.end_time=0.001", "output.times=[0.0]"]
HAS_DEVICE = "cuda" in gas_program.backends()


@unittest.skipIf(HAS_DEVICE, "auto takes the GPU")
@gas_program.needs_openmp
class Choice(gas_program.GasTest):
    def backend_of(self, program, scene, *sets, first_core_only=False, **environment):
        restrict = (lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})) if first_core_only else None
        line = gas_program.arguments(scene, "--out", "run", "--overwrite", "--quiet", sets=sets, program=program)
        process = subprocess.run(line, cwd=self.folder, capture_output=True, text=True, check=False, preexec_fn=restrict,
                                 env={**gas_program.ENVIRONMENT, **environment})
        self.assertIn(process.returncode, (0, 5), process.stderr)  # a shorter run need not pass its checks
        return self.result("run")["backend"]

    def several(self):
        return "openmp" if CORES > 1 else "serial"

    def test_gas_takes_threads_from_1024_cells(self):
        self.assertEqual("serial", self.backend_of(gas_program.PROGRAM, "sod", *GAS, "mesh.cells=1023"))
        self.assertEqual(self.several(), self.backend_of(gas_program.PROGRAM, "sod", *GAS, "mesh.cells=1024"))

    def test_one_core_takes_serial(self):
        self.assertEqual("serial", self.backend_of(gas_program.PROGRAM, "sod", *GAS, "mesh.cells=1024", first_core_only=True))

    @unittest.skipIf("DROGUE_SANITIZE:BOOL=ON" in CACHE, "a sanitizer maps more than the limit")
    def test_threads_that_cannot_start_end_with_one_sentence(self):
        """Their stacks, 8 MiB each, exceed what the process may map."""
        limit = 2 << 30
        line = gas_program.arguments("sod", "--out", "run", "--quiet", "--backend", "openmp", sets=GAS)
        process = subprocess.run(line, cwd=self.folder, capture_output=True, text=True, check=False,
                                 env={**gas_program.ENVIRONMENT, "OMP_NUM_THREADS": "500"},
                                 preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        self.assertEqual(6, process.returncode, process.stderr)
        self.assertRegex(process.stderr, r"^drogue-gas: .*of 500 threads only \d+ start; OMP_NUM_THREADS gives fewer.*\n$")

    def test_one_thread_takes_serial(self):
        self.assertEqual("serial", self.backend_of(gas_program.PROGRAM, "sod", *GAS, "mesh.cells=1024", OMP_NUM_THREADS="1"))

    def test_threads_that_are_bound_have_a_core_each(self):
        bound = {"OMP_PROC_BIND": "spread", "OMP_PLACES": "cores"}
        self.assertEqual(self.several(), self.backend_of(gas_program.PROGRAM, "sod", *GAS, "mesh.cells=1024", **bound))

    def test_springs_take_threads_from_512_vertices(self):
        short = ["time.end_time=0.001", "output.times=[0.0]"]
        for vertices, expected in ((217, "serial"), (817, self.several())):
            self.assertEqual(expected, self.backend_of(springs_program.PROGRAM, "drum", *short, f"mesh.disk.vertices={vertices}"))

    def test_flow_takes_threads_from_2048_cells(self):
        short = ["run.end_time=0.001", "output.times=[0.0]"]
        for cells, expected in (("[32, 32, 1]", "serial"), ("[64, 32, 1]", self.several())):
            self.assertEqual(expected, self.backend_of(parachute_program.PROGRAM, "taylor-green-2d", *short, f"grid.cells={cells}"))

    def test_options_take_threads_for_two_contracts(self):
        for names, expected in (("a", "serial"), ("ab", self.several())):
            (self.folder / "batch.csv").write_text(options_program.batch([row(name, style="american") for name in names]))
            line = [options_program.PROGRAM, "price", "batch.csv", "--mesh", "64", "--steps", "16", "--out", "p.csv", "--result", "r.json"]
            subprocess.run(line, cwd=self.folder, capture_output=True, check=True, env=gas_program.ENVIRONMENT)
            self.assertEqual(expected, json.loads((self.folder / "r.json").read_text())["backend"])


@gas_program.needs_openmp
class SharedCores(gas_program.GasTest):
    def notices(self, **environment):
        inherited = {name: value for name, value in os.environ.items() if name not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
        line = gas_program.arguments("sod", "--backend", "openmp", "--out", "run", "--overwrite",
                                     sets=[*GAS, "verify.l1_density=1"])
        process = subprocess.run(line, cwd=self.folder, capture_output=True, text=True, check=True,
                                 env={**inherited, "OMP_NUM_THREADS": str(CORES + 1), **environment})
        return process.stderr.splitlines()

    def test_prints_one_notice_for_more_threads_than_cores(self):
        lines = self.notices()
        self.assertEqual(1, len(lines))
        self.assertRegex(lines[0], "^drogue-gas: the threads of OpenMP share their cores: ")

    def test_keeps_a_configured_wait_in_silence(self):
        self.assertEqual([], self.notices(OMP_WAIT_POLICY="passive"))
