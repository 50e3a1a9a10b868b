"""Folders that exist and folders that docs/architecture.md names in the table of its section `## Folders`.

The first cell of a row names folders: `kernels/gas`, or several of one parent, `miniapps/gas`, `springs`. After the word
`rooms` the second cell names folders inside: rooms `flux` (WENO), `tile`.
"""

import re

AREAS = ("common", "kernels", "miniapps", "perf", "scripts/plot")
# Folders of the same meaning everywhere: explicit instantiations, shipped inputs.
REPEATED = ("instances", "scenes", "batches")


def existing(files):
    """Folders below AREAS that hold one of `files`, which are paths from the root of the repository."""
    found = set()
    for file in files:
        parts = file.split("/")[:-1]
        if "__pycache__" in parts:
            continue
        for end in range(1, len(parts) + 1):
            folder = "/".join(parts[:end])
            if folder.startswith(AREAS) and folder not in AREAS and not set(parts[:end]) & set(REPEATED):
                found.add(folder)
    return {folder for folder in found if any(folder.startswith(area + "/") for area in AREAS)}


def named(document):
    """Folders below AREAS that the table names; those that are AREAS themselves are left out."""
    section = document.split("\n## Folders\n")[1].split("\n## ")[0]
    found = set()
    for row in re.findall(r"^\|(.*)\|$", section, re.MULTILINE):
        first, _, content = row.partition("|")
        names = [name.rstrip("/") for name in re.findall(r"`([\w./-]+)`", first)]
        if not names:
            continue
        parent = names[0].rpartition("/")[0]
        folders = [names[0], *(name if "/" in name else f"{parent}/{name}" for name in names[1:])]
        found.update(folders)
        if "rooms" in content:
            rooms = re.sub(r"\([^)]*\)", "", content.split("rooms", 1)[1])
            found.update(f"{folders[0]}/{room}" for room in re.findall(r"`([a-z0-9_]+)`", rooms))
    return {folder for folder in found if any(folder.startswith(area + "/") for area in AREAS)}
