"""Speeds and drag coefficients of canopies as scripts/studies/measure_descent.py measures them, on made histories."""

import csv
import math
import os
import subprocess
import sys
from pathlib import Path

SOURCE = os.environ["DROGUE_SOURCE"]
SCRIPT = Path(SOURCE) / "scripts/studies/measure_descent.py"
sys.path.insert(0, str(SCRIPT.parent))

from folder_test import FolderTest
import measure_descent

DENSITY, AREA, PERIOD = 1.25, 0.25 * math.pi * 8.0**2, 2.5


def scene(width=20.0, cells=40, gravity="[0, 0, -9.81]", canopies=1, velocity="[0.0, 0.0, 5.0]", skirt=""):
    """A scene.toml of a canopy of 8 m in a square box of cells of width / cells, 30 m long."""
    canopy = f'[[canopy]]\nkind = "flat-circular"\ndiameter = 8.0\n{skirt}\n'
    return (f"[fluid]\ndensity = {DENSITY}\nvelocity = {velocity}\n"
            f"[grid]\ncells = [{cells}, {cells}, {cells}]\n"
            f"domain = [[{-width / 2}, {width / 2}], [{-width / 2}, {width / 2}], [-10, 20]]\n"
            + canopies * canopy + f"[coupling]\ngravity = {gravity}\n")


def rows(force=900.0, down=4.0, across=3.0, breathing=0.5, end=40.0, trend=None):
    """A descent that breathes; the stream of 5 m/s is the frame of the payload. `trend` multiplies the force, per period."""
    for step in range(round(end * 40) + 1):
        time = step / 40
        speed = down + breathing * math.sin(2 * math.pi * time / PERIOD)
        factor = 1.0 if trend is None else trend(math.floor(time / PERIOD))
        yield {"time [s]": time, "step": step, "canopy_0_force_x [N]": 7.0, "canopy_0_force_y [N]": 0.0,
               "canopy_0_force_z [N]": factor * force, "canopy_0_line_force_x [N]": 0.0, "canopy_0_line_force_y [N]": 250.0,
               "canopy_0_line_force_z [N]": 600.0, "canopy_0_payload_velocity_x [m/s]": across,
               "canopy_0_payload_velocity_y [m/s]": 0.0, "canopy_0_payload_velocity_z [m/s]": 5.0 - speed}


