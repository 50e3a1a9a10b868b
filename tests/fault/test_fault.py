"""Fault tests of the checks: a tolerance below the error of the run ends with exit code 5."""

import re

import gas_program

NORMS = [f"{norm}_{quantity}" for norm in ("l1", "l2", "linf") for quantity in ("density", "velocity", "pressure")]
COARSE = ["mesh.cells=50", "verify.l1_density=1.0", "output.times=[0.4]"]


class Fault(gas_program.GasTest):
    def assert_fails(self, scene, name, tolerance, *words, sets=()):
        """Expects a failed check with a tolerance that the scene cannot meet, in message, result.json and files."""
        run = self.expect(5, scene, "--overwrite", "--out", "run", "--backend", "serial", *words, sets=sets)
        found = re.search(rf"{name} is (\S+), above its tolerance (\S+)$", run.stderr.strip())
        self.assertTrue(found, run.stderr)
        self.assertEqual(tolerance, float(found[2]))
        self.assertGreater(float(found[1]), tolerance)
        reported = self.result("run")
        self.assertEqual(("verification-failed", 5), (reported["status"], reported["exit_code"]))
        self.assertIn(reported["message"], run.stderr)
        check = next(check for check in reported["checks"] if check["name"] == name)
        self.assertEqual((False, tolerance), (check["passed"], check["tolerance"]))
        self.assertAlmostEqual(check["value"], float(found[1]), delta=1e-5 * check["value"])
        others = [other for other in reported["checks"] if other is not check]
        self.assertTrue(all(other["passed"] for other in others), others)
        for file in ("scene.toml", "history.csv", "fields.h5", "fields.xdmf"):
            self.assertTrue((self.folder / "run" / file).exists(), file)
        self.assertRegex(run.stdout, rf"{name} .*FAILED")

    def test_detects_errors_against_the_exact_solution(self):
        for name in NORMS:
            with self.subTest(name):
                self.assert_fails("sod", name, 1e-12, sets=[*COARSE, f"verify.{name}=1e-12"])

    def test_detects_errors_against_the_advected_wave(self):
        for name in ("l1_density", "linf_density", "l2_velocity"):
            with self.subTest(name):
                self.assert_fails("entropy-wave", name, 1e-18, sets=[
                    "run.end_time=0.1", "output.times=[0.1]", f"verify.{name}=1e-18"])

    def test_detects_errors_against_a_finer_run(self):
        for name in ("l1_density", "linf_pressure"):
            with self.subTest(name):
                self.assert_fails("shu-osher", name, 1e-3, sets=[
                    "mesh.cells=100", "verify.reference.cells=400", "verify.l1_density=10.0", f"verify.{name}=1e-3"])

    def test_detects_conservation_errors(self):
        self.assert_fails("sod", "conservation", 1e-18, sets=[*COARSE, "verify.conservation=1e-18"])

    def test_conservation_error_is_round_off_and_not_zero(self):
        """The conservation error is round-off, and it is not reported as 0."""
        self.assert_fails("lax", "conservation", 0.0, sets=["verify.conservation=0.0"])

    def test_detects_a_wrong_density_peak(self):
        self.assert_fails("sedov", "max_density", 0.002, sets=["mesh.cells=101"])  # 4.83 is not 5.30
        self.assert_fails("sedov", "max_density", 1e-6, sets=["verify.max_density.tolerance=1e-6"])

    def test_detects_a_wrong_scheme(self):
        """The shipped scene with a scheme that does not meet the tolerance of WENO-Z."""
        self.assert_fails("sod", "l1_density", 0.00518, sets=['scheme.weno="js"', "output.times=[0.4]"])

    def test_detects_a_wrong_gas(self):
        self.assert_fails("shock-slow", "l1_density", 1.0e-3, sets=["gas.gamma=1.5", "verify.l1_density=1e-3"])

    def test_quiet_runs_report_failures(self):
        run = self.expect(5, "sod", "--quiet", "--out", "run", sets=[*COARSE, "verify.l1_density=1e-9"])
        self.assertEqual("", run.stdout)
        self.assertIn("l1_density", run.stderr)

    def test_names_the_first_failed_check_and_lists_all(self):
        run = self.expect(5, "sod", "--out", "run", sets=[*COARSE, *(f"verify.{name}=1e-12" for name in NORMS)])
        self.assertEqual(9, run.stdout.count("FAILED"))
        self.assertEqual(9, sum(not check["passed"] for check in self.result("run")["checks"]))
