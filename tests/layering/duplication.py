"""Finds runs of equal lines in two mini-apps."""

import re

LENGTH = 12  # lines that count as a copy
TRIVIAL = re.compile(r"[\s{}()\[\];,]*(?://.*)?$|\s*#\s*(?:include|pragma)|.*\bnamespace\b|.*\boverride\b[^{]*;$|\s*break;$")


def lines_of(text):
    """Pairs (line number, line without indentation) of the lines that hold code of their own."""
    return [(number, line.strip()) for number, line in enumerate(text.splitlines(), 1) if not TRIVIAL.match(line)]


def app_of(path):
    """The mini-app of a source file; None for files elsewhere and for the shared framework."""
    parts = path.split("/")
    return parts[1] if len(parts) > 2 and parts[0] == "miniapps" and parts[1] != "framework" else None


def copies(texts):
    """Sentences, one per pair of files of two mini-apps that share LENGTH consecutive lines. `texts`: sources by path."""
    seen, found = {}, {}
    for path, text in texts.items():
        if app_of(path) is None:
            continue
        lines = lines_of(text)
        for start in range(len(lines) - LENGTH + 1):
            block = tuple(line for _, line in lines[start:start + LENGTH])
            other, number = seen.setdefault(block, (path, lines[start][0]))
            if app_of(other) != app_of(path):
                found.setdefault((other, path), f"{path}:{lines[start][0]} repeats {other}:{number}")
    return sorted(found.values())
