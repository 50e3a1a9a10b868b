"""Pages of records: sections, omitted records, separation of machines, and rejection of invalid input."""

import json
import re

import packages  # noqa: F401, before modules that need the packages  isort: skip
import synthetic
import synthetic_records as records
from evidence_pages import Folder, plot


class Contents(Folder):
    def test_sections_appear_only_with_records_of_their_kind(self):
        kinds = {
            "Sod: error against time": records.solutions(problems=("sod",), backends=("serial",), meshes=(100, 200)),
            "A step": records.steps_of_h200(),
            "Roofline, CUDA": records.ceilings(),
            "Transfers of a step, CUDA": records.transfers(),
            "Block size, CUDA": records.blocks(),
        }
        for title, lines in kinds.items():
            with self.subTest(title):
                page, _ = self.page(lines)
                self.assertEqual([section for _, section in page.tables], [title])
                for source in ("2026-11-22", "commit abcdef123456", "GNU 12.2.0", "drogue-perf "):
                    self.assertIn(source, page.words)

    def test_page_refers_to_no_other_file(self):
        page, _ = self.page(records.transfers())
        self.assertTrue(all(source.startswith("data:image/png;base64,") for source in page.sources))
        text = (self.folder / "gas.html").read_text()
        self.assertEqual(re.findall(r"(?:src|href)=\"(?!data:)[^\"]*", text), [])

    def test_omits_and_names_records_with_failed_check(self):
        lines = records.solutions(problems=("sod",), backends=("serial",), meshes=(100, 200))
        for check, count in (("passed", 1), ("failed", 0)):
            step = records.step("cuda/2048", 654e-6, records.H200, 2048, check=check)
            finer = records.solution("sod", "serial", "js", records.USUAL, 6400, records.H200, check=check)
            page, _ = self.page([*records.steps_of_h200(), *lines, step, finer])
            for words in ("654 [", "100–6400"):
                self.assertEqual(page.words.count(words), count, words)
        self.assertIn("2 records are left out for a failed check: ", page.words)
        self.assertIn("gas-step/cuda/2048 on NVIDIA H200, Intel Xeon Processor (error 0.0001)", page.words)

    def test_accepts_failed_check_without_times(self):
        bad = records.solution("sod", "serial", "js", records.USUAL, 100, records.H200, check="failed")
        page, files = self.page([bad | {"median": None, "interval": None, "error": None}])
        self.assertEqual((files, page.tables), (["gas.html"], {}))
        self.assertIn("1 record is left out for a failed check: ", page.words)

    def test_uses_latest_record_of_a_case(self):
        old = records.step("cuda/8192", 99e-6, records.H200, 8192, run="2026-11-01T00:00:00Z")
        page, _ = self.page([*records.steps_of_h200(), old])
        self.assertNotIn("99 [", page.words)
        self.assertIn("1 record is left out, because a later one", page.words)

    def test_names_unknown_kinds_of_records(self):
        page, _ = self.page([*records.steps_of_h200(), records.record("tower/weno/3", 1e-6, records.H200)])
        self.assertIn("Not shown: 1 record of the kind tower, which this page does not know.", page.words)

    def test_machines_have_separate_sections_and_pictures(self):
        other = records.H200 | {"cpu": "AMD EPYC"}
        lines = [records.step("cuda/8192", 5e-6, records.H200, 8192), records.step("cuda/8192", 7e-6, other, 8192)]
        page, _ = self.page([*lines, *records.steps_of_core()])
        steps = {
            machine: [row[rows[0].index("\u00b5s per step")] for row in rows if len(row) == len(rows[0])][1:]
            for (machine, _), rows in page.tables.items()
        }
        self.assertEqual(list(steps), ["NVIDIA H200, Intel Xeon Processor", "NVIDIA H200, AMD EPYC", "AMD EPYC"])
        self.assertEqual([times[0].split()[0] for times in steps.values()], ["5", "7", "410"])
        self.assertEqual([len(times) for times in steps.values()], [1, 1, 5])
        _, files = self.page(records.ceilings() + records.ceilings(machine=other))
        self.assertEqual(files, ["gas.html", "roofline_cuda_nvidia-h200-2.png", "roofline_cuda_nvidia-h200.png"])

    def test_obeys_format_and_out_and_draws_study_beside_records(self):
        records.write(self.folder / "in" / "a.jsonl", records.ceilings())
        synthetic.write_study(self.folder / "in" / "study.csv")
        code, files, _ = plot(self.folder / "in", "--out", self.folder / "out", "--format", "svg")
        roofline = "roofline_cuda_nvidia-h200"
        self.assertEqual((code, files), (0, ["gas.html", f"{roofline}.png", f"{roofline}.svg", "study.svg"]))
        self.assertEqual(sorted(file.name for file in (self.folder / "in").iterdir()), ["a.jsonl", "study.csv"])


