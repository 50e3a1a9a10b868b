"""Numbers and figures of pages of synthetic records that obey known power laws."""

import unittest

import packages  # noqa: F401, before modules that need the packages  isort: skip
import numpy as np
import synthetic_records as records
from evidence_pages import Folder
from plot.evidence import goal as goals
from plot.evidence.block_sizes import blocks_figure, times
from plot.evidence.records import read_records
from plot.evidence.roofline import ceilings, points, roofline_figure
from plot.evidence.steps import measured, vector_bits, verdict
from plot.evidence.transfers import core_times, transfers_figure
from plot.evidence.transfers import times as transfer_times
from plot.evidence.work_precision import (
    TimeToError, best_scheme, curves, faster_range, speed_up, target_errors, time_to_error,
)
from plot.evidence.work_precision_figure import solution_figure
from plot.gas.goals import GOALS


def law(cost, power, size, order, meshes=(100, 200, 400, 800)):
    """Points (n, time, error) with time = cost n^power and error = size n^-order."""
    return np.array([(n, cost * n**power, size * n**-order) for n in meshes])


class Numbers(unittest.TestCase):
    def test_time_to_error_is_exact_on_power_law(self):
        points_ = law(2e-9, 2.0, 3.0, 1.5)
        for error in (2.9e-3, 1.1e-3, 2e-4):
            time = time_to_error(points_, error)
            self.assertEqual(time.bound, "")
            self.assertAlmostEqual(time.seconds / (2e-9 * (3.0 / error) ** (2.0 / 1.5)), 1.0, delta=1e-12)
        self.assertEqual(time_to_error(points_, 1e-5), TimeToError(points_[-1, 1], ">"))
        self.assertEqual(time_to_error(points_, 0.1), TimeToError(points_[0, 1], "<"))
        self.assertEqual(time_to_error(points_, points_[0, 2]), TimeToError(points_[0, 1]))

    def test_time_to_error_takes_first_crossing_of_nonmonotone_curve(self):
        points_ = np.array([(1, 1.0, 1e-1), (2, 2.0, 1e-3), (4, 4.0, 1e-2), (8, 8.0, 1e-4)])
        self.assertAlmostEqual(time_to_error(points_, 1e-2).seconds, 2**0.5, delta=1e-12)

    def test_speed_up_propagates_bounds(self):
        self.assertEqual(speed_up(TimeToError(6.0), TimeToError(2.0)), TimeToError(3.0))
        self.assertEqual(speed_up(TimeToError(6.0, ">"), TimeToError(2.0)), TimeToError(3.0, ">"))
        self.assertEqual(speed_up(TimeToError(6.0, ">"), TimeToError(2.0, "<")), TimeToError(3.0, ">"))
        self.assertEqual(speed_up(TimeToError(6.0), TimeToError(2.0, ">")), TimeToError(3.0, "<"))
        self.assertIsNone(speed_up(TimeToError(6.0, ">"), TimeToError(2.0, ">")))
        self.assertIsNone(speed_up(TimeToError(6.0, "<"), TimeToError(2.0, "<")))

    def test_faster_range_finds_crossover_of_two_orders(self):
        cheap, high = law(1e-9, 2.0, 1.0, 1.0, (100, 12800)), law(8e-9, 2.0, 100.0, 2.0, (10, 3200))
        # t = 1e-9 / e^2 and t = 8e-7 / e meet at e = 1/800.
        where, error = faster_range(cheap, high)
        self.assertEqual(where, "below")
        self.assertAlmostEqual(error / (1 / 800), 1.0, delta=0.02)
        self.assertEqual(faster_range(law(1e-6, 2.0, 1.0, 1.0), high), ("everywhere", None))
        self.assertEqual(faster_range(law(1e-12, 2.0, 1.0, 1.0), high), ("nowhere", None))
        self.assertEqual(faster_range(cheap, law(1e-9, 2.0, 1e-9, 1.0)), ("", None))

    def test_verdict_compares_median_with_goal_and_stretch(self):
        time = goals.Goal("c", goals.STEP_US, 5.0, 3.0)
        rate = goals.Goal("c", goals.RATE, 8.5, 10.0)
        cases = [
            (time, 5.0, "goal met"), (time, 3.0, "stretch met"), (time, 5.5, "missed by 10 %"),
            (time, 5.01, "missed by 0.2 %"), (rate, 8.5, "goal met"), (rate, 11.0, "stretch met"),
            (rate, 6.8, "missed by 20 %"), (time, 1.5, "stretch met 2 times over"), (time, 0.1, "stretch met 30 times over"),
            (goals.Goal("c", goals.RATE, 8.0), 40.0, "goal met 5 times over"),
        ]
        for goal, value, words in cases:
            self.assertEqual(verdict(goal, value), words)


