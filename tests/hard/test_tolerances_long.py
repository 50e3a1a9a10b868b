"""Finest rows of tolerances.csv: 800 cells and more, and published references on 12800 cells."""

import gas_program
import hard_cases
import reference_tolerances

ROWS = [row for row in hard_cases.rows("tolerances.csv") if row["reference"] in ("exact", "none") and int(row["N"]) >= 800]


class FineTolerances(gas_program.GasTest):
    def test_exact_cases_meet_the_tolerances(self):
        self.assertGreaterEqual(len(ROWS), 40)
        for row in ROWS:
            with self.subTest(hard_cases.label(row)):
                sets = hard_cases.tolerance_sets(row) + [gas_program.NO_FIELDS, "output.history_every=0"]
                run = self.start(row["case"], "--quiet", "--overwrite", "--out", "run", "--backend", "serial", sets=sets)
                self.assertEqual(0, run.returncode, run.stderr)


class FineReferenceTolerances(reference_tolerances.ReferenceTest):
    def test_meets_the_tolerances_on_800_cells(self):
        rows = reference_tolerances.rows(lambda row: row["reference"] == "z1:3200" and row["N"] == "800")
        self.assertEqual(8, len(rows))
        self.assert_all_met(rows, "serial")

    def test_matches_the_published_references(self):
        rows = reference_tolerances.rows(lambda row: row["source"] == "published")
        self.assertEqual(21, len(rows))
        self.assert_all_met(rows, "serial")
