"""Tables of documents, from the records in docs/evidence."""

import sys

from . import benchmark, lessons, readme, results, transfers
from .forms import ROOT

# Of pages with marks the text between them is made, of others all.
MARKED = {"README.md": readme.renewed, "docs/benchmark.md": benchmark.renewed}
PAGES = {"docs/results.md": results.page, "docs/transfers.md": transfers.page, "docs/transfers-tables.md": transfers.rows_page,
         "docs/lessons/tables.md": lessons.page}


def renew(check=False):
    """Writes all pages; with `check` none, but stops the script if one differs from its records."""
    for name, page in {**MARKED, **PAGES}.items():
        old = (ROOT / name).read_text(encoding="utf-8")
        new = page(old) if name in MARKED else page()
        if check and new != old:
            sys.exit(f"{name} differs from its records: run scripts/publish_records.py --tables")
        (ROOT / name).write_text(new, encoding="utf-8")
