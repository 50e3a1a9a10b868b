"""Records, numbers and paragraphs as the tables of documents show them."""

import pathlib
import re
import statistics
import sys
import textwrap

from plot.evidence.perf_record import read_file

ROOT = pathlib.Path(__file__).resolve().parents[2]
EVIDENCE = ROOT / "docs/evidence"
MARK = re.compile(r"(<!-- table: ([\w-]+) -->\n).*?(<!-- end -->\n)", re.DOTALL)  # around a table of a page


def passed(file):
    """Records of a file; stops the script if one failed its check."""
    records = read_file(file)
    for record in records:
        if record.check != "passed":
            sys.exit(f"{file}: {record.case} failed its check")
    return records


def time_of(record, unit):
    """Median in `unit` (1e3: ms) with three digits and no exponent."""
    value = unit * statistics.median(record.samples)
    return f"{value:.0f}" if value >= 100 else f"{value:#.3g}".rstrip(".")


def error_of(record, digits=2):
    """Error with some digits; two with an exponent below 0.1, so that tables show the order."""
    value = record.error
    return re.sub(r"e-0*", "e-", f"{value:.{digits - 1}e}") if digits == 2 and value < 0.1 else f"{value:.{digits}g}"


def table(heading, rows, left=()):
    """Lines of a table whose columns are numbers, but for those with the indices `left`."""
    rule = "|" + "".join("---|" if k in left else "---:|" for k in range(len(heading)))
    return ["| " + " | ".join(heading) + " |", rule, *("|" + "|".join(f" {cell} " if cell else " " for cell in row) + "|" for row in rows)]


def wrapped(lines):
    """Text of lines; prose before and after a table or heading is one paragraph of at most 120 columns, with whole commands."""
    found, prose, space = [], [], "\0"
    for line in [*lines, ""]:
        if line and not line.startswith(("|", "#")):
            prose.append(line)
            continue
        if prose:
            text = re.sub(r"`[^`]*`", lambda code: code[0].replace(" ", space), " ".join(prose))
            found += [line.replace(space, " ") for line in textwrap.wrap(text, 120, break_long_words=False, break_on_hyphens=False)]
            prose = []
        found.append(line)
    return "\n".join(found[:-1]) + "\n"
