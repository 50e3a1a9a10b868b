"""Markers in test sources that give test cases ctest labels: cmake/test_properties.cmake reads them."""

import re

LABELS = ("no-sanitizer", "exact", "smoke")
CASE = re.compile(r"(?:TYPED_)?TEST(?:_F|_P)?\(")


def misplaced(path, text):
    """Sentences, one per marker of a test source that names no label of LABELS or belongs to no test case."""
    python = path.endswith(".py")
    lines = text.split("\n")
    head = next((number for number, line in enumerate(lines) if re.match(r'"""|import |from ' if python else r"#include", line)), 0)
    found = []
    for number, line in enumerate(lines):
        if not re.match(r"\s*(?://|#)\s*ctest-label", line):
            continue
        match = re.fullmatch(("#" if python else "//") + r" ctest-label: ([a-z-]+(?: [a-z-]+)*)", line)
        place = f"{path}:{number + 1}"
        if not match:
            found.append(f"{place} is not of the form `ctest-label: NAME...` from the first column on")
            continue
        found += [f"{place} has the label {name}, not one of {', '.join(LABELS)}"
                  for name in match.group(1).split() if name not in LABELS]
        before_case = not python and number + 1 < len(lines) and CASE.match(lines[number + 1])
        if number >= head:
            if not before_case:
                found.append(f"{place} belongs to no test: it stands neither before the first include nor in front of a TEST")
        elif not python and not re.search(rf"^{CASE.pattern}", text, re.MULTILINE):
            found.append(f"{place} belongs to no test: the source has none")
    return found