class Solutions(Folder):
    def test_table_reproduces_times_factors_and_orders_of_power_laws(self):
        page, files = self.page(records.solutions(problems=("sod",), backends=("serial", "cuda")))
        self.assertEqual(files, ["gas.html", "solution_sod_nvidia-h200.png"])
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "Sod: error against time"]
        heading, usual = rows[0], [row for row in rows if row[0] != "backend"]
        self.assertEqual(heading[:4], ["backend", "scheme", "cells", "order"])
        by_scheme = {(row[0], row[1]): row for row in usual}
        # MUSCL-Hancock on 800 cells: 2 n steps of 0.12 x 6e-8 n s; WENO-Z: its error is 0.0096 (n / 100)^-0.9.
        error = 2.5 * 0.012 * 8**-0.85
        self.assertEqual(heading[4], f"to {error * 1e3:.3g}".rstrip("0") + "×10−3")
        own = 2 * 1.05 * 6e-8 * (100 * (0.8 * 0.012 / error) ** (1 / 0.9)) ** 2
        other = 2 * 0.12 * 6e-8 * 800**2
        row = by_scheme["Serial", "WENO-Z"]
        self.assertEqual(row[2:6], ["100–3200", "0.90", f"{own * 1e3:.3g} ms", f"{other / own:.3g}"])
        self.assertEqual(by_scheme["Serial", "MUSCL-Hancock"][3:6], ["0.85", f"{other * 1e3:.3g} ms", ""])
        self.assertEqual(by_scheme["CUDA", "WENO-Z"][5::2], ["", "", ""])
        self.assertIn("Serial is compared with Serial", page.words)
        self.assertIn(("Serial", "WENO-Z, lf-global, ssprk43, split"), by_scheme)

    def test_lists_failed_runs_and_does_not_draw_them(self):
        lines = records.solutions(problems=("leblanc",), backends=("serial",), meshes=(100, 200))
        page, _ = self.page(lines)
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "LeBlanc: error against time"]
        self.assertNotIn("TENO5", [row[1] for row in rows])
        self.assertRegex(
            page.words,
            r"TENO5, Serial, 100, 200 cells: numerical-failure \(negative pressure in cell 41 .*\)",
        )
        evidence = self.evidence(lines)
        found = curves(evidence.records)
        self.assertNotIn("teno5", {curve.scheme.key for curve in found})

    def test_problem_without_solution_shows_only_failures(self):
        lines = records.solutions(problems=("leblanc",), backends=("serial",), meshes=(100,))
        page, files = self.page([line for line in lines if line["facts"]["weno"] == "teno5"])
        self.assertEqual(files, ["gas.html"])
        self.assertIn("negative pressure in cell 41", page.words)

    def test_omits_factors_without_competitor(self):
        lines = records.solutions(problems=("sod",), backends=("openmp",), meshes=(100, 200, 400))
        page, _ = self.page(lines)
        heading = next(iter(page.tables.values()))[0]
        self.assertNotIn("factor", heading)
        self.assertEqual(sum(word.startswith("to ") for word in heading), 3)
        self.assertNotIn("MUSCL-Hancock", page.words)

    def test_omits_factors_that_no_scheme_has(self):
        lines = records.solutions(problems=("sod",), backends=("serial",), meshes=(100, 200, 400))
        others = records.solutions(problems=("sod",), backends=("cuda",), meshes=(100, 200, 400))
        rival = [line for line in lines if line["facts"]["weno"] == "muscl-hancock"]
        page, _ = self.page([*rival, *(line for line in others if line["facts"]["weno"] != "muscl-hancock")])
        heading = next(iter(page.tables.values()))[0]
        self.assertNotIn("factor", heading)
        self.assertNotIn("faster at errors", heading)

    def test_best_scheme_reaches_error_of_competitor_first(self):
        found = curves(self.evidence(records.solutions(problems=("sod",), backends=("serial",))).records)
        self.assertEqual(best_scheme(found), "z")
        errors = target_errors(found)
        self.assertEqual(errors, sorted(errors, reverse=True))
        self.assertAlmostEqual(errors[1], 2.5 * 0.012 * 32**-0.85, delta=1e-9)

    def test_legends_and_titles_of_figure_do_not_overlap(self):
        found = curves(self.evidence(records.solutions(problems=("sod",), backends=("serial",))).records)
        machine = read_records(self.folder).machines[0]
        figure = solution_figure("sod", machine, found, "z", "")
        self.assertEqual([len(axes.lines) for axes in figure.axes], [6, 6, 6])
        figure.canvas.draw()
        renderer = figure.canvas.get_renderer()
        self.assert_apart(figure.texts, figure.bbox)
        for axes in figure.axes:
            self.assertGreaterEqual(axes.yaxis.label.get_window_extent(renderer).x0, 0)


