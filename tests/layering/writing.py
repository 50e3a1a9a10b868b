"""Rules of writing: openings and verbs of comments, names of tests, widths of prose, replaced names, and contracts of public headers.

From the root of the repository, `python3 -B tests/layering/writing.py [PATH...] [--no-warnings]` lists the breaches.
"""

import ast
import functools
import io
import re
import subprocess
import sys
import tokenize
from pathlib import Path

CODE = (".hpp", ".cpp", ".hpp.in", ".cpp.in", ".cuh", ".cu", ".h")
SKIPPED_FOLDERS = {"build", ".git", "node_modules", "__pycache__"}
RECORDS = Path("docs/evidence")
WIDTH = 120

# ----------------------------------------------------------------------------------------------------- comments

REFUSED_OPENING = re.compile(r"(?:What|Of|That|Those|The same)\b")
REFUSED_ELSEWHERE = re.compile(r"(?:What|Of|That|Those)\b")
SUSPECT_OPENING = re.compile(r"(?:Whether|How|Where|Why|Who|Which|Nothing|None)\b")
# Code does none of this.
PERSONIFYING = r"tells?|told|knows?|hears?|heard|says|said|asks?|asked|wants?|wanted|learns?|learnt|thinks?|believes?"
# `of a few, say 4` is an example and no verb.
PERSONIFIED = re.compile(rf"\b(?:{PERSONIFYING}|(?<=\w )say)\b", re.IGNORECASE)


def doc_comments_of_code(text):
    """Pairs (line, words) of the doc comments of C++ source: `///` blocks, `///<` notes, and `/** */` comments."""
    found, previous = [], None
    lines = text.split("\n")
    for number, line in enumerate(lines, 1):
        note = re.search(r"///<\s?(.*)", line)
        block = re.match(r"\s*///(?!<)\s?(.*)", line)
        if note:
            # A note that goes on in the next line continues there with another `///<` and nothing before it.
            if previous == number - 1 and line.strip().startswith("///<"):
                found[-1][1] += " " + note.group(1)
            else:
                found.append([number, note.group(1)])
            previous = number
        elif block:
            if previous == number - 1:
                found[-1][1] += " " + block.group(1)
            else:
                found.append([number, block.group(1)])
            previous = number
    for match in re.finditer(r"/\*\*(.*?)\*/", text, re.DOTALL):
        found.append([text.count("\n", 0, match.start()) + 1, re.sub(r"\n\s*\*?", " ", match.group(1))])
    return [(number, words.strip().removeprefix("@brief ").removeprefix("\\brief ")) for number, words in found]


