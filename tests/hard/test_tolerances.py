"""Hard cases with a closed form meet their tolerances, for every scheme, on up to 401 cells."""

import gas_program
import hard_cases

ROWS = [row for row in hard_cases.rows("tolerances.csv") if row["reference"] in ("exact", "none") and int(row["N"]) <= 401]


class Tolerances(gas_program.GasTest):
    def assert_meets(self, row, backend):
        quiet = hard_cases.tolerance_sets(row) + [gas_program.NO_FIELDS, "output.history_every=0"]
        run = self.start(row["case"], "--quiet", "--overwrite", "--out", "run", "--backend", backend, sets=quiet)
        self.assertEqual(0, run.returncode, run.stderr)
        checks = {check["name"]: check for check in self.result("run")["checks"]}
        self.assertEqual({row["quantity"], "conservation"}, set(checks))
        self.assertLessEqual(checks["conservation"]["value"], 1e-12)

    def test_table_lists_every_scheme_and_mesh(self):
        self.assertGreaterEqual(len(ROWS), 170)
        self.assertEqual({"js", "z1", "z2", "teno5"}, {row["scheme"] for row in ROWS})

    def test_serial_meets_the_tolerances(self):
        for row in ROWS:
            with self.subTest(hard_cases.label(row)):
                self.assert_meets(row, "serial")

    @gas_program.needs_openmp
    def test_openmp_meets_the_tolerances(self):
        """Each case once; other tests compare the backends bit for bit."""
        once = {row["case"]: row for row in ROWS if row["N"] in ("200", "201")}
        self.assertEqual(14, len(once))
        for row in once.values():
            with self.subTest(hard_cases.label(row)):
                self.assert_meets(row, "openmp")
