"""Shu-Osher and the blast against a run on 3200 cells, for every scheme, on up to 400 cells."""

import gas_program
import reference_tolerances


class ReferenceTolerances(reference_tolerances.ReferenceTest):
    ROWS = reference_tolerances.rows(lambda row: row["reference"] == "z1:3200" and int(row["N"]) <= 400)

    def test_table_lists_every_scheme_and_mesh(self):
        self.assertEqual(16, len(self.ROWS))

    def test_serial_meets_the_tolerances(self):
        self.assert_all_met(self.ROWS, "serial")

    @gas_program.needs_openmp
    def test_openmp_meets_the_tolerances(self):
        self.assert_all_met([row for row in self.ROWS if (row["scheme"], row["N"]) == ("z1", "200")], "openmp")
