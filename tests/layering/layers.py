"""Include rules of the layers: the table of the architecture, and the code that reads the includes."""

import re
from dataclasses import dataclass
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)
SOURCES = (".hpp", ".cpp", ".h", ".cuh", ".cu")


@dataclass(frozen=True)
class Layer:
    """Files below `place` may include own files below `own` and libraries that match no pattern of `never`."""

    place: str
    own: tuple
    never: tuple


KOKKOS = r"Kokkos|KokkosBatched|KokkosBlas"
FRONT_END = r"toml\+\+|CLI/|nlohmann/|muParser"
FILES = r"fstream$|filesystem$|hdf5"
MPI = r"mpi\.h"

# Names of options, without a line of arithmetic: the oracle and what it checks mean the same scheme by them.
SHARED = re.compile(r"kernels/([a-z]+/parameters|fabric/(material|body))\.hpp$")

# The first layer whose place fits decides.
LAYERS = (
    Layer("common/", ("common/",), (KOKKOS, r"cuda")),
    Layer("kernels/reference/", ("kernels/reference/",), (KOKKOS, r"cuda", FRONT_END, FILES, MPI)),
    # Communication of ranks stands behind one class; hypre needs its communicator.
    Layer("kernels/linear/parallel/", ("kernels/linear/parallel/",), (KOKKOS, FRONT_END, FILES)),
    Layer("kernels/linear/poisson/hypre", ("kernels/",), (FRONT_END, FILES)),
    Layer("kernels/", ("kernels/",), (FRONT_END, FILES, MPI)),
    Layer("miniapps/framework/", ("miniapps/framework/", "kernels/device/", "kernels/mesh/", "common/"), (KOKKOS, r"cuda", FRONT_END)),
    Layer("perf/", ("perf/", "kernels/", "common/", "miniapps/"), ()),
)


def without_folder(files):
    """Places of LAYERS that none of the files lies below: an entry without a folder checks nothing."""
    return [layer.place for layer in LAYERS if not any(file.startswith(layer.place) for file in files)]


def layer_of(path):
    """The layer of a file, given relative to the repository; None where no rule applies."""
    for layer in LAYERS:
        if path.startswith(layer.place):
            return layer
    parts = path.split("/")
    if parts[0] == "miniapps" and len(parts) > 2:
        app = f"miniapps/{parts[1]}/"
        return Layer(app, (app, "miniapps/framework/", "kernels/", "common/"), (KOKKOS, r"cuda"))
    return None


def includes(text):
    """Pairs (is_own, name) of every include of a source text."""
    return [(quote == '"', name) for quote, name in INCLUDE.findall(text)]


def own_header_comes_late(path, text, files):
    """True if a source with a header of its own name includes another file first."""
    header = path.removesuffix(".cpp") + ".hpp"
    return path.endswith(".cpp") and header in files and includes(text)[:1] != [(True, header)]


def violations(path, text):
    """Sentences, one per include of the file that its layer forbids."""
    layer = layer_of(path)
    if layer is None:
        return []
    found = []
    for own, name in includes(text):
        if own and layer.place == "kernels/reference/" and SHARED.match(name):
            continue
        if own and not name.startswith(layer.own):
            found.append(f"{path} includes {name}: {layer.place} may only use {', '.join(layer.own)}")
        elif own and layer.place == "kernels/" and name.startswith("kernels/reference/"):
            found.append(f"{path} includes {name}: the reference stays independent of what it checks")
        elif own and layer.place == "perf/" and name.endswith("/main.hpp"):
            found.append(f"{path} includes {name}: an app's main is no library")
        elif not own and any(re.match(pattern, name) for pattern in layer.never):
            found.append(f"{path} includes <{name}>: {layer.place} does without it")
    return found


def source_files(root):
    """Every C++ source below the layers, relative to `root`, with its text."""
    for top in ("common", "kernels", "miniapps", "perf", "tests"):
        for path in sorted((root / top).rglob("*")):
            if path.is_file() and path.name.endswith(SOURCES):
                yield path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")


def reaches_kokkos(path, texts, seen=None):
    """The chain of includes from `path` to Kokkos, empty if there is none. `texts`: all sources by name."""
    seen = set() if seen is None else seen
    seen.add(path)
    for own, name in includes(texts.get(path, "")):
        if not own and re.match(KOKKOS, name):
            return [path, f"<{name}>"]
        if own and name not in seen:
            rest = reaches_kokkos(name, texts, seen)
            if rest:
                return [path, *rest]
    return []


def uses_kokkos_unseen(path, texts):
    """Whether the file names what is Kokkos's without an include that leads there: headers compiled before would hide it."""
    code = re.sub(r'//.*|"[^"\n]*"', "", texts[path])
    for declared in re.findall(r"^class (\w+);$", "".join(re.findall(r"^namespace Kokkos \{$[^}]*", code, re.M)), re.M):
        code = re.sub(rf"\bKokkos::{declared}\b", "", code)
    return bool(re.search(r"\bKokkos::|\bKOKKOS_[A-Z]", code)) and not reaches_kokkos(path, texts)


# Folders of kernels in CUDA: the launcher that Kokkos lacks, and what measures its cost.
RAW_CUDA = ("kernels/device/", "perf/raw/")


def is_misplaced_cuda(path, text):
    """True for a source outside of RAW_CUDA that defines or launches a CUDA kernel of its own."""
    code = re.sub(r'//.*|"[^"\n]*"', "", text)
    return bool(path.endswith((".cu", ".cuh")) or re.search(r"__global__|<<<", code)) and not path.startswith(RAW_CUDA)


def repository(environment):
    """The repository root: DROGUE_SOURCE, or two folders up."""
    return Path(environment.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
