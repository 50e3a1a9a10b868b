"""Functions of several ranks: who throws what, who ends whom, and parts of arrays."""

import os
import pathlib
import subprocess
import unittest

from rank_processes import LAUNCHER, RANK_ENVIRONMENT

PROGRAM = pathlib.Path(os.environ["DROGUE_BUILD"]) / "tests/ranks_together"
DONE = ["0: done", "1: done", "2: done"]
MEMORY = "6, out of memory: use fewer cells, or run where there is more memory"


def thrown(first, *others):
    return [f"{rank}: {text}" for rank, text in enumerate((first, *others))]


# Function, rank that fails, exception; what each rank prints that goes on. Failures of other ranks lack their sentence.
COLLECTIVE = (
    ("run_collectively", "none", "failure", DONE),
    ("run_collectively", "0", "failure", thrown("4, diverged", *2 * ["4, another rank gave up"])),
    ("run_collectively", "1", "failure", thrown("4, diverged (on rank 1)", "4, diverged (on rank 1)",
                                                "4, another rank gave up (on rank 1)")),
    ("run_collectively", "2", "memory", thrown(f"{MEMORY} (on rank 2)", "6, another rank gave up (on rank 2)",
                                               f"{MEMORY} (on rank 2)")),
    ("run_collectively", "all", "failure", thrown(*3 * ["4, diverged"])),
    ("run_on_root", "0", "memory", thrown(MEMORY, *2 * ["6, another rank gave up"])),
    ("run_on_root", "1", "failure", DONE),
    ("run_or_abort", "none", "failure", DONE),
    ("run_or_abort", "all", "failure", thrown(*3 * ["4, diverged"])),
)


class Ranks(unittest.TestCase):
    def run_on(self, ranks, *words):
        launcher = [LAUNCHER, "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        done = subprocess.run([*launcher, PROGRAM, *words], env=RANK_ENVIRONMENT, capture_output=True, text=True, check=False,
                              timeout=120)
        return done.returncode, sorted(done.stdout.splitlines()), done.stderr

    @unittest.skipUnless(LAUNCHER, "there is no mpirun")
    def test_all_ranks_throw_what_one_throws(self):
        for *words, expected in COLLECTIVE:
            with self.subTest(words):
                self.assertEqual((0, expected), self.run_on(3, *words)[:2])

    @unittest.skipUnless(LAUNCHER, "there is no mpirun")
    def test_an_exception_among_messages_ends_all_ranks(self):
        for rank, printed in (("0", ["before the end"]), ("1", [])):
            with self.subTest(rank):
                code, lines, errors = self.run_on(3, "run_or_abort", rank, "memory")
                self.assertEqual((6, printed), (code, lines))
                self.assertIn("out of memory", errors)

    def test_a_rank_alone_throws_its_own(self):
        for function in ("run_collectively", "run_on_root", "run_or_abort"):
            with self.subTest(function):
                self.assertEqual((0, ["0: done"]), self.run_on(1, function, "none", "failure")[:2])
                self.assertEqual((0, [f"0: {MEMORY}"]), self.run_on(1, function, "0", "memory")[:2])

    @unittest.skipUnless(LAUNCHER, "there is no mpirun")
    def test_parts_of_arrays_join(self):
        for ranks in (2, 4, 6):  # along z, and along y and z
            with self.subTest(ranks):
                code, lines, _ = self.run_on(ranks, "grid_parts")
                self.assertEqual((0, [f"{rank}: whole" for rank in range(ranks)]), (code, lines))


if __name__ == "__main__":
    unittest.main()