class Refusals(Folder):
    def test_rejects_invalid_record_with_file_and_line(self):
        good = json.dumps(records.step("cuda/8192", 5e-6, records.H200, 8192))
        blocks, batch = records.blocks()[0], records.options_transfers()[0]
        cases = {
            '{"schema": "drogue.perf/1", ': "no JSON",
            "[1, 2]": "no JSON object",
            good.replace(
                "drogue.perf/1", "drogue.perf/9"
            ): "the schema is 'drogue.perf/9'; drogue-plot reads drogue.perf/1",
            good.replace('"passed"', '"perhaps"'): "neither passed nor failed",
            good.replace("gas-step/cuda/8192", "gas-step/cuda"): "is not gas-step/BACKEND/CELLS",
            good.replace('"median": 5e-06', '"median": NaN'): "the median of gas-step/cuda/8192 is no time",
            good.replace('"interval": [', '"interval": [0, '): "is not two times",
            good.replace('"case": "gas-step/cuda/8192", ', ""): "names no case",
            json.dumps(blocks | {"facts": blocks["facts"] | {"block": "64"}}): "fact 'block' of",
            json.dumps(blocks | {"facts": blocks["facts"] | {"cells": 0}}): "fact 'cells' of",
            json.dumps(blocks | {"facts": 3}): "is no JSON object",
            good.replace('"flops": 10649600', '"flops": "many"'): "fact 'flops' of",
            good.replace('"flops": 10649600', '"flops": 1e300'): "fact 'flops' of",
            good.replace('"median": 5e-06', '"median": 1e-200'): "the median of gas-step/cuda/8192 is no time",
            json.dumps(records.scaling()[3] | {"facts": records.scaling()[0]["facts"]}): "fact 'ranks' of",
            json.dumps(records.scaling()[0] | {"case": "scaling"}): "'scaling' names no kernel of gas",
            good.replace("gas-step/cuda/8192", "flow-pressure/cuda/8x8/fft"): "is not flow-pressure/BACKEND/NXxNYxNZ/",
            json.dumps(batch | {"facts": batch["facts"] | {"method": "fft"}}): "is none of seed, pide",
            json.dumps(records.abstraction()[0] | {"case": "abstraction/cuda"}): "names no kernel of gas",
        }
        for line, words in cases.items():
            with self.subTest(words):
                self.assertNotEqual(line, good)
                (self.folder / "b.jsonl").write_text(good + "\n\n" + line + "\n")
                code, files, sentence = plot(self.folder)
                self.assertEqual((code, files, sentence.count("\n")), (3, [], 1), sentence)
                self.assertTrue(sentence.startswith(f"{self.folder / 'b.jsonl'}:3: "), sentence)
                self.assertIn(words, sentence)

    def test_rejects_files_without_records(self):
        (self.folder / "a.jsonl").write_text("\n")
        code, _, sentence = plot(self.folder)
        self.assertEqual((code, sentence), (3, f"{self.folder / 'a.jsonl'}: the file holds no records.\n"))
        (self.folder / "a.jsonl").write_bytes(b"\n\xff\xfe")
        code, _, sentence = plot(self.folder)
        self.assertEqual((code, sentence), (3, f"{self.folder / 'a.jsonl'}:2: the file is no text in UTF-8.\n"))
        (self.folder / "a.jsonl").unlink()
        (self.folder / "a.jsonl").mkdir()
        self.assertEqual(plot(self.folder)[0], 6)

    def test_rejects_norm_without_study(self):
        records.write(self.folder / "a.jsonl", records.ceilings())
        code, files, sentence = plot(self.folder, "--norm", "l1_density")
        self.assertEqual((code, files), (2, []))
        self.assertIn("no study", sentence)