def doc_comments_of_python(text):
    """Pairs (line, words) of the docstrings of a Python source."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            words = ast.get_docstring(node)
            if words:
                found.append((node.body[0].lineno, words.replace("\n", " ")))
    return found


def doc_comments(path, text):
    if path.endswith(CODE):
        return doc_comments_of_code(text)
    return doc_comments_of_python(text) if path.endswith(".py") else []


def joined(lines):
    """Pairs (line, words) of comments, whose consecutive lines are one. `lines`: pairs (line, words)."""
    found, previous = [], None
    for number, words in lines:
        if previous == number - 1:
            found[-1][1] += " " + words
        else:
            found.append([number, words])
        previous = number
    return [(number, words.strip()) for number, words in found]


def comments(path, text):
    """Pairs (line, words) of all comments of a source, doc comments among them; those on consecutive lines are one."""
    lines = text.split("\n")
    if path.endswith(CODE):
        split = [(number, without_strings(line).partition("//")) for number, line in enumerate(lines, 1)]
        own = joined((number, words.lstrip("/!<")) for number, (code, _, words) in split if words and not code.strip())
        beside = [(number, words.lstrip("/!< ")) for number, (code, _, words) in split if words and code.strip()]
        blocks = [(text.count("\n", 0, match.start()) + 1, re.sub(r"\n\s*\*?", " ", match.group(1)).strip("* "))
                  for match in re.finditer(r"/\*(.*?)\*/", text, re.DOTALL)]
        return own + beside + blocks
    if path.endswith(".py"):
        tokens = tokenize.generate_tokens(io.StringIO(text).readline)
        return joined((token.start[0], token.string.lstrip("# ")) for token in tokens
                      if token.type == tokenize.COMMENT) + doc_comments_of_python(text)
    if path.endswith((".txt", ".cmake", ".sh")):
        return joined((number, line.lstrip("# ")) for number, line in enumerate(lines, 1) if re.match(r"\s*#", line))
    return []


def refused_openings(path, text):
    """Lines `path:line: ...` for comments that open with What, Of, That or Those, doc comments also with The same."""
    found = {number: words for number, words in comments(path, text) if REFUSED_ELSEWHERE.match(words)}
    found |= {number: words for number, words in doc_comments(path, text) if REFUSED_OPENING.match(words)}
    return [f"{path}:{number}: opens with '{REFUSED_OPENING.match(words).group()}': {words[:70]}"
            for number, words in sorted(found.items())]


def personified(path, text):
    """Lines `path:line: ...` for comments in which code tells, knows, hears, says or asks."""
    found = {}
    for number, words in comments(path, text):
        # Neither code, nor quotations, nor the names of arguments.
        match = PERSONIFIED.search(re.sub(r"`[^`]*`|\"[^\"]*\"|<\w+>|\b[A-Z]{2,}\b", "", words))
        if match:
            found[number] = f"{path}:{number}: '{match.group()}' is no deed of code: {words[:70]}"
    return [found[number] for number in sorted(found)]


def suspect_openings(path, text):
    """Warnings for doc comments whose first word often starts a riddle; fine before a plain statement."""
    return [f"{path}:{number}: warning: opens with '{SUSPECT_OPENING.match(words).group()}': {words[:70]}"
            for number, words in doc_comments(path, text) if SUSPECT_OPENING.match(words)]


# ------------------------------------------------------------------------------------------------------- tests

RIDDLE = re.compile(r"(?:What|Of|That|Those|These|This|An?|The|Which|Who|Whose|How|Where|Whether)(?=[A-Z0-9]|$)")
TOLD = re.compile(rf"(?<=[a-z0-9])(?:{'|'.join(verb.capitalize() for verb in re.findall('[a-z?]+', PERSONIFYING + '|say'))})(?=[A-Z0-9]|$)")


def test_names(path, text):
    """Pairs (line, name) of the test cases of a source; of a Python test the name in PascalCase, without `test_`."""
    if path.endswith(".cpp"):
        pattern, name = r"^(?:TYPED_)?TEST(?:_F|_P)?\(\s*\w+\s*,\s*(\w+)", str
    elif path.endswith(".py"):
        pattern, name = r"^    def test_(\w+)", lambda words: "".join(word[:1].upper() + word[1:] for word in words.split("_"))
    else:
        return []
    return [(text.count("\n", 0, match.start(1)) + 1, name(match.group(1))) for match in re.finditer(pattern, text, re.MULTILINE)]


def riddles(path, text):
    """Lines `path:line: ...` for names of tests that open with an article or a pronoun, or in which code tells or knows."""
    return [f"{path}:{number}: the test {name} does not assert a behaviour: write a verb and its object"
            for number, name in test_names(path, text) if RIDDLE.match(name) or TOLD.search(name)]


# ------------------------------------------------------------------------------------------------------- widths


def wide_lines(path, text):
    """Lines of Markdown prose wider than WIDTH; tables, code blocks, and lines of one link or image may be wider."""
    found, fenced = [], False
    if not path.endswith(".md"):
        return found
    for number, line in enumerate(text.split("\n"), 1):
        if re.match(r"\s*(```|~~~)", line):
            fenced = not fenced
        elif (not fenced and len(line) > WIDTH and not line.lstrip().startswith("|") and not line.startswith("    ")
              and not re.fullmatch(r"[\s>*-]*(?:!?\[.*\]\(\S+\)|\[[^]]+\]: \S+|<?https?://\S+>?)[.,;]?", line)):
            found.append(f"{path}:{number}: {len(line)} characters, at most {WIDTH}")
    return found


# -------------------------------------------------------------------------------------------------------- names
# Left column of the vocabulary -> its standard term, and the folders where the name is refused; () stands for all.
# Words of everyday use are refused only where they were names. Strings of C++ have rules of their own, below.

EVERYWHERE = ()
CPP_ONLY = ("common/", "kernels/", "miniapps/", "perf/", "tests/")
FABRIC, OPTIONS, KERNELS = ("kernels/fabric/",), ("kernels/options/",), ("kernels/",)

NAMES = (
    (r"SolverOn|PricerOn|[A-Z]\w*On(?=<)", "SolverImpl<ExecutionSpace>", EVERYWHERE),
    (r"bar", "tolerance", EVERYWHERE),
    # A `seed` by itself starts random numbers.
    (r"Seed[A-Z]\w*|seed_\w+", "baseline", EVERYWHERE),
    (r"Replay", "CapturedGraph", EVERYWHERE),
    (r"ReportSpace", "HostPinnedSpace", EVERYWHERE),
    (r"ResidentGrid|[Rr]esident_\w+", "PersistentKernel, persistent_*", EVERYWHERE),
    (r"Rendezvous", "GridSync", EVERYWHERE),
    (r"Packet", "HaloMessage", EVERYWHERE),
    (r"post|collect", "put / get", KERNELS),
    (r"meet_warp", "warp_sync", EVERYWHERE),
    (r"from_below", "shuffle_up", EVERYWHERE),
    (r"from_across", "shuffle_xor", EVERYWHERE),
    (r"reach", "lane_offset, cutoff_distance, strike_range", EVERYWHERE),
    (r"Ledger", "ProfilingCounters", CPP_ONLY),
    (r"Way", "CopyKind, edge_vector", EVERYWHERE),
    (r"Ends", "BoundaryConditions", EVERYWHERE),
    (r"Triple", "ConservedVector", EVERYWHERE),
    (r"Speeds", "WaveSpeeds", EVERYWHERE),
    (r"Mean", "FaceAverage", EVERYWHERE),
    (r"Judgement", "TeamControl", EVERYWHERE),
    (r"Outcome", "StageReduction", EVERYWHERE),
    (r"Attempt", "StepTrial", EVERYWHERE),
    (r"Findings", "StepResult", EVERYWHERE),
    (r"outgrown", "violates_cfl", EVERYWHERE),
    (r"Resume", "RestartState", EVERYWHERE),
    (r"touches|touched", "limited_faces, limited_cells", CPP_ONLY),
    (r"Law", "ConstitutiveModel, LevyMeasure", EVERYWHERE),
    (r"Cloth", "FabricViews", EVERYWHERE),
    (r"Lent", "unmanaged View", EVERYWHERE),
    (r"Spoke", "EdgeVector", EVERYWHERE),
    (r"Products", "GramMatrix", EVERYWHERE),
    (r"Slots", "SlicedEll", EVERYWHERE),
    (r"Watch", "StepMonitor", EVERYWHERE),
    (r"hand", "parity", CPP_ONLY),
    (r"held", "fixed_dofs", CPP_ONLY),
    (r"act(?=\()", "compute_external_forces", FABRIC),
    (r"place(?=\()", "apply_dirichlet", FABRIC),
    (r"take(?=\()", "step", FABRIC),
    (r"settle(?=\()", "synchronize", FABRIC),
    (r"keep(?=\()", "checkpoint", FABRIC),
    (r"DragFunctor", "DashpotDampingFunctor", EVERYWHERE),
    (r"Touch", "ContactConstraint", EVERYWHERE),
    (r"grip", "friction impulse", CPP_ONLY),
    (r"push(?=\()|wanted", "normal impulse, target_velocity", FABRIC),
    (r"Ball", "BoundingSphere", EVERYWHERE),
    (r"Clearance", "SignedDistance", EVERYWHERE),
    (r"stay_apart", "ccd_*", EVERYWHERE),
    (r"join(?=\()", "unite", FABRIC),
    (r"zone_of", "find_root", EVERYWHERE),
    (r"Trouble", "FailureReason", EVERYWHERE),
    (r"cut_patches", "partition_by_recursive_bisection", EVERYWHERE),
    (r"Clock", "TimeState, Stopwatch", EVERYWHERE),
    (r"Timing", "StageTime, WallTimes", EVERYWHERE),
    (r"Doubt|doubt_of\w*", "ErrorEstimate, estimate_error", EVERYWHERE),
    (r"Answer", "derivatives of the price", EVERYWHERE),
    (r"bend", "second_derivative", CPP_ONLY),
    (r"Put", "NormalizedPut", CPP_ONLY),
    (r"Effort", "Resolution", EVERYWHERE),
    (r"Workers", "ThreadGroup", EVERYWHERE),
    (r"alone", "single", CPP_ONLY),
    (r"RisingMap", "MaxAffineMap", EVERYWHERE),
    (r"smile", "StrikeGroup", ("kernels/", "miniapps/", "perf/")),
    (r"Desk", "WorkQueue", EVERYWHERE),
    (r"Helper", "WorkerProxy", CPP_ONLY),
    (r"dismiss", "shutdown", EVERYWHERE),
    (r"Piece", "ResultBatch", EVERYWHERE),
    (r"Spent", "WallTimes", EVERYWHERE),
    (r"Tally", "RowCounts", EVERYWHERE),
    (r"Ranks", "Communicator", EVERYWHERE),
    (r"together", "run_collectively", CPP_ONLY),
    (r"from_first", "broadcast", EVERYWHERE),
    (r"OneRun", "SceneRun", EVERYWHERE),
    (r"carry_out", "run_scene", EVERYWHERE),
)
# Words of the left column that no name of C++ may contain, such as CamelCaseSpokes or is_held.
WORDS = (
    (r"spokes?", "EdgeVector"),
    (r"rendezvous", "GridSync"),
    (r"outgr(?:ow|ew)\w*", "violates_cfl"),
    (r"held", "fixed"),
    (r"doubts?", "error estimate"),
    (r"desks?", "WorkQueue"),
    (r"smiles?", "StrikeGroup"),
    (r"spent", "times"),
    (r"tall(?:y|ies)", "counts"),
    (r"together", "collectively"),
    (r"judge\w*|judgements?", "check, TeamControl"),
    (r"asked|asks?|told|tells?", "a word for the deed of code"),
)
WORD_PATTERNS = tuple((re.compile(words), term) for words, term in WORDS)
PATTERNS = tuple((re.compile(rf"(?<![\w-])(?:{names})(?![\w-])"), term, where) for names, term, where in NAMES)


def words_of(identifier):
    """Lower-case words of a name in snake_case or CamelCase."""
    return [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+", identifier)]


def replaced_words(path, text):
    """Lines `path:line: ...` for names of C++ of several words, one of which the vocabulary replaces."""
    if not path.endswith(CODE) or not path.startswith(CPP_ONLY):
        return []
    found = []
    for number, line in identifiers_of_code(text):
        for identifier in re.findall(r"[A-Za-z_]\w*", line):
            words = words_of(identifier)
            for word in words if len(words) > 1 else ():
                # Ranks of a test may fail together.
                if word == "together" and path.startswith("tests/"):
                    continue
                found += [f"{path}:{number}: {identifier}: '{word}' is {term} in the vocabulary"
                          for pattern, term in WORD_PATTERNS if pattern.fullmatch(word)]
    return found


def without_strings(line):
    return re.sub(r'"(?:[^"\\\n]|\\.)*"', '""', line)


def identifiers_of_code(text):
    """Pairs (line, words) of C++ source: code without strings, and the parts of comments in backquotes."""
    inside = False
    for number, line in enumerate(text.split("\n"), 1):
        line = line if line.lstrip().startswith("#") else without_strings(line)
        if inside or line.lstrip().startswith("/*"):
            inside = "*/" not in line
            yield number, " ".join(re.findall(r"`([^`]*)`", line))
            continue
        code, _, comment = line.partition("//")
        yield number, " ".join([code, *re.findall(r"`([^`]*)`", comment)])


def identifiers_of_python(text):
    previous = ""
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.NAME:
            if (previous, token.string) != (".", "bar"):  # a method of matplotlib
                yield token.start[0], token.string
        elif token.type == tokenize.STRING and re.fullmatch(r"[frbu]*(['\"])bar\1", token.string):
            yield token.start[0], "bar"
        previous = token.string


def identifiers(path, text):
    """Pairs (line, words) of the names of any file; of a document, those in backquotes and in code blocks."""
    if path.endswith(CODE):
        yield from identifiers_of_code(text)
    elif path.endswith(".py"):
        yield from identifiers_of_python(text)
    elif path.endswith(".md"):
        fenced = False
        for number, line in enumerate(text.split("\n"), 1):
            if re.match(r"\s*```", line):
                fenced = not fenced
            elif fenced:
                yield number, re.sub(r"#.*", "", line)
            else:
                yield number, " ".join(re.findall(r"`([^`]*)`", line))
    elif path.endswith((".txt", ".cmake", ".toml")):
        for number, line in enumerate(text.split("\n"), 1):
            yield number, re.sub(r'#.*|"[^"]*"', "", line)


@functools.cache
def any_of(patterns):
    """One pattern that matches where any of the (pattern, term) does."""
    return re.compile("|".join(pattern.pattern for pattern, _ in patterns))


def replaced_names(path, text):
    """Lines `path:line: ...` for names of the vocabulary's left column that are left, in text or as a file's name."""
    found = []
    if path.endswith("CHANGELOG.md"):
        return found
    if re.search(r"_on\w*\.hpp$", path) or re.search(r"/(?:seed|doubt|desk)\w*\.[hc]pp", path):
        found.append(f"{path}:1: the file's name is replaced by the vocabulary")
    patterns = tuple((pattern, term) for pattern, term, where in PATTERNS if not where or path.startswith(where))
    any_name = any_of(patterns)
    for number, words in identifiers(path, text):
        if not any_name.search(words):
            continue
        for pattern, term in patterns:
            for match in pattern.finditer(words):
                found.append(f"{path}:{number}: {match.group()} is {term} in the vocabulary")
    return found


# ----------------------------------------------------------------------------------------------------- messages
# Strings of the programs in C++, not of tests. One with a space between words is a message, a description or a heading: it
# does not open with What, Of, That or Those, and code does not tell or know in it. One without is a key or a value.

SHOWN = (
    (r"(?<!porous )laws?(?! =)", "model, process"),  # `law = ...` is the key of porosity
    (r"(?:(?<=the )|(?<=its )|(?<=their )|(?<=of )|(?<=no ))reach", "cutoff distance, strike range, extent"),
    (r"bars?", "tolerance"),
    (r"doubts?", "error estimate"),
    (r"smiles?", "strike group"),
    (r"tall(?:y|ies)", "counts"),
    (r"rendezvous", "grid synchronization"),
    (r"spokes?", "edge vector"),
    (r"outgrown", "violates the CFL condition"),
    (r"resident", "persistent"),
    (r"desks?", "work queue"),
    (r"trouble", "failure, reason"),
    (r"(?<!limiter )touches|touched", "limited faces, contact"),
    (r"judgements?", "team control"),
    (r"(?<!--method )(?<!method )seed(?!:)", "baseline, or method seed, --seed-mode"),
)
SHOWN_PATTERNS = tuple((re.compile(rf"(?<![\w-])(?:{words})(?![\w-])", re.IGNORECASE), term) for words, term in SHOWN)

# Keys and values that files and command lines of users contain, and the folders where they stand. Code says the standard
# term: `baseline` for seed, `limited_faces` and `limited_cells` for touches and touched. docs/glossary.md has them.
KEPT = {
    "seed": CPP_ONLY,  # --method seed, [tuning.seed], the driver and the records of measurements
    "touches": ("miniapps/", "common/run/result_document.cpp"),  # limiter.touches of result.json and in the line at the end of a run
    "touched": ("miniapps/gas/simulation/simulation_restart",),  # dataset of restart files
    "law": ("miniapps/parachute/bodies/",),  # porosity.law of scenes
    "bar": ("common/scene/read.cpp",),  # the former name, for the hint
}


def strings(text):
    """Pairs (line, words) of the string literals of C++ source; adjacent ones are one. Those of #include are left out."""
    found, end = [], None
    token = re.compile(r"^\s*#\s*include[^\n]*|//[^\n]*|/\*.*?\*/|(?<!\w)'(?:[^'\\\n]|\\.)+'"
                       r'|R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<plain>(?:[^"\\\n]|\\.)*)"', re.DOTALL | re.MULTILINE)
    for match in token.finditer(text):
        words = match["plain"] if match["raw"] is None else match["raw"]
        if words is None:
            continue
        if end is not None and not text[end:match.start()].strip():
            found[-1][1] += words
        else:
            found.append([text.count("\n", 0, match.start()) + 1, words])
        end = match.end()
    return [(line, re.sub(r"\\n", " ", words)) for line, words in found]


