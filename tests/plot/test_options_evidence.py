"""Pages of records of options: curves and settings, published results, goals, and tables of [Shi]."""


import packages  # noqa: F401, before modules that need the packages  isort: skip
import synthetic_records as records
from evidence_pages import Folder
from plot.evidence import perf_record, work_precision
from plot.evidence.work_precision_figure import solution_figure
from plot.options import transfers
from plot.options.published_results import PUBLISHED_RESULTS
from plot.options.scheme_family import FAMILY

MACHINE = "NVIDIA H200, Intel Xeon Processor"
SOLUTION = "The put of [Shi]: error against time"


def figure_of(folder, machine=records.EPYC, backend="serial"):
    evidence = folder.evidence(records.options_solutions(machine, backend))
    found = work_precision.curves(evidence.records)
    best = work_precision.best_scheme(found)
    return solution_figure("thesis", evidence.machines[0], found, best, "")


class Solutions(Folder):
    def test_schemes_without_settings_count_as_default(self):
        found = work_precision.curves(self.evidence(records.options_solutions()).records)
        usual = [curve.scheme.key for curve in found if curve.scheme.has_default_settings]
        self.assertEqual(["pide", "cos", "seed"], usual)
        self.assertEqual("pide", work_precision.best_scheme(found))
        self.assertAlmostEqual(2.0, found[0].order)

    def test_figure_has_row_per_number_of_steps(self):
        figure = figure_of(self)
        titles = {text.get_text() for text in figure.texts}
        self.assertIn("finite differences, a step for four intervals", titles)
        self.assertIn("finite differences, a step for two intervals", titles)
        top, four, two = figure.axes
        self.assertEqual([4, 4], [len(axes.lines) for axes in (four, two)])
        self.assertEqual(four.get_xlim(), two.get_xlim())
        self.assertGreater(top.get_xlim()[1], four.get_xlim()[1])

    def test_published_results_appear_in_panel_of_their_backend(self):
        def labels(figure):
            return {text.get_text() for text in figure.axes[0].texts}

        core, gpu = labels(figure_of(self)), labels(figure_of(self, records.H200, "cuda"))
        self.assertEqual({"[Shi], one option", "[Shi], 4096 options", "hand-written AVX-512", "PROJ"}, core)
        self.assertEqual(core | {"hand-written CUDA"}, gpu)

    def test_published_results_have_problem_backend_and_source(self):
        for result in PUBLISHED_RESULTS:
            self.assertIn(result.problem, FAMILY.problems)
            self.assertIn(result.backend, perf_record.BACKENDS)
            self.assertTrue(result.source and all(seconds > 0 and error > 0 for seconds, error in result.points))

    def test_table_shows_times_to_target_errors(self):
        page, files = self.page(records.options_solutions(), "options")
        self.assertEqual(["options.html", "solution_thesis_amd-epyc.png"], files)
        rows = page.tables["AMD EPYC", SOLUTION]
        names = [row[1] for row in rows]
        for name in ("finite differences", "cosine series", "finite differences, split exercise, one grid"):
            self.assertIn(name, names)
        # 1e-4 is met at 100 intervals: n^2/4 ns.
        own = rows[names.index("finite differences")]
        self.assertEqual("2.5 \u00b5s", own[rows[0].index("to 1\u00d710\u22124")])
        self.assertIn("hand-written AVX-512: a prototype", page.words)
        self.assertIn("0.1 %, 0.01 % and 0.001 %", page.words)


class Batches(Folder):
    def test_surfaces_and_cosine_series_show_their_times(self):
        page, _ = self.page(records.surfaces(), "options")
        surfaces = {row[1]: row for row in page.tables[MACHINE, "Surfaces of strikes and maturities"]}
        self.assertEqual("264", surfaces["surface 1x33x8"][2])
        self.assertIn("200", surfaces["surface 1x33x8"][3])
        self.assertIn("120", surfaces["apart 1x33x8"][3])
        puts = {row[1]: row for row in page.tables[MACHINE, "A batch by cosine series"]}
        self.assertEqual(["CUDA", "cos", "256"], puts["cos"][:3])

    def test_batches_show_verdicts_and_systems_their_times(self):
        page, _ = self.page(records.options_batches(), "options")
        rows = page.tables[MACHINE, "A batch"]
        verdicts = {row[0]: row[-1] for row in rows if len(row) == 7}
        self.assertEqual("goal met", verdicts["CUDA, 4096 options, 128x32"])
        self.assertEqual("missed by 233 %", verdicts["CUDA, 1 options, 128x32"])
        systems = {row[1]: row for row in page.tables[MACHINE, "Tridiagonal systems"]}
        self.assertEqual(["CUDA", "scan/128", "4\u2009096"], systems["scan/128"][:3])
        self.assertTrue(systems["pttrf/128"][3].startswith("40 ["))

    def test_transfers_table_shows_times_of_dissertation_and_ours(self):
        page, files = self.page(records.options_transfers(), "options")
        self.assertEqual(["options-transfers_cuda_nvidia-h200.png", "options.html"], files)
        rows = page.tables[MACHINE, "Tables 5.7 and 5.8, CUDA"]
        self.assertEqual([5, 5, 6], [sum(row[:2] == place for row in rows) for place in (
            ["1", "128"], ["1", "256"], ["32", "128"])])
        pageable, pinned = (row for row in rows if row[:3] == ["32", "128", "ours, two solves for an error"])
        self.assertEqual(["pageable", "20", "160", "20", "200", "19\u2009478", "1\u00d710\u22124"], pageable[3:])
        self.assertEqual(["pinned", "18", "160", "20", "198"], pinned[3:8])

    def test_labels_of_published_results_are_within_the_panel_and_apart(self):
        figure = figure_of(self, records.H200, "cuda")
        figure.canvas.draw()
        self.assertGreater(len(self.assert_apart(figure.axes[0].texts, figure.axes[0].bbox)), 3)

    def test_draws_transfers_without_times_of_dissertation(self):
        lines = [line | {"facts": line["facts"] | {"thesis": {}}} for line in records.options_transfers()]
        evidence = self.evidence(lines)
        rows = transfers.transfer_rows(evidence.records)
        self.assertEqual({"seed", "pide"}, {row.source for row in rows})
        transfers.transfers_figure("title", evidence.machines[0], evidence.records)
