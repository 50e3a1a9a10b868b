#!/usr/bin/env python3
"""Writes docs/kernel-use.md, a table of the kernels that each program uses, from the includes.

    scripts/kernel_use.py [--check]      --check changes nothing and fails where the page is out of date

A program uses a header that it includes, and every header behind that. A source of kernels/ belongs to the headers in use
that it implements: to its own header; in a folder instances/ to the files of its area that name a template which it
instantiates.
"""

import argparse
import re
import sys
from collections import deque
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/kernel-use.md"
INSTANTIATED = re.compile(r"^template\s+(?:class\s+(\w+)|[^;]*?\b(\w+)(?:<[\w:]+>)?\()", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
HEAD = """# Kernels by program

Made by `scripts/kernel_use.py` from the includes; a test fails if it is out of date. ●: the program includes headers of
the folder. ○: headers or sources that the program uses include them. `perf` is `drogue-perf`.
"""


def read_sources(root):
    """Own includes of every C++ source of the layers, by path from the root."""
    found = {}
    for top in ("common", "kernels", "miniapps", "perf"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".hpp", ".cpp"):
                found[path.relative_to(root).as_posix()] = INCLUDE.findall(path.read_text(encoding="utf-8"))
    return found


def read_users(root, includes):
    """Files of its area that name a template which it instantiates, by path of a source in a folder instances/."""
    texts = {path: (root / path).read_text(encoding="utf-8") for path in includes if path.startswith("kernels/")}
    found = {}
    for instance in filter(is_instance, texts):
        names = {first or second for first, second in INSTANTIATED.findall(texts[instance])}
        pattern = re.compile(rf"\b(?:{'|'.join(sorted(names))})\b")
        found[instance] = {path for path, text in texts.items()
                           if not is_instance(path) and area_of(path) == area_of(instance) and pattern.search(text)}
    return found


def is_instance(path):
    return path.startswith("kernels/") and "/instances/" in path


def folder_of(path):
    """The folder of a file of kernels/; of explicit instantiations that which holds instances/."""
    return path.rpartition("/")[0].removesuffix("/instances")


def reachable(start, includes):
    """Files that a set of files includes, with the headers behind them."""
    seen, waiting = set(start), deque(start)
    while waiting:
        for name in includes.get(waiting.popleft(), ()):
            if name in includes and name not in seen:
                seen.add(name)
                waiting.append(name)
    return seen


def area_of(path):
    return path.split("/")[1]


def used_by(start, includes, users):
    """All files behind `start`, with the sources of kernels/ and of the framework that implement headers in use.

    `users`: result of `read_users`.
    """
    sources = [path for path in includes if path.endswith(".cpp") and path.startswith(("kernels/", "miniapps/framework/", "common/"))]
    behind = {path: reachable([path], includes) for path in sources}
    used = reachable(start, includes)
    while True:
        added = set()
        for path in sources:
            if path in used:
                continue
            header = path.removesuffix(".cpp") + ".hpp"
            if header in used or not used.isdisjoint(users.get(path, ())):
                added |= behind[path]
        if added <= used:
            return used
        used |= added


def programs(includes):
    """Sources by program: the folders of miniapps/ that have a main, and perf."""
    found = {}
    for path in includes:
        parts = path.split("/")
        if parts[0] == "miniapps" and f"miniapps/{parts[1]}/main.cpp" in includes:
            found.setdefault(parts[1], []).append(path)
        elif parts[0] == "perf":
            found.setdefault("perf", []).append(path)
    return found


def page(includes, users):
    """The text of the page. `users`: result of `read_users`."""
    apps = programs(includes)
    folders = sorted({folder_of(path) for path in includes if path.startswith("kernels/")})
    own = {app: {name for path in files for name in includes[path] if name.startswith("kernels/")} for app, files in apps.items()}
    used = {app: used_by(files, includes, users) for app, files in apps.items()}
    lines = [HEAD, "| folder | " + " | ".join(apps) + " |", "|---|" + ":-:|" * len(apps)]
    for folder in folders:
        marks = []
        for app in apps:
            direct = any(folder_of(name) == folder for name in own[app])
            behind = any(folder_of(name) == folder for name in used[app] if name.startswith("kernels/"))
            marks.append("●" if direct else "○" if behind else "")
        lines.append(f"| `{folder}` | " + " | ".join(marks) + " |")
    lines += ["", "## Headers that programs include", "| header | " + " | ".join(apps) + " |", "|---|" + ":-:|" * len(apps)]
    for header in sorted(set().union(*own.values())):
        lines.append(f"| `{header}` | " + " | ".join("●" if header in own[app] else "" for app in apps) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--check", action="store_true")
    check = parser.parse_args().check
    includes = read_sources(ROOT)
    text = page(includes, read_users(ROOT, includes))
    if not check:
        PAGE.write_text(text, encoding="utf-8")
    elif not PAGE.exists() or PAGE.read_text(encoding="utf-8") != text:
        sys.exit(f"{PAGE.relative_to(ROOT)} is out of date: run scripts/kernel_use.py.")


if __name__ == "__main__":
    main()