def unclear_strings(path, text):
    """Lines `path:line: ...` for strings of programs that hold a replaced name, open as a riddle, or personify code."""
    if not path.endswith(CODE) or not path.startswith(CPP_ONLY) or path.startswith("tests/"):
        return []
    found = []
    for line, words in strings(text):
        message = " " in words.strip()
        kept = {word for word, where in KEPT.items() if path.startswith(where)}
        for pattern, term in SHOWN_PATTERNS:
            # A key is a path of names, as in tuning.seed.pinned.
            for part in [words] if message else words.split("."):
                match = pattern.search(part) if message else pattern.fullmatch(part)
                if match and (message or part not in kept):
                    found.append(f"{path}:{line}: {match.group()} in a string is {term} in the vocabulary: {words[:70]}")
        personified_word = PERSONIFIED.search(re.sub(r"`[^`]*`|\"[^\"]*\"|<\w+>|\b[A-Z]{2,}\b", "", words))
        if message and personified_word:
            found.append(f"{path}:{line}: '{personified_word.group()}' is no deed of code: {words[:70]}")
        if message and REFUSED_ELSEWHERE.match(words):
            found.append(f"{path}:{line}: opens with '{REFUSED_ELSEWHERE.match(words).group()}': {words[:70]}")
    return found


# A rate is written "us per step".
RATE_WITH_ARTICLE = re.compile(r"(?<!\w)(?:us|µs|\\u00b5s|ms|ns|microseconds|milliseconds|nanoseconds) an? [\w%{]")


