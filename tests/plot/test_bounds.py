"""Bounds of a step by the measured ceilings, scaling, and the cost of Kokkos, on pages of synthetic records."""


import packages  # before modules that need the packages  isort: skip
import synthetic_records as records
from evidence_pages import Folder
from plot.evidence.bounds import backend_ceilings, bounds, bounds_table, ceiling_table, ceilings, word
from plot.evidence.page import machine_sections
from plot.evidence.records import read_records
from plot.evidence.roofline import points, roofline_figure

H200 = "NVIDIA H200, Intel Xeon Processor"


class Numbers(Folder):
    def setUp(self):
        super().setUp()
        found = self.evidence(records.ceilings() + records.more_ceilings() + records.counted_steps()).records
        self.tops = ceilings([record for record in found if record.kind == "ceiling"])
        self.steps = {record.case: record for record in found if record.kind != "ceiling"}

    def at_least(self, case):
        return {bound.name: 1e6 * bound.seconds for bound in bounds(self.steps[case], self.tops)}

    def test_ceilings_are_rates_and_latencies(self):
        self.assertEqual({"fp64", "fp32", "issue", "memory", "cache", "launch", "graph-node"}, set(self.tops))
        self.assertAlmostEqual(66e12, self.tops["fp32"], delta=1e3)
        self.assertAlmostEqual(33e12, self.tops["issue"], delta=1e3)
        self.assertEqual((2e-6, 0.5e-6), (self.tops["launch"], self.tops["graph-node"]))

    def test_work_over_a_ceiling_is_the_least_time(self):
        found = self.at_least("gas-step/cuda/1048576")
        for name, expected in (("FP64", 40.0), ("issue", 20.0), ("memory", 10.0), ("launches", 1.0)):
            self.assertAlmostEqual(expected, found[name], delta=1e-9)

    def test_launches_of_a_persistent_kernel_bind_nothing(self):
        self.assertNotIn("launches", self.at_least("gas-step/cuda/1024"))

    def test_launch_outside_of_a_graph_takes_longer(self):
        self.assertAlmostEqual(2.0, self.at_least("springs-step/cuda/10000")["launches"], delta=1e-9)

    def test_traffic_faster_than_memory_comes_from_the_cache(self):
        self.assertIn("memory", self.at_least("springs-step/cuda/1000000"))
        # 1 us from memory, but the step takes 0.9 us.
        found = self.at_least("springs-step/cuda/10000")
        self.assertNotIn("memory", found)
        self.assertAlmostEqual(4.2 / 5.3, found["L2"], delta=1e-9)

    def test_caches_have_the_level_of_their_backend(self):
        self.assertTrue(word("cache", "cuda").startswith("L2 cache"))
        self.assertTrue(word("cache", "serial").startswith("L1 cache"))
        self.assertTrue(word("l3", "openmp").startswith("L3 cache"))

    def test_steps_without_counted_work_have_no_table(self):
        [step] = self.evidence(records.springs_steps()[:1]).records
        self.assertIsNone(bounds_table([step], self.tops))

    def test_names_no_latency_where_work_is_not_counted(self):
        [step] = self.evidence([dict(line, samples=[100 * s for s in line["samples"]], median=100 * line["median"],
                                     interval=[100 * s for s in line["interval"]])
                                for line in records.counted_steps() if line["case"] == "springs-step/cuda/1000000"]).records
        [row] = bounds_table([step], self.tops).rows
        self.assertEqual("none of those known (memory, 0.8 %)", row[-1])

    def test_threads_reach_no_less_than_one_core(self):
        lines = [line for backend, cache in (("serial", 368e9), ("openmp", 356e9))
                 for line in records.ceilings(backend, records.EPYC, 1e11, 1e10, cache)]
        found = self.evidence(lines).records
        tops, note = backend_ceilings(found, "openmp")
        self.assertAlmostEqual(368e9, tops["cache"], delta=1)
        self.assertIn("L1 cache, read and written: 356 GB/s", note)
        self.assertNotIn("memory", note)
        self.assertEqual("", backend_ceilings(found, "serial")[1])
        self.assertIn(note, str(ceiling_table(tops, "openmp", note).note))

    def test_roofline_shows_what_launches_allow(self):
        gas = [record for case, record in self.steps.items() if case.startswith("gas-step")]
        found = points(gas, self.tops)
        self.assertEqual([1024, 2048, 1048576], [point.cells for point in found])
        self.assertIsNone(found[0].launch_rate)
        self.assertAlmostEqual(2.64e6 / 1e-6, found[1].launch_rate, delta=1.0)
        figure = roofline_figure("Roofline", gas[0].machine, self.tops, found)
        words = " ".join(text.get_text() for text in figure.axes[0].texts)
        self.assertIn("FP32 66 TFLOP/s", words)
        marks = [line for line in figure.axes[0].lines if line.get_marker() == "_"]
        self.assertEqual([[found[1].launch_rate]], [list(mark.get_ydata()) for mark in marks])


