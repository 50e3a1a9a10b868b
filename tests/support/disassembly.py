"""Counts the floating-point instructions of compiled x86 kernels by operation, form and register."""

import collections
import json
import pathlib
import platform
import re
import shlex
import subprocess

SYMBOL = re.compile(r"^[0-9a-f]+ <(.*)>:$")
ARITHMETIC = re.compile(r"\s+[0-9a-f]+:\s+v?(add|sub|mul|div|sqrt|rcp14|rsqrt14|fn?m(?:add|sub)\d{3})([ps])d\s+(.*)$")
FUSED = re.compile(r"\bvfn?m(?:add|sub)\w*")
REGISTERS = ("zmm", "ymm", "xmm")


def arithmetic(text, names):
    """Counter of (operation, "p" packed or "s" scalar, widest register) in the symbols that contain one of `names`."""
    counts = collections.Counter()
    inside = False
    for line in text.splitlines():
        symbol = SYMBOL.match(line)
        if symbol:
            inside = any(name in symbol[1] for name in names)
            continue
        found = ARITHMETIC.match(line) if inside else None
        if found:
            operation, form, operands = found.groups()
            register = next(name for name in REGISTERS if "%" + name in operands)
            counts[operation, form, register] += 1
    return counts


def disassembled(objdump, path):
    return subprocess.run([objdump, "--disassemble", "--demangle", "--no-show-raw-insn", path], capture_output=True,
                          text=True, check=True).stdout


def cache(build):
    """CMake cache variables of a build folder."""
    text = (build / "CMakeCache.txt").read_text(encoding="utf-8")
    return dict(re.findall(r"^(\w+):\w+=(.*)$", text, re.MULTILINE))


def reason_to_skip(build):
    """Reason why the machine code of a build folder cannot be read, or None."""
    variables = cache(build)
    if variables.get("DROGUE_SANITIZE") == "ON":
        return "sanitizers put checks between the instructions"
    if variables.get("CMAKE_BUILD_TYPE") == "Debug":
        return "nothing is optimised"
    if platform.machine() != "x86_64":
        return "instructions are read for x86-64 alone"
    return None


def compilation(build, source):
    """Object file and compile command of the source whose path ends in `source`, or of the one that includes it with others. Raises
    LookupError if there is none."""
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        path = entry["file"]
        if path.endswith(source) or ("/united/" in path and source in pathlib.Path(path).read_text(encoding="utf-8")):
            words = shlex.split(entry["command"])
            return pathlib.Path(entry["directory"]) / words[words.index("-o") + 1], words
    raise LookupError(source)


def widest_register(words):
    """Widest vector register of the target of a compile command, by the criterion of kernels/device/pack.hpp."""
    words = words[:words.index("-o")] + ["-dM", "-E", "-x", "c++", "/dev/null"]
    macros = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    for macro, register in (("__AVX512F__", "zmm"), ("__AVX__", "ymm")):
        if f"#define {macro} " in macros:
            return register
    return "xmm"