def strings_of_python(text):
    """Pairs (line, words) of the string literals of a Python source, as written."""
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    return [(token.start[0], token.string) for token in tokens if token.type == tokenize.STRING]


def rates_with_an_article(path, text):
    """Lines `path:line: ...` for strings of C++ and Python with a rate such as "us a step"."""
    if not path.endswith((*CODE, ".py")):
        return []
    found = []
    for line, words in strings(text) if path.endswith(CODE) else strings_of_python(text):
        match = RATE_WITH_ARTICLE.search(words)
        if match:
            found.append(f"{path}:{line}: write 'per' for the article: {words[match.start():match.start() + 70]}")
    return found


# ---------------------------------------------------------------------------------------------------- contracts
# Public: a header of kernels/ (not of the reference) that a mini-app, perf, the install test or another area includes.
# Every function that it declares at namespace scope or as a public member has a doc comment, which it may share with
# the declaration on the line before. The comment, or that of its class, says
#   errors: throws, does not throw, noexcept. `constexpr`, `noexcept` and device functions (KOKKOS_...) cannot throw.
#   units:  if the declaration has real numbers, vectors, spans or Views: a unit, or that there is none. Not asked of
#           kernels/device, whose arithmetic serves any unit.
# Exempt: destructors, operators, defaulted, deleted and friend functions, constructors without arguments.