class Page(Folder):
    def rows(self, app, title):
        page, _ = self.page(records.ceilings() + records.more_ceilings() + records.counted_steps(), app=app)
        return page.tables[H200, title]

    def test_page_names_the_binding_ceiling_of_gas(self):
        rows = self.rows("gas", "Roofline, CUDA")
        verdicts = {row[0]: row[-1] for row in rows if len(row) == 7}
        self.assertEqual("FP64, 80 %", verdicts["1 M"])
        self.assertEqual("launches, 80 %", verdicts["2048"])
        self.assertEqual("none: latencies within one launch (FP64, 1 %)", verdicts["1024"])
        self.assertIn(["kernel in a graph", "0.5 us"], rows)
        self.assertIn(["issue of instructions", "33 Tinstructions/s"], rows)

    def test_page_names_the_binding_ceiling_of_springs(self):
        rows = self.rows("springs", "Bounds of a step, CUDA")
        verdicts = {row[0]: row[-1] for row in rows if len(row) == len(rows[0])}
        self.assertEqual("memory, 80 %", verdicts["1000000"])

    def test_page_names_the_binding_ceiling_of_batches(self):
        page, _ = self.page(records.ceilings() + records.more_ceilings() + records.counted_batches(), app="options")
        for title, size, verdict in (("Bounds of a batch, CUDA", "4096 128x32", "FP64, 80 %"),
                                     ("Bounds of tridiagonal systems, CUDA", "4096 scan/128", "memory, 80 %")):
            rows = page.tables[H200, title]
            self.assertEqual({size: verdict}, {row[0]: row[-1] for row in rows[1:] if len(row) == len(rows[0])})
            self.assertEqual("us per batch", rows[0][1])

    def test_small_numbers_of_a_page_have_powers_without_marks_of_html(self):
        lines = records.counted_batches()
        lines[0]["facts"]["bytes"] = 1.0
        page, _ = self.page(records.ceilings() + records.more_ceilings() + lines, app="options")
        self.assertIn("\u00d710\u2212", page.words)
        self.assertNotIn("<sup", page.words)


