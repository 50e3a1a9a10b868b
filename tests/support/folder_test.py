"""A test case with an empty folder of its own."""

import csv
import json
import pathlib
import tempfile
import unittest


class FolderTest(unittest.TestCase):
    """Test case with an empty `folder`, which goes with it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def table(self, name):
        """Rows of a CSV file by the names of its columns."""
        with (self.folder / name).open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def document(self, name):
        """Content of a JSON file."""
        return json.loads((self.folder / name).read_text(encoding="utf-8"))
