"""Uses of types of this repository without their header, which sources that are compiled as one hide from the compiler."""

import collections
import re

from layers import includes

DECLARED = re.compile(r"\b(?:class|struct|using|typename|concept)(?:\.\.\.)? ([A-Z]\w+)(?! *;)")
USED = re.compile(r"(?<![.>])(?<!Kokkos::)\b([A-Z]\w+)\b")


def code(text):
    """The text without comments, strings and the names of suites of tests."""
    return re.sub(r'//.*|R"(\w*)\((?s:.*?)\)\1"|"(?:[^"\\\n]|\\.)*"|\b(?:TYPED_)?TEST[_FP]*\(\w+', "", text)


def headers_of_types(texts):
    """Header of each type whose name is declared in one file alone, a header. `texts`: all sources by name."""
    files = collections.defaultdict(set)
    for path, text in texts.items():
        for name in DECLARED.findall(code(text)):
            files[name].add(path)
    return {name: path for name, (path, *others) in files.items() if not others and path.endswith(".hpp")}


def reached(path, texts, seen=None):
    """Own files that a file includes, itself among them."""
    seen = set() if seen is None else seen
    seen.add(path)
    for own, name in includes(texts.get(path, "")):
        if own and name not in seen:
            reached(name, texts, seen)
    return seen


def missing(path, texts, headers):
    """Sentences, one per type that the file uses and whose header it does not reach. `headers`: of all types by name."""
    found = reached(path, texts)
    return [f'{path} uses {name} without "{headers[name]}"' for name in sorted(set(USED.findall(code(texts[path]))) & set(headers))
            if headers[name] not in found]