# A symbol follows a comma, a preposition, a number, a bracket or another symbol: `vertex's` and (n,3) hold none. A count of
# cells is no unit: a comment says "dimensionless", or which other unit the numbers have.
UNITS = re.compile(
    r"(?:, |\bin |\d |/|\(|\* )(?:1/)?(?:m|s|kg|N|J|K|Pa|Hz|W|rad|us|ns|ms|GB|flop)(?![\w'`(])|%|\bSI\b|"
    r"\b(?i:bytes?|years?|seconds?|metres?|kilograms?|radians?|per cent|percent|money|dimensionless|fractions?|ratios?|"
    r"any unit|no unit|unit vectors?|units? of|of the strike|multiples? of)\b")
ERRORS = re.compile(r"[Tt]hrow|noexcept|[Aa]borts|[Nn]o errors|[Dd]oes not fail|[Nn]ever fails")
SCOPE = re.compile(r"\b(namespace|class|struct|union|extern)\b")
REAL = re.compile(r"\b(?:double|float|Real|R|T|Vector3?|Pair|span<(?!const (?:int|std::)|int|std::)|View\w*|Kokkos::View)\b|"
                  r"Views?<|Vector|array<(?!int|bool|std::)")
HEADERS = (".hpp",)


def area(path):
    """The area of kernels/ of a file: its first folder there; None elsewhere and in the reference."""
    parts = path.split("/")
    return parts[1] if parts[0] == "kernels" and len(parts) > 2 and parts[1] != "reference" else None


