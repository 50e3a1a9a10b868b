#!/usr/bin/env python3
"""Copies what scripts/bench.sh measured into docs/evidence, and renews the tables that documents make of the records there.

    scripts/publish_records.py FOLDER MACHINE [--bin build/host/bin]
    scripts/publish_records.py --tables [--check]    the tables alone; --check: writes nothing, exit code 1 if one differs

FOLDER: that of bench.sh, here or brought from the machine; its files NAME.txt begin with the command of NAME.jsonl. Copies
NAME.jsonl to docs/evidence/NAME-MACHINE.jsonl; writes their rows in docs/evidence/README.md (one of the same name is replaced);
writes the tables of README.md, docs/results.md, docs/transfers.md, docs/transfers-tables.md and docs/lessons/tables.md, and with
drogue-plot of --bin the pictures of ladders. Older records of the same cases in other files of MACHINE go, with the rows of files that
hold no other; files that documents, code or tests quote stay. Does nothing if a record failed its check, or was made with --quick.
"""

import argparse
import pathlib
import re
import shlex
import subprocess
import sys

import tables
from plot.evidence.perf_record import read_file
from plot.failure import Failure

ROOT = pathlib.Path(__file__).resolve().parent.parent


def published_name(name, backend, machine):
    """Name of a record NAME of bench.sh in docs/evidence."""
    if name.startswith("ladder-"):
        return f"ladders/{name.removeprefix('ladder-')}-{backend}-{machine}.jsonl"
    return f"alone/options-{machine}.jsonl" if name.startswith("alone/") else f"{name}-{machine}.jsonl"


def row(file, command, record):
    """Line of the table on a file, whose first record is `record`."""
    here, name = record.provenance, record.device(bool(record.machine.gpu))
    if record.machine.gpu:
        machine = f"one {name}, CUDA {here['driver']}"
    else:
        article = "an" if name[0] in "AEIOUaeiou" else "a"
        machine = f"{'one thread' if record.threads == 1 else str(record.threads) + ' threads'} of {article} {name}"
    out, per = pathlib.Path(file).name, ""
    if file.startswith("alone/"):
        out, per = "options-N.jsonl", ", one run per N"
    command = f"{command} --out {out}".replace("|", r"\|")
    return f"| `{file}` | `{command}`{per} | {machine}, {record.run_id[0][:10]}, commit {here['git']} |"


def rows(folder, machine):
    """Lines by file of docs/evidence; batches of options alone share one file, and one line."""
    found = {}
    for path in sorted(folder.rglob("*.jsonl")):
        name = path.relative_to(folder).with_suffix("").as_posix()
        record = read_file(path)[0]
        command = path.with_suffix(".txt").read_text(encoding="utf-8").partition("\n")[0].strip()
        if name.startswith("alone/"):
            command = command.replace(f"/{name.rpartition('-')[2]}/", "/N/")
        file = published_name(name, record.facts.get("backend", ""), machine)
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


def unlisted(evidence):
    """Names in the first table of the list of files that match no file, and files but pages and their pictures that it does not name."""
    lines = (evidence / "README.md").read_text(encoding="utf-8").split("\n")
    table = lines[next(n for n, line in enumerate(lines) if line.startswith("|---")) + 1 :]
    table = table[: next((n for n, line in enumerate(table) if not line.startswith("|")), len(table))]
    names = [name for line in table for name in re.findall("`([^`]+)`", line.split("|")[1])]
    made = {"README.md", *(path.name for path in evidence.glob("*.png"))}
    files = {path.relative_to(evidence).as_posix() for path in evidence.rglob("*") if path.is_file() and path.suffix != ".html"} - made
    matched = {name: {path.relative_to(evidence).as_posix() for path in evidence.glob(name)} for name in names}
    return sorted(name for name in names if not matched[name]), sorted(files.difference(*matched.values()))


def without_rows(text, files):
    """The text of the page without the rows of the files in its first table."""
    return "".join(line for line in text.splitlines(keepends=True)
                   if not ((file := re.match(r"\| `([^`]+)` \|", line)) and file[1] in files))


def identity(record):
    """Case and machine of a record."""
    return record.case, record.machine


def quoting(evidence, file):
    """Documents, code and tests outside of `evidence` that name a file of it."""
    name = "(^|[^A-Za-z0-9_-])" + re.escape(file.name)
    # Without an index, so that it serves an archive of the sources too.
    search = ["git", "grep", "--no-index", "--exclude-standard", "-lIE", "-e", name, "--", ".", ":!docs/evidence"]
    found = subprocess.run(search, cwd=evidence.parent.parent, capture_output=True, text=True, check=False)
    if found.returncode > 1:
        sys.exit(f"cannot search for the files that quote {file.name}: {found.stderr.strip()}")
    return found.stdout.splitlines()


