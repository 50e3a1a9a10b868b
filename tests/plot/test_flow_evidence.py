"""Page of synthetic records of flow."""


import packages  # before modules that need the packages  isort: skip
import synthetic_records as records
from evidence_pages import Folder
from plot.flow.published_results import PUBLISHED_RESULTS

H200 = "NVIDIA H200, Intel Xeon Processor"


class Page(Folder):
    def test_steps_have_goals_and_the_time_of_their_traffic(self):
        page, _ = self.page(records.flow_steps() + records.ceilings(memory=4e12), app="flow")
        rows = page.tables[H200, "A step"]
        large = next(row for row in rows if row[1] == "periodic")
        # 296 bytes at 4 TB/s are 0.074 ns.
        self.assertEqual(("0.16", "0.074"), (large[4], large[-1]))
        verdicts = {row[0]: row[-1] for row in rows if "goal met" in row[-1] or "missed" in row[-1]}
        self.assertEqual(
            {"CUDA, 16 M cells, periodic": "goal met", "CUDA, 432000 cells, tunnel": "missed by 100 %"}, verdicts
        )

    def test_without_ceilings_there_is_no_time_of_traffic(self):
        page, _ = self.page(records.flow_steps(), app="flow")
        self.assertNotIn("memory traffic alone", page.words)

    def test_flights_have_goals_in_real_time(self):
        page, _ = self.page(records.flights(), app="flow")
        self.assertIn("ms per s of flight", page.words)
        self.assertIn("goal met", page.words)

    def test_transfers_of_parachutes_have_a_panel_per_number_of_steps(self):
        page, files = self.page(records.parachute_transfers(), app="flow")
        self.assertIn("parachute-transfers_cuda_nvidia-h200.png", files)
        rows = page.tables[H200, "Transfers of a step, CUDA"][1:]
        self.assertEqual(["1 step, pinned", "20 steps, pinned"], [row[1] for row in rows])
        self.assertNotIn("Times of [Shi]", page.words)

    def test_pressure_solvers_have_tolerances_and_iterations(self):
        page, _ = self.page(records.flow_solvers(), app="flow")
        rows = page.tables[H200, "Pressure solvers"][1:]
        self.assertEqual(
            [["transforms", "round-off", "0.02", ""], ["hypre PFMG", "1e-06", "250", "9"]],
            sorted(([row[3], row[4], row[5], row[7]] for row in rows), key=lambda row: float(row[2])),
        )

    def test_tolerances_of_pressure_solvers_come_from_their_cases_without_facts(self):
        lines = records.flow_solvers()
        for line in lines:
            line["facts"].pop("tolerance", None)
        usual = [dict(line, case=line["case"].removesuffix("/1e-6")) for line in lines if line["case"].endswith("/1e-6")]
        page, _ = self.page([*lines, *usual], app="flow")
        rows = page.tables[H200, "Pressure solvers"][1:]
        self.assertEqual({("transforms", "round-off"), ("hypre PFMG", "1e-06"), ("hypre PFMG", "1e-10")}, {(row[3], row[4]) for row in rows})

    def test_memory_is_given_per_cell(self):
        page, _ = self.page(records.flow_solvers(), app="flow")
        self.assertEqual(["124", "140"], page.tables[H200, "Memory"][1][3:])
        self.assertEqual("CUDA", page.tables[H200, "Memory"][1][0])

    def test_solutions_are_drawn_with_the_published_results(self):
        page, files = self.page(records.flow_solutions(), app="flow")
        pictures = [f"solution_{problem}_nvidia-h200.png" for problem in ("drifting-vortices", "resting-vortices")]
        self.assertEqual(["flow.html", *pictures], files)
        rows = page.tables[H200, "Drifting vortices of Taylor and Green: error against time"]
        defaults = [row for row in rows if row[:2] == ["CUDA", "WENO-Z"]]
        self.assertEqual("2.00", defaults[0][3])
        self.assertIn("peclet-flow", page.words)

    def test_cavity_on_cuda_has_matrix_products_as_its_default(self):
        page, files = self.page(records.cavity_solutions(), app="flow")
        self.assertIn("solution_cavity_nvidia-h200.png", files)
        rows = page.tables[H200, "Lid-driven cavity: error against time"]
        names = [row[1] for row in rows if row[0] == "CUDA"]
        # Only the time scheme differs from the default.
        self.assertEqual({"WENO-Z", "WENO-Z, RK3"}, set(names))
        # 0.01 is met by 31.6 cells per axis, in 0.1 s.
        default = next(row for row in rows if row[:2] == ["CUDA", "WENO-Z"])
        self.assertEqual("100 ms", default[rows[0].index("to 0.01")])

    def test_openings_of_canopies_follow_the_solutions_of_flow(self):
        page, files = self.page(records.flow_solutions() + records.openings(), app="flow")
        self.assertIn("solution_drifting-vortices_nvidia-h200.png", files)
        self.assertIn("solution_opening-impulse_nvidia-h200.png", files)
        self.assertIn("solution_porous-drag_nvidia-h200.png", files)
        rows = page.tables[H200, "Opening C-9: impulse: error against time"]
        names = {"B-splines 4-3", "B-splines 4-3, inset 0.55"}
        self.assertEqual(names | {f"{name}, edges of 0.35 cells" for name in names}, {r[1] for r in rows if r[0] == "CUDA"})
        # An error of 0.1 is met by 20 cells, in 0.08 s.
        default = next(row for row in rows if row[:2] == ["CUDA", "B-splines 4-3"])
        self.assertEqual("80 ms", default[rows[0].index("to 0.1")])

    def test_published_times_are_those_of_their_cost_per_cell_and_step(self):
        # 128^3 cells, 82 steps of 0.25 h to 1 s, 5.22 ns per cell and step.
        seconds, error = PUBLISHED_RESULTS[0].points[0]
        self.assertAlmostEqual(5.22e-9 * 128**3 * 81.5, seconds, delta=0.01 * seconds)
        self.assertEqual(1.7e-5, error)