class Steps(Folder):
    def test_gpu_steps_show_costs_and_verdicts(self):
        page, _ = self.page(records.steps_of_h200())
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "A step"]
        self.assertIn(["CUDA", "", "8\u2009192", "5.2 [5.1 .. 5.3]", "0.635", "1.58"], rows)
        verdicts = {(row[0], row[1]): row[2:] for row in rows if len(row) == 7}
        self.assertEqual(
            verdicts["CUDA, 8192 cells", "µs per step"], ["5.2 [5.1 .. 5.3]", "4.47", "5", "3", "missed by 4 %"]
        )
        self.assertEqual(verdicts["CUDA, 65536 cells", "µs per step"][-1], "stretch met")
        self.assertEqual(verdicts["CUDA, 16 M cells", "G cell-steps/s"][-1], "missed by 2 %")
        self.assertEqual(verdicts["CUDA, 16 M cells, split", "G cell-steps/s"][-1], "goal met")
        on = verdicts["CUDA, 16 M cells, on, against cuda/16777216", "times as long"]
        self.assertEqual(on, ["2.88 [2.77 .. 3]", "", "1.25", "1.1", "missed by 130 %"])

    def test_core_verdicts_require_vector_width_and_same_run(self):
        page, _ = self.page(records.steps_of_core())
        table = page.tables["AMD EPYC", "A step"]
        start = next(k for k, row in enumerate(table) if row[-1] == "verdict")
        rows, goal = table[start + 1 :], table[start].index("goal")
        self.assertEqual([row[goal] for row in rows], ["68", "6", "0.85"])
        self.assertEqual([row[2].split()[0] for row in rows], ["50", "8", "0.9"])
        self.assertEqual({row[-1] for row in rows}, {"goal met"})
        later = records.steps_of_core()
        for line in later:
            if "dense" in line["case"]:
                line["provenance"]["date"] = "2026-11-23T05:00:00Z"
        page, _ = self.page(later)
        self.assertIn("dense-loop/8192 is not in the same run", page.words)

    def test_reads_vector_width_from_facts_or_flags(self):
        lines = records.steps_of_core()[1:2]
        for flags, facts, wanted in (
            ("-O3 -march=x86-64-v4", {}, 512), ("-mavx512f -mprefer-vector-width=256", {}, 256), ("-O3", {}, None),
            ("-O3", {"vector_bits": 512}, 512),
        ):
            lines[0]["provenance"]["flags"] = flags
            lines[0]["facts"] = facts
            self.assertEqual(vector_bits(self.evidence(lines).records[0]), wanted)
        lines[0]["facts"] = {}
        page, _ = self.page(lines)
        self.assertIn("(if its vectors have 512 bits)", page.words)

    def test_goals_do_not_apply_to_host_backends_of_cuda_build(self):
        lines = records.steps_of_core(records.H200)
        for line in lines:
            line["provenance"]["compiler"] = "GNU 12.2.0, nvcc 13.0.88 sm_90"
        page, _ = self.page(lines)
        self.assertNotIn("Against the goals", page.words)

    def test_interval_of_ratio_contains_all_quotients(self):
        lines = self.evidence(records.steps_of_core()).records
        by_case = {line.case: line for line in lines}
        goal = next(goal for goal in GOALS if goal.measure == goals.SPEED_UP)
        value, low, high = measured(goal, by_case[goal.case], by_case[goal.compared_case])
        self.assertAlmostEqual(value, 8.0, delta=1e-12)
        self.assertAlmostEqual(low, 8 * 0.98 / 1.02, delta=1e-12)
        self.assertAlmostEqual(high, 8 * 1.02 / 0.98, delta=1e-12)

    def test_derives_missing_facts_from_case_name(self):
        lines = records.steps_of_h200()
        for line in lines:
            del line["facts"]
        page, _ = self.page(lines)
        self.assertIn("missed by 4 %", page.words)


