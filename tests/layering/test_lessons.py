"""The tables of the lessons are those of their records."""

import json
import os
import re
import subprocess
import sys
import unittest

import layers

ROOT = layers.repository(os.environ)
LADDERS = ("weno", "springs", "options", "transfers")
# Words for the backends of a clause of a rung's text and of the clauses after it.
PLACES = {"a host": {"serial", "openmp"}, "one core": {"serial"}, "two threads": {"openmp"}, "an H100": {"cuda"}, "a GPU": {"cuda"}, "an H200": {"no record"}}
PLACE = re.compile(r"\b[Oo]n (" + "|".join(PLACES) + r")\b")
LOSS = 1.03  # least time over that of the rung before that a text must mention


def times(ladder):
    """Median and predicted time of each rung, s, by backend, in the order of the record."""
    found = {}
    for file in sorted((ROOT / "docs/evidence/ladders").glob(f"{ladder}-*.jsonl")):
        records = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
        found[records[0]["facts"]["backend"]] = {r["facts"]["rung"]: (r["median"], r["facts"]["predicted_s"]) for r in records}
    return found


def slowness(rungs, name):
    """Time of a rung over that of the rung before it in the record; none of the first one or where it is not measured."""
    names = list(rungs)
    k = names.index(name) if name in names else 0
    return rungs[names[k]][0] / rungs[names[k - 1]][0] if k > 0 else None


def clauses(text):
    """The clauses of a text with the backends that each is about; empty where none was named yet."""
    about = set()
    for clause in re.split(r"(?<=[.;:,]) ", text):
        for place in PLACE.findall(clause):
            about = PLACES[place]
        yield clause, about


def texts():
    """Ladder, name and text of all rungs."""
    for ladder in LADDERS:
        for header in sorted((ROOT / "perf/ladders" / ladder).glob("*.hpp")):
            joined = re.sub(r'"\s*"', "", header.read_text(encoding="utf-8"))
            for name, _, hindsight in re.findall(r'RungText text\{\s*"([^"]*)",\s*"([^"]*)",\s*"([^"]*)"\}', joined):
                yield ladder, name, hindsight


