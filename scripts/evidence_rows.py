#!/usr/bin/env python3
"""Writes the rows of docs/evidence/README.md on the records that scripts/bench.sh --publish MACHINE copied there.

    scripts/evidence_rows.py FOLDER MACHINE [README]

FOLDER: that of bench.sh, whose files NAME.txt begin with the command of NAME.jsonl. A row of a file of the same name is
replaced; new ones stand at the end of the table.
"""

import json
import pathlib
import re
import sys

PAGE = pathlib.Path(__file__).resolve().parent.parent / "docs/evidence/README.md"


def published_name(name, backend, machine):
    """Name of a record NAME of bench.sh in docs/evidence."""
    if name.startswith("ladder-"):
        return f"ladders/{name.removeprefix('ladder-')}-{backend}-{machine}.jsonl"
    return f"alone/options-{machine}.jsonl" if name.startswith("alone/") else f"{name}-{machine}.jsonl"


def row(file, command, record):
    """Line of the table on a file, whose first record is `record`."""
    here = record["provenance"]
    name = re.sub(r"\((R|TM)\)", "", here["gpu"] or here["cpu"]) or "unknown processor"
    machine = f"one {name}, CUDA {here['driver']}" if here["gpu"] else f"{here['threads']} threads of an {name}"
    command = f"{command} --out {pathlib.Path(file).name}".replace("|", r"\|")
    return f"| `{file}` | `{command}` | {machine}, {here['date'][:10]}, commit {here['git']} |"


def rows(folder, machine):
    """Lines by file of docs/evidence; batches of options alone share one file, and one line."""
    found = {}
    for path in sorted(folder.rglob("*.jsonl")):
        name = path.relative_to(folder).with_suffix("").as_posix()
        record = json.loads(path.read_text(encoding="utf-8").partition("\n")[0])
        command = path.with_suffix(".txt").read_text(encoding="utf-8").partition("\n")[0].strip()
        if name.startswith("alone/"):
            command = command.replace(f"/{name.rpartition('-')[2]}/", "/N/") + ", one run per N,"
        file = published_name(name, record.get("facts", {}).get("backend", ""), machine)
        found.setdefault(file, row(file, command, record))
    return found


def renewed(text, lines):
    """The text of the page with the lines in its first table."""
    kept = text.split("\n")
    last = next(n for n in range(len(kept)) if kept[n].startswith("|---"))
    while last + 1 < len(kept) and kept[last + 1].startswith("|"):
        last += 1
        file = re.match(r"\| `([^`]+)` \|", kept[last])
        if file and file[1] in lines:
            kept[last] = lines.pop(file[1])
    return "\n".join(kept[: last + 1] + list(lines.values()) + kept[last + 1 :])


def main(words):
    if len(words) not in (2, 3):
        sys.exit(__doc__)
    page = pathlib.Path(words[2]) if len(words) == 3 else PAGE
    page.write_text(renewed(page.read_text(encoding="utf-8"), rows(pathlib.Path(words[0]), words[1])), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