class Devices(Folder):
    def test_roofline_shows_ceilings_and_shares(self):
        page, files = self.page(records.ceilings() + records.steps_of_h200())
        self.assertEqual(files, ["gas.html", "roofline_cuda_nvidia-h200.png"])
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "Roofline, CUDA"]
        self.assertIn(["FP64 arithmetic", "33 TFLOP/s"], rows)
        rate = 1300 * 8192 / 5.2e-6
        shares = [f"{100 * rate / 33e12:.3g}", f"{100 * rate / (1300 / 72) / 4.2e12:.3g}"]
        self.assertEqual(next(row for row in rows if row[0] == "8\u2009192")[4:6], shares)

    def test_labels_of_roofline_fit_and_do_not_overlap(self):
        evidence = self.evidence(records.ceilings() + records.steps_of_h200())
        machine = evidence.machines[0]
        tops, found = (ceilings(evidence.select(machine, "ceiling")), points(evidence.select(machine, "gas-step")))
        self.assertEqual([point.cells for point in found], [1024, 8192, 65536, 1 << 20, 1 << 24])
        figure = roofline_figure("Roofline", machine, tops, found)
        self.assert_apart([text for text in figure.axes[0].texts if text.get_rotation() == 0], figure.bbox)

    def test_transfers_show_times_and_factors_of_dissertation(self):
        page, files = self.page(records.transfers())
        self.assertEqual(files, ["gas.html", "transfers_cuda_nvidia-h200.png"])
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "Transfers of a step, CUDA"]
        self.assertEqual(len(rows), 1 + 5 * 8)
        self.assertEqual([row[1] for row in rows[1:6]], ["[Shi]", "pageable", "pinned", "ours, pageable", "ours, pinned"])
        self.assertEqual(rows[1], ["1\u2009024", "[Shi]", "336", "118", "272", "726", ""])
        self.assertEqual(rows[3], ["1\u2009024", "pinned", "16.8", "40", "13.6", "70.4", "10.3"])
        self.assertEqual(rows[5], ["1\u2009024", "ours, pinned", "1", "5", "1", "7", "104"])

    def test_transfers_draw_computation_on_one_core(self):
        found = []
        for line in records.transfers():
            facts = line["facts"]
            core = {"cpu_s": 2e-4 if facts.get("method") == "ours" else 8e-4}
            printed = {"cpu_us": 6896} if facts["cells"] > 1024 else {}
            found.append(line | {"facts": facts | core | {"thesis": facts["thesis"] | printed}})
        evidence = self.evidence(found)
        curves = core_times(transfer_times(evidence.records))
        meshes = range(1024, 8193, 1024)
        self.assertEqual({"[Shi]": dict.fromkeys(meshes[1:], 6896.0), "its scheme": dict.fromkeys(meshes, 800.0),
                          "ours": dict.fromkeys(meshes, 200.0)}, curves)
        bars, *_, core = axes = transfers_figure("Transfers", evidence.machines[0], evidence.records).axes
        self.assertEqual(["[Shi]", "pageable", "pinned", "ours, pageable", "ours, pinned", "computation on one core"],
                         [panel.get_title("left") for panel in axes])
        self.assertEqual((3, "log", "linear"), (len(core.lines), core.get_yscale(), bars.get_yscale()))
        self.assertEqual(bars.get_ylim(), axes[1].get_ylim())
        self.assertNotEqual(bars.get_ylim(), axes[3].get_ylim())
        page, _ = self.page(found)
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "Transfers of a step, CUDA"]
        self.assertEqual(["one core (µs)", "", "800", "800", "200", "200"], [row[6] for row in rows[:6]])

    def test_block_sizes_have_panel_per_form_and_curve_per_size(self):
        evidence = self.evidence(records.blocks())
        forms = {
            form: times([line for line in evidence.records if line.facts["form"] == form])
            for form in ("seed", "step")
        }
        figure = blocks_figure("Blocks", evidence.machines[0], forms, "step")
        self.assertEqual([len(axes.lines) for axes in figure.axes], [5, 5])
        page, _ = self.page(records.blocks())
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "Block size, CUDA"]
        self.assertEqual(rows[1][:4], ["1\u2009024", "6.35", "6.24", "6.02"])
        self.assertIn("The flux kernel of [Shi]; the fastest block of a mesh is marked", page.words)
        self.assertIn("[Shi]: Qiangqiang Shi", page.words)

    def test_block_sizes_of_flow_and_canopies_have_own_pictures(self):
        _, files = self.page(records.flow_blocks(), "flow")
        self.assertEqual(
            files,
            ["blocks_flow_cuda_nvidia-h200.png", "blocks_parachute_cuda_nvidia-h200.png", "flow.html"],
        )


