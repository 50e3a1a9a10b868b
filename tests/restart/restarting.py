"""Base class of restart tests: an interrupted run, an uninterrupted one, and their comparison."""

import random
import shutil
import signal
import time

import gas_program

# Outputs, rows and restart files at unrelated steps.
CASES = {
    "sod": ["mesh.cells=800", "output.restart_every=25", "output.history_every=7"],
    # Repeated and limited steps: their counters and the marks of limited cells are part of the state.
    "blast": ["mesh.cells=400", "output.restart_every=30", "output.history_every=11", 'scheme.positivity="auto"',
              "scheme.cfl=0.6", "verify.reference.cells=1600", "verify.l1_density=1.0"],
    "entropy-wave": ["mesh.cells=160", "output.restart_every=40", "output.history_every=13"],
}


class RestartTest(gas_program.GasTest):
    def setUp(self):
        super().setUp()
        self.random = random.Random(self.id())

    def whole(self, scene, backend, *words, sets=None):
        """Runs without interruption."""
        self.expect(0, scene, "--quiet", "--backend", backend, "--out", "whole", *words, sets=sets or CASES[scene])

    def begin(self, scene, backend, *words, sets=None):
        return super().begin(scene, "--backend", backend, *words, sets=sets or CASES[scene])

    def kill_and_continue(self, scene, backend, kills, *words, sets=None):
        """Kills a run at random times and continues it, `kills` times; then lets it finish."""
        killed, patience = 0, 0.08
        while killed < kills:
            process = self.begin(scene, backend, *words, *(["--restart", "auto"] if killed else []), sets=sets)
            time.sleep(self.random.uniform(0.0, patience))
            process.kill()
            code = process.wait()
            # A run that is killed after its last output, before its process ends, has finished too.
            if code == -signal.SIGKILL and not (self.folder / "part/result.json").exists():
                killed += 1
                (self.folder / "part/.lock").unlink(missing_ok=True)  # otherwise the next run seems to handle signals already
            else:  # the run had finished: start again
                self.assertIn(code, (0, -signal.SIGKILL), process.stderr.read())
                shutil.rmtree(self.folder / "part")
                killed, patience = 0, patience / 2
                self.assertGreater(patience, 1e-4, "the run cannot be killed in time")
        self.expect(0, scene, "--quiet", "--backend", backend, "--out", "part", "--restart", "auto", *words,
                    sets=sets or CASES[scene])

    def assert_same_runs(self):
        super().assert_same_runs()
        self.assertGreaterEqual(len(self.fields("whole").children("/steps")), 3)