class Counts(Folder):
    """Records whose counts of work were corrected later: their bounds are wrong."""

    def steps(self, moved, machine, day):
        made = [line for line in records.counted_steps(machine) if line["case"] == "springs-step/cuda/1000000"]
        for line in made:
            line["facts"]["bytes"] = moved
            line["provenance"] = line["provenance"] | {"date": f"2026-11-{day}T12:00:00Z"}
        return made

    def page_of(self, moved, days=(25, 27)):
        lines = self.steps(moved, records.H200, days[0]) + self.steps(420e6, records.EPYC, days[1])
        page, _ = self.page(records.ceilings() + records.more_ceilings() + lines, app="springs")
        return page

    def test_outdated_count_gives_no_verdict(self):
        page = self.page_of(300e6)
        self.assertNotIn("memory, ", " ".join(row[-1] for row in page.tables.get((H200, "Bounds of a step, CUDA"), [])))
        self.assertIn("1 record has no bounds: their counts of work differ from the latest ones of the same case: springs-step/cuda/1000000 on NVIDIA H200",
                      page.words)

    def test_latest_count_is_right(self):
        for page in (self.page_of(415e6), self.page_of(300e6, (27, 25))):
            verdicts = {row[0]: row[-1] for row in page.tables[H200, "Bounds of a step, CUDA"]}
            self.assertIn("memory, ", verdicts["1000000"])
            self.assertNotIn("no bounds: their counts of work differ from the latest ones of the same case: springs-step/cuda/1000000 on NVIDIA H200",
                             page.words)

    def test_committed_records_agree_on_counted_work(self):
        """Only records of the H200 from before a correction of the traffic of flow may be left out."""
        evidence = read_records(packages.SOURCE / "docs" / "evidence")
        self.assertLessEqual({(record.kind, record.machine.gpu, record.run_id[0][:10]) for record in evidence.outdated},
                             {("flow-step", "NVIDIA H200", "2026-11-25")})
        counts = {}
        for record in evidence.records:
            for name in ("flops", "bytes", "instructions"):
                if name in record.facts and record.kind not in ("ceiling", "scaling"):
                    counts.setdefault((record.case, name), []).append(record.facts[name])
        self.assertGreater(len(counts), 100)
        for case, found in counts.items():
            self.assertLessEqual(max(found), 1.02 * min(found), case)
        [table] = [table for machine, sections in machine_sections("flow", evidence.for_app("flow")) if machine.gpu == "NVIDIA H200"
                   for section in sections if section.title.startswith("Bounds") for table in section.tables[:1]] or [None]
        self.assertTrue(table is None or not evidence.outdated, table)


class CostOfKokkos(Folder):
    def rows(self, app, lines):
        page, _ = self.page(lines, app=app)
        return page.tables[H200, "Cost of Kokkos"]

    def test_pairs_have_ratios_and_verdicts(self):
        rows = self.rows("gas", records.abstraction())
        self.assertEqual(["gas-step", "1\u2009048\u2009576", "in a graph", "102", "100", "1.020 [1.010 .. 1.030]"],
                         rows[1][:6])
        self.assertEqual("met", rows[1][-1])
        # A small size has no goal.
        self.assertEqual(("one by one", ""), (rows[2][2], rows[2][-1]))
        self.assertEqual("missed", self.rows("springs", records.abstraction())[1][-1])

    def test_failed_pair_has_no_row(self):
        lines = records.abstraction()
        lines[1]["check"] = "failed"
        self.assertEqual(1, len(self.rows("gas", lines)[1:]))


class Scaling(Folder):
    def test_efficiency_is_against_one_unit(self):
        page, _ = self.page(records.scaling(), app="gas")
        rows = page.tables["AMD EPYC", "Scaling"][1:]
        self.assertEqual([("1 thread", "100 %"), ("2 threads", "80 %")], [(row[4], row[6]) for row in rows])

    def test_weak_scaling_compares_growing_sizes(self):
        page, _ = self.page(records.scaling(), app="flow")
        rows = page.tables["AMD EPYC", "Scaling"][1:]
        self.assertEqual([("weak", "1 rank", "100 %"), ("weak", "2 ranks", "50 %")],
                         [(row[2], row[4], row[6]) for row in rows])
        self.assertEqual([["", ""], ["20 %", "15 %"]], [list(row[7:]) for row in rows])

    def test_without_one_unit_there_is_no_efficiency(self):
        page, _ = self.page(records.scaling()[1:2], app="gas")
        self.assertNotIn("efficiency", page.tables["AMD EPYC", "Scaling"][0])
