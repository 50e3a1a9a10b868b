"""One page of all records: contents, self-containment, size, headings and names of pictures."""

import re
import unittest
import unittest.mock
from html.parser import HTMLParser

import packages  # noqa: F401, before modules that need the packages  isort: skip
import synthetic_records as records
from evidence_pages import Folder, Page, plot

MACHINE = "NVIDIA H200, Intel Xeon Processor"


class Outline(HTMLParser):
    """Levels of headings, targets of links, identifiers, and images without a text."""

    def __init__(self, text):
        super().__init__()
        self.levels, self.targets, self.identifiers, self.nameless = [], [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        if re.fullmatch("h[1-6]", tag):
            self.levels.append(int(tag[1]))
        if tag == "a":
            self.targets.append(values["href"].removeprefix("#"))
        if "id" in values:
            self.identifiers.add(values["id"])
        if (tag == "img" and not values.get("alt")) or (values.get("role") == "img" and not values.get("aria-label")):
            self.nameless.append(values)


class Report(Folder):
    def report(self, lines):
        """Text of the page."""
        records.write(self.folder / "a.jsonl", lines)
        code, files, sentence = plot(self.folder, "--report", "--dpi", 60)
        self.assertEqual((code, sentence, files), (0, "", ["report.html"]))
        self.assertEqual({"a.jsonl", "report.html"}, {file.name for file in self.folder.iterdir()})
        return (self.folder / "report.html").read_text(encoding="utf-8")

    def test_holds_every_record_and_the_sections_of_all_mini_apps(self):
        odd = records.record("new-kind/serial/1", 3e-3, records.EPYC)
        bad = records.step("cuda/2048", 654e-6, records.H200, 2048, check="failed")
        page = Page(self.report([*records.steps_of_h200(), *records.transfers(), odd, bad]))
        for words in ("new-kind/serial/1", "gas-step/cuda/2048", "3 ms", "1 record is left out for a failed check",
                      "Transfers of a step, CUDA", "drogue-perf table transfers", "AMD EPYC", "Gas dynamics"):
            self.assertIn(words, page.words)

    def test_cold_caches_are_named_and_enter_no_figure(self):
        cold = records.step("cuda/8192", 1e-3, records.H200, 8192, run="2026-11-23T05:00:00Z", instrument={"caches": "cold"})
        warm = Page(self.report(records.steps_of_h200()))
        page = Page(self.report([*records.steps_of_h200(), cold]))
        self.assertIn("gas-step/cuda/8192, cold caches", page.words)
        self.assertIn("1 record with cold caches", page.words)
        self.assertNotIn("left out", page.words)
        sections = [name for name in warm.tables if name[0] != "Samples of every case"]
        self.assertTrue(sections)
        for name in sections:
            self.assertEqual(warm.tables[name], page.tables[name])
        nothing_else = Page(self.report([cold]))
        self.assertIn("gas-step/cuda/8192, cold caches", nothing_else.words)

    def test_is_small_refers_to_nothing_and_can_be_read_aloud(self):
        text = self.report([*records.steps_of_h200(), *records.transfers(), *records.blocks()])
        self.assertLess(len(text), 5e6)
        self.assertEqual([], re.findall(r"(?:src|href)=\"(?!data:|#)[^\"]*", text))
        self.assertNotIn("<script", text)
        self.assertNotIn("url(", text)
        outline = Outline(text)
        self.assertEqual([], outline.nameless)
        self.assertLessEqual(set(outline.targets), outline.identifiers)
        self.assertEqual(1, outline.levels[0])
        self.assertTrue(all(after <= before + 1 for before, after in zip(outline.levels, outline.levels[1:])))
        self.assertIn("@media print", text)
        self.assertNotIn("<th>", text)

    def test_outline_has_machines_and_sections_below_their_mini_app(self):
        outline = Outline(self.report([*records.steps_of_h200(), *records.transfers(), *records.steps_of_core()]))
        self.assertEqual([1, 2, 3, 3, 2, 3, 4, 5, 5, 4, 3, 4, 5, 5], outline.levels)
        code, _, _ = plot(self.folder, "--dpi", 60)
        self.assertEqual(0, code)
        page = Outline((self.folder / "gas.html").read_text(encoding="utf-8"))
        self.assertEqual([1, 2, 3, 4, 4, 3, 2, 3, 4, 4], page.levels)

    def test_large_folders_have_a_summary_and_shortened_tables(self):
        from plot.evidence import report

        lines = [records.step(f"cuda/{cells}", 1e-6 * cells, records.H200, cells) for cells in range(1000, 1400)]
        lines[7]["check"] = "failed"
        whole = self.report(lines)
        self.assertEqual(400, whole.count("<td class=\"case\">gas-step/cuda/"))
        with unittest.mock.patch.multiple(report, MOST_STRIPS=100, MOST_ROWS=300, MOST_BYTES=20_000):
            text = self.report(lines)
        self.assertLess(len(text), len(whole) / 2)
        page = Page(text)
        self.assertIn(["gas-step", "cuda", "400", "1", "1 ms", "1.4 ms", "1×10−4"], page.tables["Every case", MACHINE])
        self.assertIn("gas-step/cuda/1007", page.words)
        self.assertNotIn("gas-step/cuda/1008", page.words)
        self.assertRegex(page.words, r"\d+ more rows are left out to keep the page below 5 MB")
        self.assertIn("records.csv", page.words)

    def test_shows_occupancy_and_the_machine_as_tables(self):
        text = self.report([*records.occupancy(), *records.hardware()])
        self.assertIn(">Machine and occupancy</h2>", text)
        self.assertIn("<code>drogue-perf table machine --out FILE.jsonl</code>", text)
        self.assertIn("<code>drogue-perf table occupancy [--architecture NAME] [--profile FILE] --out FILE.jsonl</code>", text)
        page = Page(text)
        self.assertNotIn("which this page does not know", page.words)
        self.assertNotIn("left out", page.words)
        self.assertNotIn("Samples of every case", page.words)
        self.assertEqual([], Outline(text).nameless)
        hardware = page.tables["Machine and occupancy", MACHINE]
        self.assertEqual(["CPU", "two Xeon E5-2687W", "Intel(R) Xeon(R) Processor, 16 cores, 2.1 GHz, 64 GiB"], hardware[1])
        self.assertEqual(["caches", "L3 2 x 20 MB", "L1 768 KiB, L2 32 MiB, L3 not stated, of all cores"], hardware[2])
        self.assertIn(["GPU", "two Quadro 6000", "NVIDIA H200, 132 multiprocessors, 1.98 GHz"], hardware)
        computed = page.tables["Machine and occupancy", "AMD EPYC"]
        self.assertIn(["64", "0 (0)", "8 (8)", "64 (64)", "64 (64)", "8 (8)", "512 (512)", "7168 (7168)", "25.0 (25.0)", "passed"],
                      computed)
        self.assertIn(["128, large mesh", "384", "128", "0", "2", "16", "16", "16", "2", "4", "12.5", "passed"], computed)
        profiled = computed[-2:]
        self.assertEqual(["gas::FluxFunctor", "sm_90", "128", "168", "0", "3", "4", "2.88", "18.8", "registers", "failed"], profiled[0])
        self.assertEqual("gas::StepFunctor", profiled[1][0])
        self.assertIn("1 of 2 profiled kernels are predicted to the block", page.words)
        self.assertIn("The fused step of drogue-gas on sm_86", page.words)
        self.assertIn("The kernels ran on a GPU of architecture sm_90; the processor", page.words)

    def test_states_the_source_of_printed_numbers(self):
        page = Page(self.report(records.occupancy()))
        self.assertIn("[Shi]: Qiangqiang Shi, Modeling of Parachute Dynamics", page.words)

    def test_names_the_device_of_profiled_kernels(self):
        lines = records.occupancy()
        for line in lines:
            if "kernel" in line["facts"]:
                line["facts"]["device"] = "NVIDIA H100 PCIe"
        self.assertIn("The kernels ran on NVIDIA H100 PCIe (sm_90); the processor", Page(self.report(lines)).words)

    def test_profiles_with_a_contradiction_are_not_folded(self):
        *rest, passed, failed = records.occupancy()
        many = [passed | {"case": f"{passed['case']}/{number}"} for number in range(41)]
        self.assertIn("<summary>Profiled kernels (41 rows)</summary>", self.report([*rest, *many]))
        self.assertNotIn("<summary>", self.report([*rest, *many, failed]))

    def test_memory_of_solvers_is_no_time(self):
        page = Page(self.report(records.flow_solvers()))
        samples = [row[0] for rows in page.tables.values() for row in rows if row[0].startswith("flow-")]
        self.assertTrue(any(case.startswith("flow-pressure/") for case in samples))
        self.assertFalse(any(case.startswith("flow-memory/") for case in samples))

    def test_names_records_without_samples(self):
        empty = records.step("cuda/2048", None, records.H200, 2048, samples=[], interval=None)
        page = Page(self.report([*records.steps_of_h200(), empty]))
        self.assertIn("1 record is left out for having no samples: gas-step/cuda/2048 on NVIDIA H200", page.words)

    def test_strip_draws_every_sample(self):
        from plot.evidence import report

        text = report.strip((1.0, 1.0, 1.0, 9.0))
        self.assertEqual(["90.0", "90.0", "90.0", "177.0"], re.findall(r"M([\d.]+) 8h0", text))
        self.assertIn('aria-label="4 samples from 1 s to 9 s"', text)

    def test_refuses_a_folder_without_records(self):
        code, _, sentence = plot(self.folder, "--report")
        self.assertEqual(2, code)
        self.assertIn("holds no records", sentence)
