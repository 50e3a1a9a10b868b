"""Helpers that make pages of synthetic records by drogue-plot and parse them."""

from html.parser import HTMLParser

import synthetic_records as records
from drawn import PictureTest, plot
from plot.evidence.records import read_records


class Page(HTMLParser):
    """Parsed page: rows of the tables by (machine, section), text, and addresses of the images."""

    def __init__(self, text):
        super().__init__()
        self.tables, self.words, self.sources = {}, "", []
        self._heading, self._names, self._row, self._in_style = "", {"h2": "", "h3": ""}, None, False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self._in_style = tag == "style"
        if tag in self._names:
            self._heading, self._names[tag] = tag, ""
        elif tag == "tr":
            self._row = []
        elif tag in ("td", "th"):
            self._row.append("")
        elif tag == "img":
            self.sources.append(dict(attributes)["src"])

    def handle_endtag(self, tag):
        if tag == self._heading:
            self._heading = ""
            if tag == "h3":
                self.tables[self._names["h2"], self._names["h3"]] = []
        elif tag == "tr":
            self.tables[self._names["h2"], self._names["h3"]].append([cell.strip() for cell in self._row])
            self._row = None

    def handle_data(self, data):
        if self._heading:
            self._names[self._heading] += data
        if self._row:
            self._row[-1] += data
        if not self._in_style:
            self.words += data


class Folder(PictureTest):
    """Test case with a temporary folder of records."""

    def page(self, lines, app="gas"):
        """Parsed page of a mini-app, and names of the written files."""
        records.write(self.folder / "a.jsonl", lines)
        code, files, sentence = plot(self.folder, "--dpi", 60)
        self.assertEqual((code, sentence), (0, ""))
        return Page((self.folder / f"{app}.html").read_text()), files

    def evidence(self, lines):
        records.write(self.folder / "a.jsonl", lines)
        return read_records(self.folder)
