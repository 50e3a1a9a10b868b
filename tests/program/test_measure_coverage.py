# ctest-label: no-sanitizer
"""Coverage of the stated error of drogue-options as scripts/studies/measure_coverage.py measures it."""

import json
import os
import subprocess
import sys

SOURCE = os.environ["DROGUE_SOURCE"]
sys.path.insert(0, SOURCE + "/scripts/studies")

import fit_error_estimate
import gas_program
import measure_coverage
import options_program

# Divides the stated errors of finite differences by a thousand.
UNDERSTATING = f"""#!{sys.executable}
import csv, subprocess, sys
code = subprocess.run([{str(options_program.PROGRAM)!r}, *sys.argv[1:]]).returncode
if "cos" not in sys.argv:
    path = sys.argv[sys.argv.index("--out") + 1]
    rows = list(csv.DictReader(open(path)))
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(row | {{"error": float(row["error"]) / 1000}} for row in rows)
sys.exit(code)
"""


def row(price, error):
    return {"price": str(price), "error": str(error)}


class Coverage(gas_program.GasTest):
    def measure(self, *words, program=options_program.PROGRAM, code=0):
        """Output of the script on few contracts, and the table that it writes."""
        out = self.folder / "coverage.json"
        done = subprocess.run(
            [sys.executable, "-B", SOURCE + "/scripts/studies/measure_coverage.py", "--program", program, "--backend", "serial",
             "--rows", "8", "--out", out, *words],
            capture_output=True, text=True, check=False, timeout=300, env=gas_program.ENVIRONMENT)
        self.assertEqual(code, done.returncode, done.stderr)
        return done, json.loads(out.read_text())["table"] if code == 0 else []

    def test_counts_covered_rows_and_quotients(self):
        known = [row(1.0, 1e-9)] * 4 + [row(1.0, 0.05), row("", "")]
        found = [row(1.1, 0.2), row(0.9, 0.4), row(1.2, 0.1), row(1.1, 0.3), row(1.0, 0.1), row(1.0, 0.1)]
        result = measure_coverage.coverage(found, known)
        self.assertEqual((4, 2, 0.75), (result["rows"], result["undecided"], result["covered"]))
        self.assertAlmostEqual(2.5, result["median"])
        self.assertAlmostEqual(0.5, result["tenth"])
        self.assertIsNone(measure_coverage.coverage([row("", "")], [row(1.0, 0.1)])["covered"])

    def test_prints_table_per_model_and_style(self):
        done, table = self.measure("--styles", "european", "--mesh", "128", "--steps", "32")
        self.assertEqual(["gh", measure_coverage.PURE, *measure_coverage.MODELS[1:]], [entry["model"] for entry in table])
        self.assertEqual(1 + len(table), len(done.stdout.splitlines()))
        pure = table.pop(1)
        self.assertTrue(0 < pure["rows"] + pure["undecided"] < 8)
        for entry in table:
            self.assertEqual(8, entry["rows"] + entry["undecided"])
            self.assertGreaterEqual(entry["covered"], 0.5, entry)
            self.assertGreater(entry["median"], 1.0, entry)
        self.assertEqual([table[0], pure, *table[1:]],
                         self.measure("--styles", "european", "--mesh", "128", "--steps", "32")[1])
        self.assertNotEqual(table, self.measure("--styles", "european", "--mesh", "128", "--steps", "32", "--seed", "2")[1])

    def test_compares_american_options_with_finer_grid(self):
        words = ("--styles", "american", "--models", "black-scholes", "--rows", "3", "--tolerance", "1e-3,1e-4")
        table = self.measure(*words)[1]
        self.assertEqual([1e-3, 1e-4], [entry["tolerance"] for entry in table])
        for entry in table:
            self.assertEqual((3, 0), (entry["rows"], entry["undecided"]))
            self.assertGreater(entry["median"], 1.0)
        # A reference that is as coarse as the prices decides nothing.
        coarse = self.measure(*words, "--reference", "64", "16")[1]
        self.assertEqual(3, coarse[1]["undecided"], coarse)

    def test_finds_errors_that_are_stated_too_small(self):
        program = self.folder / "understating"
        program.write_text(UNDERSTATING, encoding="utf-8")
        program.chmod(0o755)
        (entry,) = self.measure("--styles", "european", "--models", "merton", "--mesh", "64", "--steps", "8", program=program)[1]
        self.assertGreater(entry["rows"], 4)
        self.assertLess(entry["covered"], 0.5)

    def test_rejects_invalid_arguments(self):
        self.assertIn("valid names are gh", self.measure("--models", "heston", code=2)[0].stderr)
        self.assertIn("belong together", self.measure("--mesh", "64", code=2)[0].stderr)
        self.assertIn("--tolerance", self.measure("--tolerance", "7", code=1)[0].stderr)


class Fit(gas_program.GasTest):
    def test_quantile_is_interpolated(self):
        self.assertEqual([1.0, 2.5, 4.0], [fit_error_estimate.quantile([4.0, 1.0, 3.0, 2.0], part) for part in (0.0, 0.5, 1.0)])

    def test_ratios_of_decided_rows(self):
        known = [row(1.0, 1e-9), row(1.0, 0.05), row(1.0, 1e-9)]
        self.assertEqual([0.5], fit_error_estimate.ratios([row(1.5, 1.0), row(1.1, 0.1), row("", "")], known))

    def test_present_constants_are_those_of_the_source(self):
        with open(SOURCE + "/kernels/options/pide/error_estimate.hpp", encoding="utf-8") as file:
            text = file.read()
        few, by_steps, in_space = [present for _, present, _, _ in fit_error_estimate.TERMS]
        self.assertIn(f"device::minimum(R({few}), ({by_steps} / steps) * time_part)", text)
        self.assertIn(f"{in_space} * root *", text)

    def test_fits_present_constants_within_their_order(self):
        done = subprocess.run(
            [sys.executable, "-B", SOURCE + "/scripts/studies/fit_error_estimate.py", "--program", options_program.PROGRAM,
             "--backend", "serial", "--rows", "20"],
            capture_output=True, text=True, check=False, timeout=300, env=gas_program.ENVIRONMENT)
        self.assertEqual(0, done.returncode, done.stderr)
        lines = done.stdout.splitlines()[1:]
        self.assertEqual(len(fit_error_estimate.TERMS), len(lines))
        for line, (_, present, _, _) in zip(lines, fit_error_estimate.TERMS, strict=True):
            largest = float(line.split()[-1])
            self.assertTrue(present / 4 < largest < 2 * present, line)
