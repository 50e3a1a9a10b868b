"""Pages of records in a headless Chromium: silent console, no requests, figures with a text and their data."""

import os
import struct
import unittest
from pathlib import Path

import packages  # noqa: F401, before modules that need the packages  isort: skip
import headless
import synthetic_records as records
from evidence_pages import Folder, plot

# Per figure: its text, whether it is drawn, and whether a table follows in its section, which may have headings below its own.
FIGURES = """
[...document.querySelectorAll("img")].map(image => {
  const level = item => /^H[1-6]$/.test(item.tagName) ? +item.tagName[1] : 9;
  let before = image.previousElementSibling, next = image.nextElementSibling, data = false;
  while (before && level(before) == 9) before = before.previousElementSibling;
  for (; next && level(next) > (before ? level(before) : 1); next = next.nextElementSibling)
    data = data || next.matches("div.wide, details") && !!next.querySelector("td");
  return [image.alt, image.complete && image.naturalWidth > 0, data];
})
"""
# Tables and figures wider than the window scroll in a box of their own.
WIDTH = "[document.documentElement.scrollWidth, window.innerWidth]"
UNNAMED = """[...document.querySelectorAll("a, summary, [role=img]")].filter(
  item => !(item.textContent.trim() || item.getAttribute("aria-label"))).length"""


@unittest.skipUnless(headless.program(), "there is no Chromium: CONTRIBUTING.md names the package")
class Pages(Folder):
    def opened(self, browser, page):
        """Figures of a page, once it has opened without a complaint or a request."""
        browser.open(page)
        self.assertEqual([], browser.complaints(), page.name)
        self.assertEqual([page.resolve().as_uri()], browser.requests(), page.name)
        self.assertLess(page.stat().st_size, 5_000_000, page.name)
        wide, window = browser.evaluate(WIDTH)
        self.assertLessEqual(wide, window, page.name)
        self.assertEqual(0, browser.evaluate(UNNAMED), page.name)
        return browser.evaluate(FIGURES)

    def test_pages_open_in_silence_and_alone(self):
        records.write(self.folder / "a.jsonl", [*records.steps_of_h200(), *records.ceilings(), *records.transfers(),
                                                *records.options_transfers()])
        for words in (["--report"], []):
            self.assertEqual((0, ""), plot(self.folder, "--dpi", 50, *words)[::2])
        with headless.Browser() as browser:
            for name, count in (("report.html", 3), ("gas.html", 2), ("options.html", 1)):
                figures = self.opened(browser, self.folder / name)
                self.assertEqual(count, len(figures), name)
                for text, drawn, data in figures:
                    self.assertTrue(drawn and data and len(text) > 20, (name, text, drawn, data))
            browser.picture(self.folder / "shot.png", x=0, y=0, width=600, height=400, scale=1)
        self.assertEqual((600, 400), struct.unpack(">II", (self.folder / "shot.png").read_bytes()[16:24]))

    def test_finds_complaints_and_requests(self):
        page = Path(self.folder) / "bad.html"
        page.write_text('<img src="missing.png"><script>console.error("no"); undefined_name()</script>')
        with headless.Browser() as browser:
            browser.open(page)
            self.assertTrue(any("undefined_name" in text or "Uncaught" in text for text in browser.complaints()))
            self.assertTrue(any("'no'" in text for text in browser.complaints()))
            self.assertIn("missing.png", "".join(browser.requests()))
            self.assertEqual([["", False, False]], browser.evaluate(FIGURES))

    def test_pages_of_the_records_of_the_documents_open(self):
        self.assertEqual((0, ""), plot(Path(os.environ["DROGUE_SOURCE"]) / "docs/evidence", "--dpi", 50, "--out", self.folder)[::2])
        pages = sorted(self.folder.glob("*.html"))
        self.assertGreaterEqual(len(pages), 4)
        with headless.Browser() as browser:
            for page in pages:
                for text, drawn, data in self.opened(browser, page):
                    self.assertTrue(drawn and data and len(text) > 20, (page.name, text, drawn, data))