class Ladders(Folder):
    def test_rungs_show_prediction_and_gain(self):
        page, files = self.page(records.ladder() + records.ladder("springs"), app="ladder")
        self.assertEqual(["ladder-springs_serial_amd-epyc.png", "ladder-weno_serial_amd-epyc.png", "ladder.html"], files)
        rows = page.tables["AMD EPYC", "Ladder weno, Serial"]
        self.assertEqual(["naive port", "resident", "fused stages"], [row[0] for row in rows[1:]])
        self.assertEqual(
            ["fused stages", "1\u2009000", "arithmetic", "2\u2009000", "1\u2009960 .. 2\u2009040", "4", "1\u00d710\u22124"], rows[3]
        )

    def test_figure_holds_every_rung(self):
        from plot.evidence.ladders import ladder_figure

        evidence = self.evidence(records.ladder())
        figure = ladder_figure("Ladder weno", evidence.machines[0], evidence.records)
        figure.canvas.draw()
        axis = figure.axes[0]
        self.assertEqual(["naive port", "resident", "fused stages"], [text.get_text() for text in axis.get_yticklabels()])
        renderer = figure.canvas.get_renderer()
        for text in axis.get_yticklabels():
            self.assertGreaterEqual(text.get_window_extent(renderer).x0, 0)


