"""Lines that two mini-apps hold alike and that belong into miniapps/framework."""

import re

LENGTH = 12


def lines_that_count(text):
    """Pairs (line, code) without blank lines, comments, includes, closing braces, and namespaces."""
    found = []
    for number, line in enumerate(text.split("\n"), 1):
        code = re.sub(r"\s+", " ", re.sub(r"//.*", "", line)).strip()
        if re.search(r"\w", code) and not re.match(r"#|namespace\b|using\b|\}\s*//", code):
            found.append((number, code))
    return found


def app_of(path):
    """The mini-app of a source; None for what all share."""
    parts = path.split("/")
    if parts[0] != "miniapps" or len(parts) < 3 or parts[1] == "framework":
        return None
    return parts[1] if path.endswith((".hpp", ".cpp")) else None


def repeated_lines(texts, length=LENGTH):
    """Sentences, one per run of `length` or more consecutive lines that the sources of two mini-apps hold alike."""
    seen = {}
    sources = {path: lines_that_count(text) for path, text in texts.items() if app_of(path)}
    for path, lines in sources.items():
        for at in range(len(lines) - length + 1):
            block = tuple(code for _, code in lines[at:at + length])
            seen.setdefault(block, []).append((path, at))
    found, covered = [], set()
    for block, places in seen.items():
        for path, at in places[1:]:
            first, start = places[0]
            if app_of(path) == app_of(first) or (path, at - 1, first, start - 1) in covered:
                covered.add((path, at, first, start))
                continue
            covered.add((path, at, first, start))
            found.append(f"{path}:{sources[path][at][0]} repeats {length} lines or more of {first}:{sources[first][start][0]}")
    return found
