"""drogue-plot on synthetic run directories: written files, their content, and exit codes."""

import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import unittest

import packages  # before modules that need the packages  isort: skip
from folder_test import FolderTest
import numpy as np
import synthetic
from drawn import plot
from PIL import Image
from plot.failure import Failure
from plot.gas.exact_solution import exact_solution, pointwise_errors
from plot.gas.fields_figure import View, fields_figure, set_range, space_time_figure
from plot.gas.history_figure import conservation, history_figure
from plot.picture_names import PICTURES, picture_name
from plot.run_directory import Field, read_run
from plot.study_figure import study_figure
from plot.style import plt

_COLOURS = {"run": (0, 0x72, 0xB2), "error": (0xD5, 0x5E, 0)}


def _pixels_of(file, colour):
    """Number of pixels of a picture that are close to a colour."""
    with Image.open(file) as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)
    return int((np.abs(pixels - colour).max(-1) < 40).sum())


class Pictures(FolderTest):
    def test_many_snapshots_give_all_pictures(self):
        run = synthetic.write_sod(self.folder / "sod", cells=100, snapshots=8)
        code, files, _ = plot(run)
        self.assertEqual(code, 0)
        self.assertEqual(files, ["fields.gif", "fields.png", "history.png", "space_time_rho.png"])
        for file in files:
            self.assertLess((run / file).stat().st_size, 200_000, file)
        with Image.open(run / "fields.gif") as movie:
            self.assertEqual(movie.n_frames, 8)
            self.assertEqual(movie.convert("RGB").getpixel((2, movie.height - 2)), (255, 255, 255))
        for colour in _COLOURS.values():
            self.assertGreater(_pixels_of(run / "fields.png", colour), 300)

    def test_single_snapshot_gives_no_movie_and_no_map(self):
        run = synthetic.write_sod(self.folder / "sod", cells=50, snapshots=1)
        self.assertEqual(plot(run)[:2], (0, ["fields.png", "history.png"]))

    def test_obeys_format_field_and_out(self):
        run = synthetic.write_sod(self.folder / "sod", cells=50, snapshots=2)
        before = sorted(run.iterdir())
        code, files, _ = plot(
            run, "--out", self.folder / "deep" / "er", "--field", "p", "--format", "pdf", "--movie", "mp4"
        )
        self.assertEqual((code, files), (0, ["fields.mp4", "fields.pdf", "history.pdf"]))
        self.assertEqual((self.folder / "deep/er/fields.pdf").read_bytes()[:4], b"%PDF")
        self.assertEqual(sorted(run.iterdir()), before)

    def test_movie_both_gives_gif_and_mp4(self):
        run = synthetic.write_sod(self.folder / "sod", cells=20, snapshots=2)
        self.assertEqual((0, ["fields.gif", "fields.mp4", "fields.png", "history.png"]), plot(run, "--movie", "both")[:2])

    def test_error_is_zero_for_exact_values_and_equals_disturbance(self):
        run = self.folder / "run"
        run.mkdir()
        x = np.linspace(-0.99, 0.99, 100)
        (run / "scene.toml").write_text(synthetic.SOD_SCENE.format(cells=100))
        synthetic.write_fields(run / "fields.h5", x, [0.2, 0.4], synthetic.sod)
        loaded = read_run(run)
        for error in pointwise_errors(loaded, loaded.snapshots[0], exact_solution(loaded)).values():
            np.testing.assert_array_equal(error, 0)
        self.assertEqual(plot(run, "--movie", "none")[0], 0)
        self.assertEqual(_pixels_of(run / "fields.png", _COLOURS["error"]), 0)
        loaded.snapshots[1].fields["p"].values[7] += 0.25
        error = pointwise_errors(loaded, loaded.snapshots[1], exact_solution(loaded))["p"]
        self.assertEqual(error[7], 0.25)

    def test_failed_check_stands_in_the_headings(self):
        run = synthetic.write_sod(self.folder / "sod", cells=50, snapshots=8)
        loaded = read_run(run)
        loaded.result["errors"] = {"l1_density": 0.01}
        check = {"name": "l1_density", "value": 0.01, "tolerance": 0.0065, "passed": False}
        loaded.result["checks"] = [check | {"name": "conservation", "passed": True}, check]
        view = View(loaded, ["rho"], exact_solution(loaded))
        figures = fields_figure(view, loaded.snapshots[-1]), space_time_figure(view, "rho"), history_figure(loaded)
        for figure in figures:
            self.assertTrue(any(text.get_text().endswith(", FAILED: l1 density 0.01 (tolerance 0.0065)") for text in figure.texts))
        self.assertIn("0.01 $>$ 6.5", figures[0].axes[1].get_title(loc="left"))

    def test_exact_vacuum_does_not_set_the_axis(self):
        figure, axes = plt.subplots()
        set_range(axes, "p", [np.array([1e-3, 1.0])], [np.array([1e-80, 2.0])])
        self.assertTrue(1e-7 < axes.get_ylim()[0] < 2e-6, axes.get_ylim())
        set_range(axes, "p", [np.array([1e-9, 1.0])], [np.array([1e-80, 2.0])])
        self.assertTrue(1e-10 < axes.get_ylim()[0] < 1e-9, axes.get_ylim())
        plt.close(figure)

    def test_empty_history_is_refused(self):
        (self.folder / "history.csv").touch()
        code, files, errors = plot(self.folder)
        self.assertEqual((6, []), (code, files))
        self.assertIn("history.csv cannot be read: it is empty", errors)

    def test_advected_wave_has_error_of_roundoff(self):
        run = self.folder / "wave"
        run.mkdir()
        x = -1 + (np.arange(40) + 0.5) / 20
        (run / "scene.toml").write_text(
            '[mesh]\ndomain = [-1.0, 1.0]\n[initial]\nexpression = { rho = "1+0.2*sin(pi*x)", u = "1", p = "1" }\n'
            '[boundary]\nleft = "periodic"\nright = "periodic"\n[verify]\nexact = "advection"\n'
        )
        one = np.ones_like(x)
        synthetic.write_fields(run / "fields.h5", x, [1.3], lambda t, x: (1 + 0.2 * np.sin(np.pi * (x - t)), one, one))
        loaded = read_run(run)
        error = pointwise_errors(loaded, loaded.snapshots[0], exact_solution(loaded))
        self.assertLess(np.abs(error["rho"]).max(), 1e-14)
        self.assertEqual(plot(run)[0], 0)

    def test_reference_run_applies_at_final_time_only(self):
        run = self.folder / "blast"
        run.mkdir()
        (run / "scene.toml").write_text('[verify]\nexact = "reference"\n')
        fine = np.linspace(-1, 1, 2001)
        reference = dict(zip(("rho", "u", "p"), (1 + fine**2, fine, fine + 2)), x=fine, scheme="z", cells=2001)
        x = np.linspace(-0.9, 0.9, 40)
        synthetic.write_fields(run / "fields.h5", x, [0.1, 0.2], lambda t, x: (1 + x**2, x, x + 2 + t), reference)
        loaded = read_run(run)
        exact = exact_solution(loaded)
        self.assertIn("2001 cells", exact.name)
        self.assertEqual(pointwise_errors(loaded, loaded.snapshots[0], exact), {})
        np.testing.assert_allclose(pointwise_errors(loaded, loaded.snapshots[1], exact)["p"], 0.2)
        self.assertEqual(plot(run)[:2], (0, ["fields.gif", "fields.png"]))

    def test_conservation_accounts_for_outflow_at_ends(self):
        synthetic.write_history(self.folder / "history.csv")
        change = conservation(read_run(self.folder))
        self.assertEqual(list(change), ["mass", "momentum", "energy"])
        for name, values in change.items():
            self.assertLess(np.abs(values).max(), 1e-14, name)
        lost = (self.folder / "history.csv").read_text().splitlines()
        cells = lost[-1].split(",")
        cells[3] = str(float(cells[3]) * 0.99)
        (self.folder / "history.csv").write_text("\n".join(lost[:-1] + [",".join(cells)]))
        self.assertAlmostEqual(conservation(read_run(self.folder))["mass"][-1], -0.01, delta=1e-12)
        self.assertEqual(plot(self.folder)[:2], (0, ["history.png"]))

    def test_study_shows_observed_orders_and_failures(self):
        synthetic.write_study(self.folder / "study.csv", failed=1)
        self.assertEqual(plot(self.folder)[:2], (0, ["study.png"]))
        figure = study_figure("sod", read_run(self.folder).study)
        words = [text.get_text() for text in figure.texts + figure.axes[1].texts]
        self.assertIn("WENO-JS  order 0.90", words)
        self.assertTrue(any("1 of 12 runs failed" in text for text in words), words)

    def test_study_of_cloth_measures_order_in_edge_length(self):
        synthetic.write_springs_study(self.folder / "study.csv")
        self.assertEqual(plot(self.folder)[:2], (0, ["study.png"]))
        rows = read_run(self.folder).study
        for norm, title, count in (("", "frequency", 4), ("cauchy_area", "next mesh (m$^2$)", 3)):
            with self.subTest(norm):
                figure = study_figure("drum", rows, norm)
                by_time, by_mesh = figure.axes
                self.assertIn("biquadratic  order 2.00", [text.get_text() for text in by_mesh.texts])
                self.assertIn(title, by_time.get_ylabel())
                self.assertEqual("vertices", by_mesh.get_xlabel())
                self.assertEqual(count, len(by_mesh.lines[0].get_xdata()))
        self.assertEqual(plot(self.folder, "--norm", "cauchy_kinetic")[:2], (0, ["study.png"]))

    def test_study_of_invariants_shows_differences_of_meshes(self):
        synthetic.write_springs_study(self.folder / "study.csv", checks=("energy_drift",))
        rows = read_run(self.folder).study
        self.assertIn("area", study_figure("cone", rows).axes[0].get_ylabel())
        # A single mesh has no difference to another one.
        self.assertIn("energy drift", study_figure("cone", rows[-1:]).axes[0].get_ylabel())

    def test_study_without_drawable_rows_reports_reason(self):
        synthetic.write_springs_study(self.folder / "study.csv", checks=())
        (self.folder / "study.json").write_text('{"scene": "cone"}')
        rows = read_run(self.folder).study
        with self.assertRaisesRegex(Failure, "cone has nothing to draw: 1 of 1 have no finer mesh"):
            study_figure("cone", rows[-1:])
        with self.assertRaisesRegex(Failure, "it is empty"):
            study_figure("cone", [])

    def test_study_of_invariants_shows_no_order(self):
        synthetic.write_springs_study(self.folder / "study.csv", checks=("energy_balance",))
        rows = read_run(self.folder).study
        for norm, label in (("energy_balance", "biquadratic"), ("cauchy_area", "biquadratic  order 2.00")):
            with self.subTest(norm):
                self.assertEqual([label], [text.get_text() for text in study_figure("cloth", rows, norm).axes[1].texts])

    def test_many_long_labels_of_study_fit(self):
        axes = ("", " lf-global", " lf-single"), ("", " ssprk43"), ("", " split")
        settings = ["".join(words) for words in itertools.product(*axes)]
        synthetic.write_study(self.folder / "study.csv", settings=settings)
        (self.folder / "study.json").write_text('{"scene": "lax"}')
        run = read_run(self.folder)
        figure = study_figure(run.scene_name, run.study)
        renderer = figure.canvas.get_renderer()
        self.assertIn("lax", [text.get_text() for text in figure.texts])
        self.assertEqual(figure.axes[0].get_ylabel(), "L1 error of density (kg/m$^2$)")
        boxes = [text.get_window_extent(renderer) for text in figure.axes[1].texts]
        self.assertEqual(len(boxes), 36)
        for box in boxes:
            self.assertLessEqual(box.x1, figure.bbox.width)
            self.assertLessEqual(box.y1, figure.axes[1].get_window_extent().y1 + box.height)
        self.assertEqual(plot(self.folder, "--norm", "l1_pressure")[:2], (0, ["study.png"]))

    def test_labels_max_density_as_deviation(self):
        run = synthetic.write_sod(self.folder / "sedov", cells=20, snapshots=1)
        check = {"name": "max_density", "value": 1.2e-3, "tolerance": 0.02, "passed": True}
        (run / "result.json").write_text(json.dumps({"checks": [check]}))
        (run / "scene.toml").write_text("")
        loaded = read_run(run)
        figure = fields_figure(View(loaded, ["rho"], exact_solution(loaded)), loaded.snapshots[-1])
        captions = "".join(text.get_text() for text in figure.texts)
        self.assertRegex(captions, r"max density off by 1\.2.* \(tolerance 0\.02\)")


    def test_labels_of_a_study_do_not_touch(self):
        for meshes in ((300, 350, 400, 450, 500), tuple(range(100, 210, 10)), (100, 101, 102), (50, 100, 200, 400, 3200)):
            with self.subTest(meshes):
                synthetic.write_study(self.folder / "study.csv", meshes=meshes)
                figure = study_figure("sod", read_run(self.folder).study)
                figure.canvas.draw()
                for axes in figure.axes:
                    low, high = axes.get_xlim()
                    ticks = [*axes.xaxis.get_major_ticks(), *axes.xaxis.get_minor_ticks()]
                    boxes = sorted((tick.label1.get_window_extent() for tick in ticks
                                    if tick.label1.get_text() and low <= tick.get_loc() <= high), key=lambda box: box.x0)
                    self.assertGreater(len(boxes), 0)
                    for left, right in zip(boxes, boxes[1:]):
                        self.assertLess(left.x1, right.x0)

    def test_titles_of_errors_do_not_touch(self):
        run = synthetic.write_sod(self.folder / "sod", cells=100, snapshots=1)
        check = {"name": "l1_density", "value": 4.91e-3, "tolerance": 5.18e-3, "passed": True}
        errors = {f"l1_{name}": 4.91e-3 for name in ("density", "velocity", "pressure")}
        (run / "result.json").write_text(json.dumps({"checks": [check], "errors": errors}))
        loaded = read_run(run)
        figure = fields_figure(View(loaded, ["rho", "u", "p"], exact_solution(loaded)), loaded.snapshots[-1])
        figure.canvas.draw()
        titles = [axes._left_title.get_window_extent() for axes in figure.axes[3:]]
        self.assertIn("5.18", figure.axes[3].get_title(loc="left"))
        for left, right in zip(titles, titles[1:]):
            self.assertLess(left.x1, right.x0)

    def test_history_names_the_signal_speed(self):
        synthetic.write_history(self.folder / "history.csv")
        run = read_run(self.folder)
        run.history["max_speed"] = Field("max_speed", run.history["time"].values + 1, "m/s")
        titles = [axes.get_title(loc="left") for axes in history_figure(run).axes]
        self.assertIn("largest signal speed |u| + c (m/s)", titles)


