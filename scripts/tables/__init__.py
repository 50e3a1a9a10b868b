"""Tables of documents, from the records in docs/evidence."""

import sys

from . import lessons, readme, results, transfers
from .forms import ROOT

PAGES = {"README.md": readme.renewed, "docs/results.md": results.page, "docs/transfers.md": transfers.page,
         "docs/transfers-tables.md": transfers.rows_page, "docs/lessons/tables.md": lessons.page}


def renew(check=False):
    """Writes all pages; with `check` none, but stops the script if one differs from its records."""
    for name, page in PAGES.items():
        old = (ROOT / name).read_text(encoding="utf-8")
        new = page(old) if page is readme.renewed else page()
        if check and new != old:
            sys.exit(f"{name} differs from its records: run scripts/publish_records.py --tables")
        (ROOT / name).write_text(new, encoding="utf-8")