# Interfaces for coupling, which programs outside of this project include.
COUPLING_HEADERS = re.compile(
    r"kernels/(?:coupling/\w+|fabric/surface/\w+|fabric/(?:payload|state|vertex_force|loads/prescribed_motion))\.hpp"
)
# Header of a typed solver -> header of its facade. A function that the facade declares too may refer to it by the words
# "documented in `Solver`" in its own comment or in that of its class.
FACADES = {
    "kernels/fabric/fabric_solver.hpp": "kernels/fabric/solver.hpp",
    "kernels/flow/flow_solver.hpp": "kernels/flow/solver.hpp",
    "kernels/gas/gas_solver.hpp": "kernels/gas/solver.hpp",
    "kernels/options/batch/pide_pricer.hpp": "kernels/options/pricer.hpp",
}
IN_FACADE = re.compile(r"documented in\s+`(?:Solver|Pricer)`")


def public_headers(texts):
    """Headers of kernels/ for coupling, and those that an app, perf, the install test or another area includes."""
    found = {path for path in texts if COUPLING_HEADERS.fullmatch(path) or path in FACADES}
    for path, text in texts.items():
        outside = path.startswith(("miniapps/", "perf/", "tests/install/"))
        for name in re.findall(r'^\s*#\s*include\s*"([^"]+)"', text, re.MULTILINE):
            if area(name) and name in texts and (outside or area(path) and area(path) != area(name)):
                found.add(name)
    return sorted(found)