def remove_older(evidence, published, machine):
    """Removes records that the published files replace from other files of the machine that nothing quotes.

    Returns the names of the files that held no other records, which it deletes. Prints what goes and what stays.
    """
    newest = {}
    for name in published:
        newest |= {identity(record): record.run_id[0] for record in read_file(evidence / name)}
    emptied = []
    for file in sorted(evidence.glob(f"*-{machine}.jsonl")):
        if file.name in published:
            continue
        lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
        kept = [line for line, record in zip(lines, read_file(file), strict=True) if record.run_id[0] >= newest.get(identity(record), "")]
        if len(kept) == len(lines):
            continue
        if pages := quoting(evidence, file):
            print(f"{file.name} stays with {len(lines) - len(kept)} older records: it is quoted by {', '.join(pages)}")
        elif kept:
            file.write_text("".join(kept), encoding="utf-8")
            print(f"{file.name}: {len(lines) - len(kept)} older records are removed")
        else:
            file.unlink()
            emptied.append(file.name)
            print(f"{file.name} is deleted: newer records replace all of it")
    return emptied


def quick_records(folder):
    """Names of the records that were made with --quick, by their commands."""
    commands = {path: path.read_text(encoding="utf-8").partition("\n")[0] for path in folder.rglob("*.txt")}
    return sorted(path.stem for path, command in commands.items()
                  if path.with_suffix(".jsonl").exists() and "--quick" in shlex.split(command))


def copy_records(folder, machine, evidence):
    """Copies all records; those of options alone into one file, in the order of their numbers."""
    joined, cases = {}, {}
    for path in sorted(folder.rglob("*.jsonl"), key=lambda path: (len(path.name), path.name)):
        records = read_file(path)
        name = path.relative_to(folder).with_suffix("").as_posix()
        file = published_name(name, records[0].facts.get("backend", ""), machine)
        joined[file] = joined.get(file, "") + path.read_text(encoding="utf-8")
        cases.setdefault(file, set()).update(record.case for record in records)
    for file, text in joined.items():
        (evidence / file).parent.mkdir(exist_ok=True)
        if (evidence / file).exists() and (lost := {record.case for record in read_file(evidence / file)} - cases[file]):
            print(f"{file} had {len(lost)} other cases, such as {min(lost)}: the new records replace them too")
        (evidence / file).write_text(text, encoding="utf-8")


def publish(folder, machine, programs):
    """Copies, rows, tables and pages. Stops the script with a sentence before it changes anything if the folder is incomplete."""
    evidence, plot = ROOT / "docs/evidence", programs / "drogue-plot"
    failed = sorted(path.name.removesuffix(".jsonl.failed") for path in folder.rglob("*.jsonl.failed"))
    if failed:
        sys.exit(f"nothing is published: a row of {', '.join(failed)} failed its check")
    if quick := quick_records(folder):
        sys.exit(f"nothing is published: {', '.join(quick)} was made with --quick, whose few samples are no evidence")
    if not any(folder.rglob("*.jsonl")):
        sys.exit(f"{folder} holds no records of scripts/bench.sh")
    if not plot.exists():
        sys.exit(f"there is no {plot}: build it, or name the folder of another by --bin")
    # It refuses what is no record with file and line.
    if subprocess.run([plot, folder, "--report", "--quiet"], check=False).returncode != 0:
        sys.exit("nothing is published: no page can be made of the records, for the reason above")
    found = rows(folder, machine)
    published = list(found)
    copy_records(folder, machine, evidence)
    page = evidence / "README.md"
    page.write_text(renewed(page.read_text(encoding="utf-8"), found), encoding="utf-8")
    # Tables of lessons show its pictures.
    if any((evidence / "ladders").glob("*.jsonl")):
        subprocess.run([plot, evidence / "ladders", "--quiet"], check=True)
    tables.renew()
    # After the documents refer to the newest records.
    emptied = remove_older(evidence, published, machine)
    page.write_text(without_rows(page.read_text(encoding="utf-8"), emptied), encoding="utf-8")
    missing, unnamed = unlisted(evidence)
    if missing or unnamed:
        sys.exit(f"{page} has rows without a file ({', '.join(missing) or 'none'}), or files have no row ({', '.join(unnamed) or 'none'}): "
                 "mend its list")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=pathlib.Path, help="records of scripts/bench.sh, here or brought from the machine")
    parser.add_argument("machine", metavar="MACHINE", nargs="?", help="part of the names of files, such as h200")
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/host/bin",
                        help="folder of drogue-plot, which makes the pages (default: build/host/bin)")
    parser.add_argument("--tables", action="store_true", help="renew the tables alone")
    parser.add_argument("--check", action="store_true", help="with --tables: write nothing, and fail if a table differs")
    options = parser.parse_args()
    if (options.folder if options.tables else options.check or not options.machine):
        parser.error("give FOLDER and MACHINE, or --tables")
    if options.machine and not re.fullmatch("[a-z0-9-]+", options.machine):
        parser.error(f"the machine '{options.machine}' is part of names of files: use a-z, 0-9 and -")
    try:
        tables.renew(options.check) if options.tables else publish(options.folder, options.machine, options.bin)
    except Failure as failure:
        sys.exit(str(failure))


if __name__ == "__main__":
    main()