class Descent(FolderTest):
    def run_of(self, name="run", text=None, history=None):
        """Folder of a made run."""
        made = self.folder / name
        made.mkdir()
        (made / "scene.toml").write_text(scene() if text is None else text, encoding="utf-8")
        lines = list(rows() if history is None else history)
        with open(made / "history.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, lines[0])
            writer.writeheader()
            writer.writerows(lines)
        return made

    def measure(self, *words, code=0):
        done = subprocess.run([sys.executable, "-B", SCRIPT, *map(str, words), "--period", str(PERIOD)],
                              capture_output=True, text=True, check=False)
        self.assertEqual(code, done.returncode, done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        return done.stdout if code == 0 else done.stderr

    def numbers(self, *words):
        """Values and errors of the last run, by the places of the columns."""
        line = [line for line in self.measure(*words).splitlines() if line.startswith("|")][-1]
        return [[float(part) for part in cell.split("±")] for cell in line.strip("| ").split("|")[1:]]

    def test_corrects_speeds_and_coefficients_for_blockage(self):
        cells, section, periods, down, across, glide, lean, drag, by_speed, ratio, free_down, free_drag, free_by_speed = (
            self.numbers(self.run_of(history=rows(breathing=0.0)), "--blockage", "2"))
        self.assertEqual(([0.75], [400.0], [14.0]), (cells, section, periods))
        self.assertEqual(([4.0, 0.0], [3.0, 0.0], [0.75, 0.0]), (down, across, glide))
        self.assertEqual([22.6, 0.0], lean)  # tan 250 / 600
        # 2 F / (rho S0) over 4^2 and 5^2; the stream has 1 + 2 * 2 F / (rho 5^2 A) times its dynamic pressure.
        unit = 2 * 900 / (1.25 * math.pi * 16)
        self.assertAlmostEqual(unit / 16, drag[0], delta=6e-4)
        self.assertAlmostEqual(unit / 25, by_speed[0], delta=6e-4)
        self.assertAlmostEqual(1 + 2 * 2 * 900 / (1.25 * 25 * 400), ratio[0], delta=6e-4)
        self.assertAlmostEqual(4 * math.sqrt(1.288), free_down[0], delta=6e-3)
        self.assertAlmostEqual(unit / 16 / 1.288, free_drag[0], delta=6e-4)
        self.assertAlmostEqual(unit / 25 / 1.288, free_by_speed[0], delta=6e-4)

    def test_boxes_of_all_widths_have_the_drag_of_free_air(self):
        coefficients = []
        for width in (15.0, 20.0, 40.0):
            # A canopy of C 0.8 by speed, which Maskell's relation slows down in the box.
            section = width**2
            square = 2 * 900 / (DENSITY * AREA * 0.8) - 1.85 * 2 * 900 / (DENSITY * section)
            history = rows(down=0.8 * math.sqrt(square), across=0.6 * math.sqrt(square), breathing=0.0)
            coefficients.append(self.numbers(self.run_of(f"{width:g}", scene(width), history))[-2:])
        for drag, by_speed in coefficients:
            self.assertAlmostEqual(0.8, by_speed[0], delta=1e-3)
            self.assertAlmostEqual(0.8 / 0.64, drag[0], delta=1e-3)

    def test_whole_periods_take_breathing_out_of_the_mean(self):
        down = self.numbers(self.run_of(), "--to", "39.5")[3]
        self.assertAlmostEqual(4.0, down[0], delta=5e-3)
        self.assertLess(down[1], 5e-3)

    def test_errors_are_those_of_means_over_periods(self):
        found = self.numbers(self.run_of(history=rows(breathing=0.0, trend=lambda block: 1.1 if block % 2 else 0.9)))
        count, drag = found[2][0], found[7]
        # Fourteen means of 0.9 and 1.1 times the whole have the standard deviation 0.1 sqrt(14 / 13).
        self.assertEqual(14, count)
        self.assertAlmostEqual(0.1 / math.sqrt(13) * drag[0], drag[1], delta=2e-3)

    def test_held_canopies_lie_in_the_stream(self):
        history = [{**row, "canopy_0_payload_velocity_x [m/s]": 0.0, "canopy_0_payload_velocity_z [m/s]": 0.0} for row in rows()]
        found = self.numbers(self.run_of(text=scene(gravity="[0, 0, 0]"), history=history))
        self.assertEqual(([5.0, 0.0], [0.0, 0.0]), (found[3], found[4]))
        self.assertEqual(found[7], found[8])
        self.assertAlmostEqual(2 * 900 / (DENSITY * AREA * 25), found[7][0], delta=6e-4)

    def test_slack_lines_do_not_lean(self):
        def lean(name, up, taut):
            """With lines that pull in the steps that are `taut`, "up" along z in the direction of `up`."""
            history = [{**row, "canopy_0_line_force_y [N]": 250.0 * taut(row["step"]),
                        "canopy_0_line_force_z [N]": up * 600.0 * taut(row["step"])} for row in rows()]
            return self.numbers(self.run_of(name, scene(gravity=f"[0, 0, {-9.81 * up}]"), history))[6][0]

        for up in (1, -1):
            self.assertEqual(0.0, lean(f"slack {up}", up, lambda step: 0.0))
            self.assertEqual(22.6, lean(f"jerks {up}", up, lambda step: float(step % 4 == 0)))

    def test_skirts_count_in_the_nominal_area(self):
        text = scene(skirt="skirt = { length = 1.0, diameter = 7.0 }")
        ratio = self.numbers(self.run_of("with", text))[7][0] / self.numbers(self.run_of("without"))[7][0]
        self.assertAlmostEqual(AREA / (AREA + math.pi * 7.5), ratio, delta=1e-3)

    def test_limit_is_that_of_the_line_through_the_grids(self):
        folders = []
        for cells in (20, 25, 40):
            h = 30.0 / cells
            free = 0.7 + 0.2 * h
            square = 2 * 900 / (DENSITY * AREA * free) - 1.85 * 2 * 900 / (DENSITY * 400)
            folders.append(self.run_of(f"{cells}", scene(cells=cells), rows(down=math.sqrt(square), across=0.0, breathing=0.01)))
        value = float(self.measure(*folders, "--limit").splitlines()[-2].split(":")[1].split("±")[0])
        self.assertAlmostEqual(0.7, value, delta=5e-3)

    def test_limit_weights_by_the_errors_and_propagates_them(self):
        # The line passes through both of two points; a third one with a huge error has no weight.
        value, error = measure_descent.limit([0.2, 0.4, 0.3], [(0.8, 0.01), (0.9, 0.02), (5.0, 1e6)])
        self.assertAlmostEqual(0.7, value, places=6)
        self.assertAlmostEqual(math.hypot(2 * 0.01, 0.02), error, places=6)

    def test_refuses_what_it_cannot_measure(self):
        empty = self.folder / "empty"
        empty.mkdir()
        for folder, words, sentence in (
                (empty, [], "holds no history.csv"),
                (self.run_of("two", scene(canopies=2)), [], "no run of one canopy"),
                (self.run_of("oblique", scene(gravity="[1, 0, -9.81]")), [], "no gravity or stream along an axis"),
                (self.run_of("gust", scene(velocity='[0, 0, "5*t"]')), [], "no constant"),
                (self.run_of("short", history=rows(end=9.0)), [], "less than two periods"),
                (self.run_of("one"), ["--limit"], "cells of two sizes")):
            with self.subTest(folder.name):
                self.assertIn(sentence, self.measure(folder, *words, code=1))