def is_function(statement):
    """Whether a declaration without its comments declares a function that a caller needs a contract for."""
    plain = re.sub(r"\[\[.*?\]\]|\balignas\s*\(.*?\)|\bnoexcept\s*\(.*?\)|\brequires\s*\(.*?\)", " ", statement)
    while re.search(r"<[^<>()]*>", plain):
        plain = re.sub(r"<[^<>()]*>", " ", plain)
    # A comma: an initializer of a constructor after one in braces.
    if re.search(r"^\s*(?:,|(?:using|typedef|static_assert|friend|#|return|extern template|template class|enum)\b)", plain):
        return False
    if re.search(r"=\s*(?:default|delete)\s*$|\boperator\b|~\w+\s*\(|\boverride\b|\bfinal\s*$", plain):
        return False
    head = re.split(r"=(?!=)(?!\s*0\s*$)", plain)[0]
    match = re.search(r"(\w+)\s*\(([^)]*)", head)
    if not match or match.group(1).isupper() or match.group(1) in ("decltype", "if", "for", "while", "sizeof"):
        return False
    if re.search(r"::\s*$", head[:match.start()]):  # definition of a member, whose declaration has the contract
        return False
    constructor = not re.search(r"[\w>&*\]]\s+[&*]*\w+\s*\(", head) or re.match(r"\s*explicit\b", head)
    return not (constructor and not match.group(2).strip())


def declarations(text):
    """Tuples (line, comment, class comment, statement) of the functions at namespace scope and of public members."""
    found = []
    scopes = []  # of [kind, class comment, whether members are public]; kind None: a body that is not read
    comment, statement, start, parens, shared = "", "", 0, 0, ""
    body = 0
    for number, raw in enumerate(text.split("\n"), 1):
        line = re.sub(r'"(?:[^"\\]|\\.)*"' + r"|'(?:[^'\\]|\\.)'", '""', raw)
        doc = re.match(r"\s*///?\s?(.*)", line)
        if doc and not body:
            if not statement.strip():
                comment += " " + doc.group(1) if line.strip().startswith("///") else ""
            continue
        note = re.search(r"///<\s?(.*)", line)
        if note and not body:
            comment += " " + note.group(1)
        line = re.sub(r"//.*", "", line)
        if line.lstrip().startswith("#"):
            continue
        if not line.strip() and not statement.strip() and not body:
            comment, shared = "", ""
            continue
        for sign in line:
            if body:
                body += (sign == "{") - (sign == "}")
                if not body:
                    statement, comment = "", ""
                continue
            if sign == "{" and not parens:
                head = re.sub(r"template\s*<[^{]*?>\s*(?=class|struct|\[|\w)", "", statement)
                kind = SCOPE.search(head)
                function = "(" in re.sub(r"alignas\s*\([^)]*\)|\brequires\b.*|\[\[.*?\]\]", "", statement)
                if kind and not function and "=" not in head and "enum" not in head:
                    # A nested class that is defined outside of its own may be private.
                    public = kind.group(1) != "class" and not re.search(r"\bstruct\s+\w+(?:\s*<[^{]*>)?::\w", statement)
                    scopes.append([kind.group(1), comment, public])
                    statement, comment, shared = "", "", ""
                else:
                    if is_function(statement) and all(scope[2] for scope in scopes):
                        inherited = " ".join(scope[1] for scope in scopes)
                        found.append((start, comment or shared, inherited, statement))
                        shared = comment or shared
                    body = 1
                continue
            if sign == "}" and not parens:
                if scopes:
                    scopes.pop()
                statement, comment, shared = "", "", ""
                continue
            parens += (sign == "(") - (sign == ")")
            if sign == ":" and statement.strip() in ("public", "private", "protected") and scopes:
                scopes[-1][2] = statement.strip() == "public"
                statement, comment, shared = "", "", ""
                continue
            if sign == ";" and not parens:
                if is_function(statement) and all(scope[2] for scope in scopes):
                    inherited = " ".join(scope[1] for scope in scopes)
                    found.append((start, comment or shared, inherited, statement))
                    shared = comment or shared
                statement, comment = "", ""
                continue
            if not statement.strip() and sign.strip():
                start = number
            statement += sign
        if statement:
            statement += " "
    return found