class Names(unittest.TestCase):
    def test_programs_remove_all_pictures_of_a_former_run(self):
        source = (packages.SOURCE / "common/run/run_directory.cpp").read_text()
        removed = re.search(r"picture_names\(\) \{\n.*? = \{(.*?)\};", source, re.DOTALL).group(1)
        self.assertEqual(list(PICTURES), re.findall(r'"(\w+)"', removed))
        with self.assertRaises(ValueError):
            picture_name("portrait")

    def test_every_picture_of_the_page_is_named(self):
        table = (packages.SOURCE / "docs/pictures.md").read_text()
        for name in PICTURES:
            self.assertIn(f"`{name}.png`", table)


class Installed(FolderTest):
    def test_copy_of_package_prints_version_and_draws(self):
        share = self.folder / "share" / "drogue"
        shutil.copytree(packages.SOURCE / "scripts" / "plot", share / "plot")
        synthetic.write_history(self.folder / "history.csv")
        environment = os.environ | {"PYTHONPATH": str(share), "DROGUE_VERSION": "1.2.3"}
        for words, output in (("--version", "drogue-plot 1.2.3 (git"), (str(self.folder), "history.png")):
            command = [sys.executable, "-m", "plot", words]
            done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn(output, done.stdout)


class Refusals(FolderTest):
    def _refused(self, code, words, *arguments):
        got, files, sentence = plot(*arguments)
        self.assertEqual((got, files), (code, []), sentence)
        self.assertEqual(sentence.count("\n"), 1, sentence)
        for word in words:
            self.assertIn(word, sentence)

    def test_rejects_wrong_usage(self):
        self._refused(2, ["no such folder"], self.folder / "absent")
        self._refused(2, ["nothing to draw"], self.folder)
        self._refused(2, ["run directory is missing"])
        self._refused(2, ["--colour"], self.folder, "--colour")
        self._refused(2, ["jpeg"], self.folder, "--format", "jpeg")
        self._refused(2, ["20 to 1200"], self.folder, "--dpi", "5")
        run = synthetic.write_sod(self.folder / "sod", cells=20, snapshots=1)
        for time in ("nan", "inf", "-inf", "1e999"):
            self._refused(2, ["--time", "not finite"], run, f"--time={time}")

    def test_rejects_unknown_field_with_nearest_name(self):
        run = synthetic.write_sod(self.folder / "sod", cells=20, snapshots=1)
        self._refused(2, ["'rhoo'", "nearest is rho"], run, "--field", "rhoo")

    def test_rejects_unknown_norm_with_available_columns(self):
        synthetic.write_study(self.folder / "study.csv")
        self._refused(2, ["'l3_density'", "l1_density"], self.folder, "--norm", "l3_density")
        self._refused(2, ["no norm 'label'"], self.folder, "--norm", "label")
        synthetic.write_springs_study(self.folder / "study.csv")
        self._refused(2, ["'cauchy_aera'", "nearest is cauchy_area"], self.folder, "--norm", "cauchy_aera")

    def test_rejects_norm_without_study(self):
        run = synthetic.write_sod(self.folder / "sod", cells=20, snapshots=1)
        self._refused(2, ["no study"], run, "--norm", "l1_density")

    def test_unreadable_environment_counts_as_absent(self):
        # A name that is too long and a file that is not executable fail for every user, even root.
        (self.folder / "bin").mkdir()
        (self.folder / "bin" / "python3").write_text("")
        for venv in ("x" * 300, str(self.folder)):
            environment = os.environ | {"DROGUE_VENV": venv, "PYTHONPATH": str(packages.SOURCE / "scripts")}
            environment.pop("DROGUE_PLOT_MOVED", None)
            # -S hides the packages of this interpreter.
            done = subprocess.run(
                [sys.executable, "-S", "-m", "plot", "."], capture_output=True, text=True, env=environment, check=False,
            )
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
            self.assertIn("packages are missing", done.stderr)

    def test_rejects_damaged_files(self):
        cases = {
            "fields.h5": b"\x89HDF\r\n\x1a\nnot really", "scene.toml": b"[mesh\n", "result.json": b"{",
            "history.csv": b"time,dt [s]\n0.1,none\n",
            "study.csv": b"label,cells,compute_s,l1_density,status\nz,100,,,ok\n",
        }
        for name, content in cases.items():
            with self.subTest(name):
                run = synthetic.write_sod(self.folder / name, cells=20, snapshots=1)
                (run / name).write_bytes(content)
                code, _, sentence = plot(run)
                self.assertEqual(code, 6, sentence)
                self.assertEqual(sentence.count("\n"), 1, sentence)

    def test_rejects_truncated_fields(self):
        run = synthetic.write_sod(self.folder / "sod", cells=200, snapshots=4)
        content = (run / "fields.h5").read_bytes()
        (run / "fields.h5").write_bytes(content[: len(content) // 2])
        self._refused(6, ["fields.h5"], run)

    def test_reports_unwritable_folder(self):
        run = synthetic.write_sod(self.folder / "sod", cells=20, snapshots=1)
        (self.folder / "file").write_text("")
        self._refused(6, ["cannot be written"], run, "--out", self.folder / "file" / "pictures")
