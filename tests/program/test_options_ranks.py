# ctest-label: no-sanitizer
"""drogue-options on several ranks: the same files as on one rank, and an orderly end of all ranks."""

import json
import os
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import options_program
from options_program import FAST, HEADER, batch, row
from rank_processes import LAUNCHER, RANK_ENVIRONMENT, processes_of


@unittest.skipIf(LAUNCHER is None, "there is no mpirun")
class RanksTest(options_program.OptionsTest):
    def begin(self, ranks, *words, first=(), last=(), seconds="1"):
        """Starts ranks; `first` and `last` are words before the program of the first and the last rank. The launcher
        waits `seconds` between terminating and killing ranks, even if none is left."""
        program = [*words, "--backend", "serial"]
        line = [LAUNCHER, "--oversubscribe", "--mca", "odls_base_sigkill_timeout", seconds]
        for rank in range(ranks):
            before = first if rank == 0 else last if rank == ranks - 1 else ()
            line += [*([":"] if rank else []), "-n", "1", *before, options_program.PROGRAM, *program]
        process = subprocess.Popen(list(map(str, line)), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   stdin=subprocess.DEVNULL, text=True, env=RANK_ENVIRONMENT)
        self.addCleanup(process.kill)
        return process

    def end(self, process):
        """Exit code, the lines of the program on stderr (mpirun adds others after a failure), and stdout."""
        output, errors = process.communicate(timeout=60)
        own = [line for line in errors.splitlines() if line.startswith("drogue-options:") or ".csv:" in line]
        return process.returncode, own, output

    def expect_ranks(self, code, ranks, *words, **settings):
        ended = self.end(self.begin(ranks, *words, seconds="0", **settings))
        self.assertEqual((code, 1 if code else 0), (ended[0], len(ended[1])), ended)
        return ended[1][0] if code else ended[2]

    def begin_long_run(self):
        """Starts a run of minutes on three ranks; returns the launcher and the process of each rank."""
        lines = [row(k, style="american", spot=0.5 + 1e-4 * k) for k in range(5000)]
        launcher = self.begin(3, "price", self.write(batch(lines)), "--mesh", "1024", "--steps", "4096", "--result", "r.json")
        for _ in range(400):
            ranks = processes_of(launcher)
            if len(ranks) == 3 and any(name.startswith(".prices.csv") for name in self.names()):
                time.sleep(0.5)
                return launcher, ranks
            time.sleep(0.05)
        self.fail("the run has not begun")


class Results(RanksTest):
    LINES = [row(k, style="american" if k % 2 else "european", spot=0.7 + 0.02 * k, maturity=0.1 + 0.05 * k,
                 beta=9 if k % 11 == 5 else -2.5) for k in range(40)]

    def test_times_add_up(self):
        file = self.write(batch([row(k, spot=1 + 1e-6 * k, style="american") for k in range(30000)]))
        for ranks in (1, 2):
            self.expect_ranks(0, ranks, "price", file, "--mesh", "32", "--steps", "8", "--quiet", "--result", "r.json")
            times = json.loads((self.folder / "r.json").read_text())["timing"]
            wall = times.pop("wall_s")
            self.assertLess(abs(wall - sum(times.values())), 0.02 + 0.05 * wall, times)

    def test_prices_and_boundaries_are_independent_of_ranks_and_chunks(self):
        """The last case has fewer chunks than ranks."""
        file = self.write(batch(self.LINES))
        words = ("--mesh", "64", "--steps", "16", "--boundary", "b.csv", "--greeks", "--quiet", "--result", "r.json")
        written = []
        for ranks, chunk in ((1, "40"), (2, "1"), (3, "7"), (3, "20")):
            sentence = self.expect_ranks(3, ranks, "price", file, *words, "--chunk", chunk)
            self.assertIn(f"{file}:7: |beta| < alpha", sentence)
            self.assertIn("4 of 40 rows invalid", sentence)
            written.append([(self.folder / name).read_bytes() for name in ("prices.csv", "b.csv")])
            result = json.loads((self.folder / "r.json").read_text())
            self.assertEqual((ranks, "invalid", 3, sentence), tuple(result[key] for key in ("ranks", "status", "exit_code", "message")))
            self.assertEqual({"rows": 40, "ok": 36, "coarse": 0, "invalid": 4, "failed": 0}, result["counts"])
            self.assertGreater(result["timing"]["compute_s"], 0.0)
            self.assertGreater(result["ledger"]["kernel_launches"], 0)
        for other in written[1:]:
            self.assertEqual(written[0], other)
        self.assertEqual(["b.csv", "batch.csv", "prices.csv", "r.json"], self.names())

    def test_surface_larger_than_one_message_is_independent_of_ranks(self):
        """Its only row has more results than one message holds."""
        header = ",".join(name for name in HEADER.split(",") if name not in ("strike", "maturity"))
        file = self.write(f"{header}\nset,european,put,1.0,0.1,0,1,8.15,-2.5,0.767,0.4\n")
        words = ("surface", file, "--strikes", "0.8:1.2:150", "--maturities", "0.1:2:100", "--mesh", "32", "--steps", "8", "--quiet")
        for ranks in (1, 2):
            self.expect_ranks(0, ranks, *words, "--out", f"{ranks}.csv")
        self.assertGreater((self.folder / "1.csv").stat().st_size, 1_000_000)
        self.assertEqual((self.folder / "1.csv").read_bytes(), (self.folder / "2.csv").read_bytes())

    def test_prices_fewer_rows_than_ranks(self):
        for rows in (0, 2):
            output = self.expect_ranks(0, 4, "price", self.write(batch(self.LINES[:rows])), *FAST, "--tolerance", "1e-3")
            self.assertRegex(output, rf"^batch on serial: {rows} rows in ")
            self.assertEqual(3 if rows else 2, len(output.splitlines()))
            self.assertEqual(rows, len(self.prices()))