class Springs(Folder):
    def springs_page(self, lines):
        return self.page(lines, "springs")

    def test_table_shows_times_to_fixed_errors(self):
        page, files = self.springs_page(records.springs_solutions())
        self.assertEqual(files, [f"solution_{name}_amd-epyc.png" for name in ("catenary", "drum")] + ["springs.html"])
        rows = page.tables["AMD EPYC", "Drum: error against time"]
        self.assertEqual(rows[0], ["backend", "scheme", "vertices", "order", "to 0.01", "to 1×10−3", "to 1×10−4"])
        by_scheme = {row[1]: row for row in rows}
        # Error 1 / n of n vertices, a step of 1e-7 n s, 10 sqrt(n) steps: to 0.001 in 1e-6 n^1.5 s.
        seconds = 1e-6 * 1000**1.5
        row = by_scheme["biquadratic"]
        self.assertEqual(row[2:], ["60–3840", "2.00", "1 ms", f"{1e3 * seconds:.3g} ms", "> 238 ms"])
        self.assertEqual(by_scheme["biquadratic, equal"][3:5], ["1.00", "> 238 ms"])
        self.assertEqual(by_scheme["biquadratic, verlet"][5], f"{400 * seconds:.3g} ms")
        rows = page.tables["AMD EPYC", "Catenary: error against time"]
        self.assertEqual({row[1]: row[3] for row in rows[1:]}["string"], "2.00")
        self.assertNotIn("factor", rows[0])

    def test_figure_shows_models_above_settings(self):
        found = curves(self.evidence(records.springs_solutions()).records[:28])
        machine = read_records(self.folder).machines[0]
        self.assertEqual(best_scheme(found), "biquadratic")
        figure = solution_figure("drum", machine, found, "biquadratic", "")
        self.assertEqual([len(axes.lines) for axes in figure.axes], [1, 4])
        self.assertEqual(figure.axes[0].get_ylabel(), "relative error of the frequency")

    def test_steps_and_contact_show_verdicts(self):
        page, _ = self.springs_page(records.springs_steps())
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "A step"]
        self.assertEqual(rows[0][2:], ["vertices", "µs per step", "ns per vertex-step", "G vertex-steps/s"])
        verdicts = {(row[0], row[1]): row[-1] for row in rows if len(row) == 7}
        self.assertEqual(verdicts["CUDA, 2640 vertices", "µs per step"], "missed by 2 %")
        self.assertEqual(verdicts["CUDA, 1000000 vertices", "ns per vertex-step"], "missed by 40 %")
        quadratic = "CUDA, 1000000 vertices, quadratic, against cuda/1000000"
        self.assertEqual(verdicts[quadratic, "times as long"], "goal met")
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "A step in contact"]
        self.assertEqual([row[-1] for row in rows][-3:], ["verdict", "stretch met", "missed by 50 %"])

    def test_transfers_show_panel_per_number_of_steps_and_no_ratio(self):
        page, files = self.springs_page(records.springs_transfers())
        self.assertEqual(files, ["springs-transfers_cuda_nvidia-h200.png", "springs.html"])
        rows = page.tables["NVIDIA H200, Intel Xeon Processor", "Transfers of a step, CUDA"]
        steps = ["1 step", "10 steps", "100 steps"]
        sources = ["between two copies", "[Shi]", *steps, *(f"{words}, pinned" for words in steps)]
        self.assertEqual([row[1] for row in rows], sources)
        self.assertNotIn("times as fast", " ".join(rows[0]))
        self.assertIn("no ratio to it means anything", page.words)

    def test_each_app_has_its_own_page(self):
        lines = records.springs_transfers() + records.transfers()
        page, files = self.springs_page(lines)
        self.assertEqual([name for name in files if name.endswith("html")], ["gas.html", "springs.html"])
        self.assertEqual(len(page.tables), 1)
