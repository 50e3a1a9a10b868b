"""One page of all records: contents, self-containment, size, headings and names of pictures."""

import re
import unittest
from html.parser import HTMLParser

import packages  # noqa: F401, before modules that need the packages  isort: skip
import synthetic_records as records
from evidence_pages import Folder, Page, plot


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

    def test_strip_draws_every_sample(self):
        from plot.evidence import report

        text = report.strip((1.0, 1.0, 1.0, 9.0))
        self.assertEqual(["90.0", "90.0", "90.0", "177.0"], re.findall(r"M([\d.]+) 8h0", text))
        self.assertIn('aria-label="4 samples from 1 s to 9 s"', text)

    def test_refuses_a_folder_without_records(self):
        code, _, sentence = plot(self.folder, "--report")
        self.assertEqual(2, code)
        self.assertIn("holds no records", sentence)


if __name__ == "__main__":
    unittest.main()