class Failures(RanksTest):
    def test_prints_errors_of_all_ranks_once(self):
        self.assertEqual(1, self.expect_ranks(0, 2, "price", "--help").count("--boundary"))
        self.assertIn("--tolerance", self.expect_ranks(2, 2, "price", "example", "--tolerance", "0"))

    def test_reports_failure_of_the_first_rank(self):
        self.assertIn("no file", self.expect_ranks(2, 2, "price", "none.csv"))
        self.assertIn("is that of line 2", self.expect_ranks(3, 2, "price", self.write(batch([row("a"), row("a")]))))
        self.assertEqual(["batch.csv"], self.names())

    def test_reports_failure_of_another_rank(self):
        sentence = self.expect_ranks(2, 3, "price", "example", "--result", "r.json", last=("env", "KOKKOS_NUM_THREADS=0"))
        self.assertRegex(sentence, r"KOKKOS_NUM_THREADS = 0 .* \(on rank 2\)$")
        self.assertEqual(["r.json"], self.names())
        self.assertEqual(sentence, "drogue-options: " + json.loads((self.folder / "r.json").read_text())["message"])

    def test_keeps_the_former_file_on_a_full_disk(self):
        """A limit of the file size simulates a full disk; it is large enough for the files of MPI."""
        file = self.write(batch([row(k, strike=-1) for k in range(200_000)]))
        self.write("former", "prices.csv")
        limit = ("sh", "-c", 'ulimit -f 16384; exec "$0" "$@"')
        self.assertRegex(self.expect_ranks(6, 2, "price", file, first=limit), "cannot write 'prices.csv'.*File too large")
        self.assertEqual(["batch.csv", "prices.csv"], self.names())
        self.assertEqual("former", (self.folder / "prices.csv").read_text())

    def test_leaves_no_output_after_a_rank_is_killed(self):
        for victim in (0, 2):
            with self.subTest(victim):
                launcher, ranks = self.begin_long_run()
                os.kill(ranks[victim], signal.SIGKILL)
                launcher.communicate(timeout=60)
                self.assertNotEqual(0, launcher.returncode)
                self.assertFalse((self.folder / "prices.csv").exists())
                for left in self.folder.glob(".prices*"):
                    self.assertEqual(0, victim)
                    left.unlink()

    def test_interrupts_all_ranks_if_one_is_terminated(self):
        for victim in (0, 1):
            with self.subTest(victim):
                launcher, ranks = self.begin_long_run()
                os.kill(ranks[victim], signal.SIGTERM)
                self.assertEqual((130, ["drogue-options: interrupted by a signal; nothing is written to 'prices.csv'"]), self.end(launcher)[:2])
                self.assertEqual(["batch.csv", "r.json"], self.names())
                self.assertEqual("interrupted", json.loads((self.folder / "r.json").read_text())["status"])
                (self.folder / "r.json").unlink()

    def test_rejects_ranks_of_another_launcher(self):
        sentence = self.expect(2, "price", "example", environment={**RANK_ENVIRONMENT, "PMI_SIZE": "2", "PMI_RANK": "0"}).stderr
        self.assertIn("started 2 processes, of which MPI finds 1", sentence)


if __name__ == "__main__":
    unittest.main()