class Lessons(unittest.TestCase):
    def test_tables_equal_their_records(self):
        words = [sys.executable, "-B", ROOT / "scripts/publish_records.py", "--tables", "--check"]
        process = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual(0, process.returncode, process.stderr)

    def test_every_rung_of_a_record_passed_its_check(self):
        for file in (ROOT / "docs/evidence/ladders").glob("*.jsonl"):
            self.assertNotIn('"check":"failed"', file.read_text(encoding="utf-8"), file.name)

    def test_each_rung_is_one_file(self):
        found = 0
        for ladder in ("weno", "springs", "options", "transfers"):
            rungs = re.findall(r"make_rung<", (ROOT / f"perf/ladders/{ladder}/ladder.hpp").read_text(encoding="utf-8"))
            texts = 0
            for header in sorted((ROOT / "perf/ladders" / ladder).glob("*.hpp")):
                text = header.read_text(encoding="utf-8")
                for name in re.findall(r'RungText text\{\s*"([^"]+)"', text):
                    self.assertEqual(header.stem, name.replace("-", "_"))
                    texts += 1
            self.assertEqual(len(rungs), texts, ladder)
            found += texts
        self.assertGreater(found, 25)

    def test_gains_and_losses_are_those_of_the_records(self):
        """`loses` and `gains` hold on all backends that the clause is about, and no loss is passed over in silence."""
        told = 0
        for ladder, name, text in texts():
            recorded = times(ladder)
            silent = {b for b, rungs in recorded.items() if (slowness(rungs, name) or 0.0) >= LOSS}
            for clause, about in clauses(text):
                if about == PLACES["an H200"]:
                    continue
                factors = {b: slowness(recorded[b], name) for b in about if b in recorded and slowness(recorded[b], name)}
                with self.subTest(rung=f"{ladder} {name}", clause=clause):
                    if re.search(r"\bloses\b", clause):
                        self.assertTrue(factors)
                        self.assertGreater(min(factors.values()), 1.0, factors)
                        silent -= about
                        told += 1
                    if re.search(r"\b(gains|wins)\b(?! (nothing|little))", clause):
                        self.assertTrue(factors)
                        self.assertLess(max(factors.values()), 1.0, factors)
                        told += 1
                    if re.search(r"\b(gains|wins) (nothing|little)\b|\bnothing changes\b", clause):
                        self.assertTrue(factors)
                        self.assertTrue(all(0.8 < factor < 1.1 for factor in factors.values()), factors)
                        told += 1
            self.assertEqual(set(), silent, f"{ladder} {name} loses there, but its text does not say so")
        self.assertGreater(told, 10)

    def test_factors_that_a_rung_states_are_those_of_its_record(self):
        """`N times as fast` as the rung before, `N predicted` and `N times the prediction`; `A to B` for several backends."""
        stated = 0
        for ladder, name, text in texts():
            recorded = times(ladder)
            for clause, about in clauses(text):
                with self.subTest(rung=f"{ladder} {name}", clause=clause):
                    for low, high, kind in re.findall(r"\b([0-9.]+)(?: to ([0-9.]+))? (times as fast|times the prediction|predicted)", clause):
                        found = []
                        for backend in about & set(recorded):
                            names = list(recorded[backend])
                            now, before = (recorded[backend][n] for n in (name, names[names.index(name) - 1]))
                            factor = {"times as fast": before[0] / now[0], "predicted": before[1] / now[1]}
                            found.append(factor.get(kind, now[0] / now[1]))
                        digits = len(low.partition(".")[2])
                        ends = [min(found), max(found)] if high else found
                        self.assertEqual({round(x, digits) for x in ends}, {float(x) for x in (low, high) if x})
                        stated += 1
        self.assertGreater(stated, 8)

    def test_factors_that_an_answer_states_are_those_of_the_records(self):
        """`on PLACE `RUNG` is N times as fast as `RUNG`[, WORDS,] and M times as fast as `RUNG``, of any ladder that has these rungs."""
        text = " ".join((ROOT / "docs/lessons/answers.md").read_text(encoding="utf-8").split())
        stated = 0
        for place, rung, rest in re.findall(r"on (an H100|one core|two threads) `([a-z-]+)` is ([^:.;]*(?:\.\d[^:.;]*)*)", text):
            (backend,) = PLACES[place]
            for number, other in re.findall(r"([0-9.]+) times as fast as `([a-z-]+)`", rest):
                found = [recorded[other][0] / recorded[rung][0] for recorded in (times(ladder).get(backend, {}) for ladder in LADDERS)
                         if {rung, other} <= recorded.keys()]
                self.assertEqual([float(number)], [round(factor, len(number.partition(".")[2])) for factor in found], f"{place}: {rung}, {other}")
                stated += 1
        self.assertEqual(5, stated)

    def test_counts_that_a_header_states_are_those_of_its_arithmetic(self):
        """`N % fewer operations` and `N divisions of M` against the counted work of two fluxes, which tests count by running them."""
        counts = {}
        for header in ("direct_flux", "differences", "one_division"):
            text = (ROOT / f"perf/ladders/weno/{header}.hpp").read_text(encoding="utf-8")
            counts[header] = [int(n) for n in re.search(r"Arithmetic arithmetic\{([^}]*)\}", text)[1].split(",")]
        operations = {name: sum(c[:2]) for name, c in counts.items()}
        text = (ROOT / "perf/ladders/weno/differences.hpp").read_text(encoding="utf-8")
        percent = round(100 * (1 - operations["differences"] / operations["direct_flux"]))
        self.assertEqual({str(percent)}, set(re.findall(r"(\d+) % fewer\s+(?:///\s+)?operations", text)))
        text = (ROOT / "perf/ladders/weno/one_division.hpp").read_text(encoding="utf-8")
        self.assertEqual({(str(counts["one_division"][2]), str(counts["differences"][2]))},
                         set(re.findall(r"(\d+) divisions of (\d+)", text)))

    def test_times_that_a_rung_states_are_those_of_its_record(self):
        """Times on an H100, measured or predicted."""
        stated = 0
        for ladder, name, text in texts():
            known = {time * 1e6 for both in times(ladder)["cuda"].values() for time in both}
            for clause, about in clauses(text):
                for number in re.findall(r"\b([0-9.]+) us\b", clause):
                    self.assertEqual({"cuda"}, about, f"{ladder} {name}: {clause}")
                    digits = len(number.replace(".", "").lstrip("0"))
                    self.assertIn(float(number), {float(f"{time:.{digits}g}") for time in known}, f"{ladder} {name}: {number} us")
                    stated += 1
        self.assertGreater(stated, 30)
