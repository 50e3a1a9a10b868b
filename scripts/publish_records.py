#!/usr/bin/env python3
"""Copies what scripts/bench.sh measured into docs/evidence, and renews what is made of the records there.

    scripts/publish_records.py FOLDER MACHINE [--bin build/host/bin]

FOLDER: that of bench.sh, here or brought from the machine; its files NAME.txt begin with the command of NAME.jsonl. Copies
NAME.jsonl to docs/evidence/NAME-MACHINE.jsonl and the page to report-MACHINE.html; writes their rows in docs/evidence/README.md
(one of the same name is replaced); starts the scripts that write tables, and drogue-plot of --bin. Does nothing if a record
failed its check.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
GENERATORS = ("readme_tables.py", "lesson_tables.py", "transfer_tables.py")


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


def copy_records(folder, machine, evidence):
    """Copies all records; those of options alone into one file, in the order of their numbers."""
    joined = {}
    for path in sorted(folder.rglob("*.jsonl"), key=lambda path: (len(path.name), path.name)):
        text = path.read_text(encoding="utf-8")
        record = json.loads(text.partition("\n")[0])
        name = path.relative_to(folder).with_suffix("").as_posix()
        file = published_name(name, record.get("facts", {}).get("backend", ""), machine)
        joined[file] = joined.get(file, "") + text
    for file, text in joined.items():
        (evidence / file).parent.mkdir(exist_ok=True)
        (evidence / file).write_text(text, encoding="utf-8")


def publish(folder, machine, programs):
    """Copies, rows, tables and pages. Stops the script with a sentence before it changes anything if the folder is incomplete."""
    evidence, plot = ROOT / "docs/evidence", programs / "drogue-plot"
    failed = sorted(path.name.removesuffix(".jsonl.failed") for path in folder.rglob("*.jsonl.failed"))
    if failed:
        sys.exit(f"nothing is published: a row of {', '.join(failed)} failed its check")
    if not any(folder.rglob("*.jsonl")):
        sys.exit(f"{folder} holds no records of scripts/bench.sh")
    if not plot.exists():
        sys.exit(f"there is no {plot}: build it, or name the folder of another by --bin")
    found = rows(folder, machine)
    subprocess.run([plot, folder, "--report", "--quiet"], check=True)
    copy_records(folder, machine, evidence)
    shutil.copy(folder / "report.html", evidence / f"report-{machine}.html")
    page = evidence / "README.md"
    page.write_text(renewed(page.read_text(encoding="utf-8"), found), encoding="utf-8")
    for script in GENERATORS:
        subprocess.run([ROOT / "scripts" / script], check=True)
    subprocess.run([plot, evidence, "--quiet"], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("machine", metavar="MACHINE", help="part of the names of files, such as h200")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/host/bin")
    options = parser.parse_args()
    if not re.fullmatch("[a-z0-9-]+", options.machine):
        parser.error(f"the machine '{options.machine}' is part of names of files: use a-z, 0-9 and -")
    publish(options.folder, options.machine, options.bin)


if __name__ == "__main__":
    main()