def name_of(statement):
    """Name of the function that a declaration declares."""
    return re.search(r"(\w+)\s*\(", re.sub(r"\[\[.*?\]\]|alignas\(.*?\)", "", statement)).group(1)


def missing_contracts(path, text, facade=""):
    """Lines `path:line: ...` for functions of a public header without a doc comment, a unit, or a word on errors.

    `facade`: text of the header whose functions document those of the same names here.
    """
    found = []
    of_facade = {name_of(statement) for _, _, _, statement in declarations(facade)}
    for line, comment, inherited, statement in declarations(text):
        name = name_of(statement)
        both = comment + " " + inherited
        if name in of_facade and IN_FACADE.search(both):
            continue
        if not comment.strip():
            found.append(f"{path}:{line}: {name} has no doc comment")
            continue
        if not path.startswith("kernels/device/") and REAL.search(statement) and not UNITS.search(both):
            found.append(f"{path}:{line}: {name} states no unit")
        if not ERRORS.search(both) and not re.search(r"\bKOKKOS_\w*FUNCTION\b|\bconstexpr\b|\bnoexcept\b", statement):
            found.append(f"{path}:{line}: {name} does not say whether it throws")
    return found


# ---------------------------------------------------------------------------------------------------------- all


def names_below(root):
    """Paths below `root` that git does not ignore; without git, those outside of hidden folders."""
    if (root / ".git").exists():
        try:
            listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=root,
                                    check=True, capture_output=True, text=True).stdout
            return sorted({Path(name) for name in listed.split("\0") if name})
        except (OSError, subprocess.CalledProcessError):
            pass
    names = (path.relative_to(root) for path in root.rglob("*"))
    return sorted(name for name in names if not any(part.startswith(".") for part in name.parts[:-1]))


def read_tree(root, tops=None):
    """All files that the rules read below `root`, by their path from there, with their texts."""
    texts = {}
    for name in names_below(root):
        path = root / name
        if SKIPPED_FOLDERS & set(name.parts) or RECORDS in name.parents or not path.is_file() or (tops and name.parts[0] not in tops):
            continue
        if name.as_posix().endswith((*CODE, ".py", ".md", ".cmake", ".txt", ".toml", ".sh")):
            texts[name.as_posix()] = path.read_text(encoding="utf-8")
    return texts


# This file holds the replaced names, and its test breaches every rule.
OWN = ("tests/layering/writing.py", "tests/layering/test_writing.py")


# Rules for one file each: its path and text -> lines `path:line: ...`.
RULES = (refused_openings, personified, riddles, wide_lines, replaced_names, replaced_words, unclear_strings, rates_with_an_article)


def main(arguments):
    root = Path.cwd()
    texts = {path: text for path, text in read_tree(root).items() if path not in OWN}
    chosen = [argument.rstrip("/") for argument in arguments if not argument.startswith("-")]
    warn = "--no-warnings" not in arguments

    def shown(path):
        return not chosen or any(path == place or path.startswith(place + "/") for place in chosen)

    count = 0
    public = set(public_headers(texts))
    for path, text in texts.items():
        if not shown(path):
            continue
        found = [line for rule in RULES for line in rule(path, text)]
        found += missing_contracts(path, text, texts.get(FACADES.get(path), "")) if path in public else []
        count += len(found)
        found += suspect_openings(path, text) if warn else []
        print("".join(line + "\n" for line in found), end="")
    print(f"{count} breaches")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
