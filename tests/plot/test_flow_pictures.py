"""Figures of synthetic runs of drogue-parachute."""

import dataclasses
import warnings

import packages  # before modules that need the packages  isort: skip
import h5py
import numpy as np
from matplotlib.collections import LineCollection
from drawn import PictureTest, texts_of
from PIL import Image
from plot import cli
from plot.flow.history_figure import flow_history_figure, keeps_energy
from plot.flow.plane import plane_of
from plot.flow.quantities import Quantity, default_names, quantities
from plot.flow.sheets import sheet_section
from plot.flow.slices_figure import SlicesFigure, View, colour_scale, slices_figure
from plot.flow.spectrum import energy_spectrum, is_periodic, spectrum_figure
from plot.run_directory import read_run
from plot.study_figure import default_norm, study_figure
from synthetic_flow import centres, write_flow, write_flow_study

assert packages.SOURCE


def vectors(*components):
    """Vector field (nx, ny, nz, 3) of three scalar fields."""
    return np.stack(np.broadcast_arrays(*components), axis=-1)


def shear(time, x, y, z):
    """Shear u = (y, time, 2 z) with its vorticity, and a pressure that numbers the places."""
    zero = 0 * x
    return {
        "velocity": vectors(y, zero + time, 2 * z),
        "vorticity": vectors(zero, 3 + zero, -1 - time + zero),
        "pressure": 100 * x + 10 * y + z,
    }


class FlowPictures(PictureTest):
    def test_draws_two_dimensional_run_whole(self):
        """The plane is normal to the axis with one cell, whichever it is."""
        for normal, right, up in ((0, 1, 2), (1, 0, 2), (2, 0, 1)):
            with self.subTest(normal=normal):
                cells = [1 if axis == normal else 4 + axis for axis in range(3)]
                run = read_run(write_flow(self.folder / f"run{normal}", cells, (1.0, 2.0, 3.0), shear))
                plane = plane_of(run)
                self.assertEqual((right, up), plane.across)
                self.assertEqual((0, 1.0 + right, 0, 1.0 + up), plane.extent)
                pressure = plane.cut(run.snapshots[0].fields["pressure"].values)
                self.assertEqual((cells[up], cells[right]), pressure.shape)
                self.assertGreater(pressure[0, 1], pressure[0, 0])
                self.assertGreater(pressure[1, 0], pressure[0, 0])
                self.assertEqual(normal, quantities(run)["vorticity"].component)

    def test_draws_pictures_of_run(self):
        run = write_flow(self.folder / "run", (12, 8, 1), (3.0, 2.0, 1.0), shear, (0.0, 1.0))
        self.assertEqual(0, cli.main([str(run), "--quiet"]))
        self.assertEqual({"fields.png", "fields.gif", "history.png", "spectrum.png"}, self.pictures(run))
        with Image.open(run / "fields.gif") as movie:
            self.assertEqual(2, movie.n_frames)

    def test_cells_of_a_stretched_grid_have_their_widths(self):
        run = read_run(write_flow(self.folder / "run", (10, 8, 1), (3.0, 2.0, 1.0), shear, growth=1.2, is_open=True))
        plane, pressure = plane_of(run), run.snapshots[0].fields["pressure"].values
        pixels, faces = plane.pixels(pressure), [run.mesh[axis].values for axis in "xy"]
        self.assertEqual([round(np.ptp(f) / np.diff(f).min()) for f in (faces[1], faces[0])], list(pixels.shape))
        for cell in ((2, 3), (5, 4), (9, 7)):
            place = [(f[k] + f[k + 1]) / 2 for f, k in zip(faces, cell)]
            at = tuple(int(x / f[-1] * n) for f, x, n in zip(faces[::-1], place[::-1], pixels.shape))
            self.assertEqual(pressure[(*cell, 0)], pixels[at])
        # Values that are linear in space stay so at equidistant places.
        x, y, values = plane.equidistant(pressure)
        np.testing.assert_allclose(np.diff(x), np.diff(x)[0])
        # They are as near as the narrowest cells, so that streamlines show what these resolve.
        for places, f in zip((x, y), faces):
            self.assertLess(np.diff(places)[0], np.diff(f).min() * 1.05)
        np.testing.assert_allclose(values, 100 * x + 10 * y[:, None] + 0.5)
        self.assertEqual(0, cli.main([str(run.path), "--quiet", "--movie", "none"]))
        self.assertEqual({"fields.png", "history.png"}, self.pictures(run.path))

    def add_sheet(self, path, name, *places):
        """Adds a triangle of a body or flag: at rest, or at one place along x per snapshot."""
        corners = np.array([[0.2, 0.1, 0.0], [0.6, 0.1, 0.0], [0.2, 0.1, 2.0]])
        with h5py.File(path / "fields.h5", "a") as h5:
            h5[f"mesh/{name}/vertices"] = corners
            h5[f"mesh/{name}/triangles"] = [[0, 1, 2]]
            for k, place in enumerate(places):
                h5[f"steps/{k:06d}/{name}/position"] = corners + [place, 0, 0]

    def test_bodies_and_flags_are_outlined_where_the_plane_cuts_them(self):
        path = write_flow(self.folder / "run", (4, 4, 4), (1.0, 1.0, 4.0), shear, (0.0, 1.0))
        self.add_sheet(path, "body")
        self.add_sheet(path, "flag", 0.1, 0.3)
        run = read_run(path)
        # The triangles are narrower by a quarter at z = 0.5, the middle of the first layer of cells.
        plane = plane_of(run, "z=0.5")
        figure = SlicesFigure(View(plane, [quantities(run)["speed"]]), run.snapshots)
        (lines,) = [item for item in figure.figure.axes[0].collections if item.get_zorder() == 2.6]
        for snapshot, place in zip(run.snapshots, (0.1, 0.3)):
            figure.show(snapshot)
            drawn = sorted(sorted(segment[:, 0]) for segment in lines.get_segments())
            np.testing.assert_allclose(drawn, [[0.2, 0.5], [0.2 + place, 0.5 + place]], atol=1e-12)
            np.testing.assert_allclose([segment[:, 1] for segment in lines.get_segments()], 0.1)
        self.assertEqual(0, len(sheet_section(run, run.snapshots[0], 2, 2.5)))

    def test_slices_run_at_axis_and_place(self):
        run = read_run(write_flow(self.folder / "run", (4, 6, 8), (1.0, 1.0, 1.0), shear))
        self.assertEqual((2, 4), (plane_of(run).normal, plane_of(run).index))
        for words, normal, index in (("x", 0, 2), ("y=0", 1, 0), ("y=0.49", 1, 2), ("z=1", 2, 7), ("z=0.25", 2, 2)):
            with self.subTest(words):
                plane = plane_of(run, words)
                self.assertEqual((normal, index), (plane.normal, plane.index))
        self.assertIn("x = 0.875 m", plane_of(run, "x=0.9").description)

    def test_rejects_slices_that_do_not_exist(self):
        flat = write_flow(self.folder / "flat", (4, 4, 1), (1.0, 1.0, 1.0), shear)
        solid = write_flow(self.folder / "solid", (4, 4, 4), (1.0, 1.0, 1.0), shear)
        self.assertIn("is a line: its plane is z", self.refusal(flat, "--slice", "x"))
        self.assertIn("outside the domain, y = 0 to 1 m", self.refusal(solid, "--slice", "y=1.5"))
        self.assertIn("outside the domain", self.refusal(solid, "--slice", "y=nan"))
        self.assertIn("'middle' is no number", self.refusal(solid, "--slice", "z=middle"))
        self.assertIn("names no axis", self.refusal(solid, "--slice", "w=0.5"))
        (flat / "fields.h5").unlink()
        self.assertIn("no fields of a flow", self.refusal(flat, "--slice", "z"))

    def test_streamlines_need_a_finite_velocity_and_two_directions(self):
        def flow(value):
            return lambda time, x, y, z: {"velocity": vectors(value + 0 * x, 0 * x, 0 * x)}

        for value, cells, lengths, has_lines in (
            (1.0, (16, 16, 1), (1.0, 1.0, 0.1), True), (0.0, (16, 16, 1), (1.0, 1.0, 0.1), False),
            (np.nan, (16, 16, 1), (1.0, 1.0, 0.1), False), (np.inf, (16, 16, 1), (1.0, 1.0, 0.1), False),
            (1.0, (64, 4, 1), (64.0, 1.0, 0.1), False),
        ):
            with self.subTest((value, cells)), warnings.catch_warnings():
                warnings.simplefilter("error")
                run = read_run(write_flow(self.folder / f"{value}-{cells[0]}", cells, lengths, flow(value)))
                figure = slices_figure(View(plane_of(run), [quantities(run)["speed"]]), run.snapshots[0])
                lines = [item for axes in figure.axes for item in axes.collections
                         if isinstance(item, LineCollection) and np.all(item.get_color() == 1)]
                self.assertEqual(has_lines, bool(lines) and len(lines[0].get_segments()) > 10)
                self.assertEqual(has_lines, bool(lines))

    def test_rejects_unknown_field_with_nearest_name(self):
        run = write_flow(self.folder / "run", (4, 4, 1), (1.0, 1.0, 1.0), shear)
        self.assertIn("no field 'velocity_w'; nearest is velocity_", self.refusal(run, "--field", "velocity_w"))
        sentence = self.refusal(run, "--field", "q_criterion")
        self.assertIn("no field 'q_criterion'", sentence)
        self.assertIn("output.fields of its scene chooses what a run writes", sentence)
        self.assertEqual(1, sentence.count("\n"))
        # Vorticity is no misspelt velocity.
        still = write_flow(self.folder / "still", (4, 4, 1), (1.0, 1.0, 1.0),
                           lambda time, x, y, z: {"velocity": vectors(x, y, z)})
        self.assertIn("no field 'vorticity'; it has speed, velocity_x", self.refusal(still, "--field", "vorticity"))

    def test_quantities_are_components_and_magnitudes(self):
        run = read_run(write_flow(self.folder / "run", (4, 4, 4), (1.0, 1.0, 1.0), shear, (2.0,)))
        self.assertEqual(["speed", "pressure", "vorticity"], default_names(run))
        known, snapshot = quantities(run), run.snapshots[0]
        x, y, z = 0.625, 0.375, 0.875
        expected = {"speed": np.sqrt(y * y + 4 + 4 * z * z), "velocity_y": 2.0, "velocity_z": 2 * z,
                    "pressure": 100 * x + 10 * y + z, "vorticity": np.sqrt(18), "vorticity_z": -3.0}
        for name, value in expected.items():
            self.assertAlmostEqual(value, known[name].values(snapshot)[2, 1, 3], msg=name)

    def test_panels_have_true_proportion(self):
        for lengths in ((8.0, 1.0, 1.0), (1.0, 5.0, 1.0), (1.0, 1.0, 1.0)):
            run = read_run(write_flow(self.folder / f"{lengths}", (8, 8, 1), lengths, shear))
            view = View(plane_of(run), [quantities(run)[name] for name in ("speed", "vorticity")])
            figure = slices_figure(view, run.snapshots[0])
            panels = [axes for axes in figure.axes if axes.images]
            self.assertEqual(2, len(panels))
            for panel in panels:
                box = panel.get_window_extent()
                self.assertAlmostEqual(lengths[0] / lengths[1], box.width / box.height, delta=1e-6)
                self.assertEqual((0, lengths[0], 0, lengths[1]), (*panel.get_xlim(), *panel.get_ylim()))

    def test_no_text_overlaps_or_leaves_figure(self):
        run = read_run(write_flow(self.folder / "run", (8, 8, 1), (1.0, 1.0, 1.0), shear))
        view = View(plane_of(run), list(quantities(run).values()))
        figure = slices_figure(view, run.snapshots[0])
        self.assertGreater(len(self.assert_apart(texts_of(figure), figure.bbox)), 50)

    def test_signed_values_get_symmetric_diverging_colours(self):
        signed = np.linspace(-1, 3, 101)
        speed, vorticity = (Quantity(name, "", name, "", 2) for name in ("velocity", "vorticity"))
        for quantity, values in ((speed, signed), (vorticity, signed), (vorticity, signed + 2)):
            norm, name, _ = colour_scale(quantity, values)
            self.assertEqual("RdBu_r", name)
            self.assertEqual(-norm.vmin, norm.vmax)
            self.assertGreaterEqual(norm.vmax, 3)
        norm, name, ends = colour_scale(speed, signed + 2)
        self.assertEqual(("viridis", "neither", 1, 5), (name, ends, norm.vmin, norm.vmax))

    def test_few_extreme_values_exceed_colour_scale(self):
        values = np.concatenate([np.linspace(-1, 1, 1000), [50]])
        norm, _, ends = colour_scale(Quantity("vorticity", "", "vorticity", "", 2), values)
        self.assertEqual("max", ends)
        self.assertLess(norm.vmax, 2)

    def test_round_off_does_not_look_like_variation(self):
        norm, _, _ = colour_scale(Quantity("speed", "", "velocity", ""), 1 + 1e-15 * np.arange(4))
        self.assertGreater(norm.vmax - norm.vmin, 0.1)
        norm, _, _ = colour_scale(Quantity("speed", "", "velocity", ""), np.zeros(4))
        self.assertLess(norm.vmin, norm.vmax)

    def test_movie_keeps_one_colour_scale(self):
        run = read_run(write_flow(self.folder / "run", (4, 4, 1), (1.0, 1.0, 1.0), shear, (0.0, 4.0)))
        drawing = SlicesFigure(View(plane_of(run), [quantities(run)["vorticity"]]), run.snapshots)
        (image,) = drawing.figure.axes[0].images
        for snapshot, value in zip(run.snapshots, (-1, -5)):
            drawing.show(snapshot)
            np.testing.assert_array_equal(value, image.get_array())
            self.assertEqual(5, image.norm.vmax)

    def test_streamlines_follow_velocity(self):
        run = read_run(
            write_flow(self.folder / "run", (8, 8, 1), (1.0, 1.0, 1.0),
                       lambda time, x, y, z: {"velocity": vectors(0 * x, 1 + 0 * x, 0 * x)})
        )
        known = quantities(run)
        without = slices_figure(View(plane_of(run), [known["velocity_x"]]), run.snapshots[0])
        self.assertEqual(0, len(without.axes[0].collections))
        figure = slices_figure(View(plane_of(run), [known["velocity_x"], known["speed"]]), run.snapshots[0])
        (panel,) = [axes for axes in figure.axes if axes.images and axes.collections]
        self.assertIn("speed", panel.get_title(loc="left"))
        lines = panel.collections[0].get_segments()
        self.assertGreater(np.ptp(np.concatenate(lines)[:, 1]), 0.5)
        self.assertLess(max(np.ptp(np.asarray(line)[:, 0]) for line in lines), 1e-12)

    def test_single_mode_lands_in_its_shell_with_its_energy(self):
        """A mode of amplitude A adds the energy A^2 / 4 per mass to the shell nearest to its wave vector's size."""
        cases = (((16, 16, 16), (1.0, 1.0, 1.0), (3, 0, 0), 3), ((16, 18, 20), (1.0, 1.0, 1.0), (2, 3, 4), 5),
                 ((16, 12, 1), (1.0, 1.0, 5.0), (3, -4, 0), 5), ((1, 15, 16), (1.0, 2.0, 1.0), (0, 4, 1), 4),
                 ((16, 1, 8), (4.0, 1.0, 2.0), (1, 0, 1), 2), ((9, 9, 9), (1.0, 1.0, 1.0), (0, 0, -4), 4))
        for cells, lengths, mode, shell in cases:
            with self.subTest(cells=cells, mode=mode):
                phase = sum(
                    2 * np.pi * number * place / length
                    for number, place, length in zip(mode, centres(cells, lengths), lengths)
                )
                velocity = vectors(3 * np.cos(phase), 4 * np.sin(phase), 7 + 0 * phase)
                spectrum = energy_spectrum(velocity, lengths)
                width = spectrum.k[0]
                self.assertAlmostEqual(
                    2 * np.pi / max(length for length, count in zip(lengths, cells) if count > 1), width
                )
                expected = np.where(np.arange(1, len(spectrum.k) + 1) == shell, 25 / 4, 0)
                np.testing.assert_allclose(spectrum.energy * width, expected, atol=1e-12)

    def test_shells_hold_energy_of_resolved_velocity(self):
        """Parseval: the shells of a velocity without its smallest scales hold its whole energy."""
        x, y, z = centres((16, 16, 16), (1.0, 1.0, 1.0))
        random, velocity = np.random.default_rng(7), np.zeros((16, 16, 16, 3))
        for _ in range(40):
            wave, phase = random.integers(-4, 5, 3), random.uniform(0, 7)
            velocity += random.normal(size=3) * np.cos(
                2 * np.pi * (wave[0] * x + wave[1] * y + wave[2] * z) + phase
            )[..., None]
        velocity -= velocity.mean(axis=(0, 1, 2))
        spectrum = energy_spectrum(velocity, (1.0, 1.0, 1.0))
        self.assertEqual(8, len(spectrum.k))
        energy = 0.5 * np.mean(np.sum(velocity**2, axis=-1))
        self.assertAlmostEqual(energy, np.sum(spectrum.energy) * spectrum.k[0])

    def test_spectrum_of_periodic_flow_has_marks(self):
        """Curves of energy k^-2, and dashed marks of their slopes above all of them."""
        random = np.random.default_rng(3)

        def decaying(time, x, y, z):
            phases = random.uniform(0, 7, (6, 3))
            waves = [
                np.stack([np.cos(2 * np.pi * n * y + p[0]), np.cos(2 * np.pi * n * x + p[1]), 0 * x], axis=-1) / n
                for n, p in enumerate(phases, 1)
            ]
            return {"velocity": sum(waves)}

        for cells, slopes in (((12, 12, 1), [-5 / 3, -3]), ((12, 12, 12), [-5 / 3])):
            run = read_run(write_flow(self.folder / f"{cells}", cells, (1.0, 1.0, 1.0), decaying, (0.0, 1.0)))
            self.assertTrue(is_periodic(run))
            (axes,) = spectrum_figure(run, run.snapshots[1]).axes
            marks = [line.get_xydata() for line in axes.lines if line.get_linestyle() == "--"]
            curves = [line.get_xydata() for line in axes.lines if line.get_linestyle() == "-"]
            self.assertEqual(2, len(curves))
            self.assertEqual(len(slopes), len(marks))
            for mark, slope in zip(marks, slopes):
                (ratio_k, ratio_energy) = mark[-1] / mark[0]
                self.assertAlmostEqual(slope, np.log(ratio_energy) / np.log(ratio_k))
                for k, energy in mark:
                    self.assertGreater(energy, max(curve[curve[:, 0] == k, 1][0] for curve in curves))
            self.assertEqual(1, len(spectrum_figure(run, run.snapshots[0]).axes[0].texts) - len(marks))

    def test_label_of_spectrum_stands_at_end_of_drawn_curve(self):
        """Shells with energy of round-off are not drawn, so their energy places no label."""

        def smooth(time, x, y, z):
            waves = [10.0 ** (-n) * np.cos(2 * np.pi * n * y) for n in range(1, 6)]
            return {"velocity": vectors(sum(waves), 0 * x, 0 * x)}

        run = read_run(write_flow(self.folder / "run", (16, 16, 16), (1.0, 1.0, 1.0), smooth))
        figure = spectrum_figure(run, run.snapshots[0])
        figure.canvas.draw()
        (axes,) = figure.axes
        (label,) = [text for text in axes.texts if text.get_text().startswith("t =")]
        (curve,) = [line.get_xydata() for line in axes.lines if line.get_linestyle() == "-"]
        end = curve[np.isfinite(curve[:, 1])][-1]
        box = label.get_window_extent()
        self.assertAlmostEqual(axes.transData.transform(end)[1], (box.y0 + box.y1) / 2, delta=2)

    def test_spectrum_needs_periodic_sides_and_several_modes(self):
        opened = read_run(write_flow(self.folder / "opened", (8, 8, 1), (1.0, 1.0, 1.0), shear, is_open=True))
        self.assertFalse(is_periodic(opened))
        still = read_run(
            write_flow(self.folder / "still", (8, 8, 1), (1.0, 1.0, 1.0),
                       lambda time, x, y, z: {"velocity": vectors(np.sin(2 * np.pi * y), 0 * x, 0 * x)})
        )
        self.assertTrue(is_periodic(still))
        self.assertIsNone(spectrum_figure(still, still.snapshots[0]))

    def test_uniform_flow_has_no_spectrum(self):
        noise = np.random.default_rng(3)

        def round_off(time, x, y, z):
            return {"velocity": vectors(0 * x, 0 * x, 2 * time + 1e-15 * noise.normal(size=x.shape))}

        run = read_run(write_flow(self.folder / "run", (8, 8, 8), (1.0, 1.0, 1.0), round_off))
        self.assertTrue(is_periodic(run))
        self.assertIsNone(spectrum_figure(run, run.snapshots[-1]))

    def test_history_shows_what_the_scene_expects(self):
        run = read_run(write_flow(self.folder / "run", (4, 4, 1), (1.0, 1.0, 1.0), shear))
        run.scene["verify"] = {
            "kinetic_energy_curve": [{"points": [[0.2, 4.0], [0.4, 2.0]], "tolerance": 0.1}, {"points": [[0.6, 1]], "tolerance": 0.5}],
            "dissipation_curve": [{"points": [[0.5, 3.0]], "tolerance": 0.2}],
        }
        figure = flow_history_figure(run)
        for axes, points in zip(figure.axes, ([(0.2, 4, 0.4), (0.4, 2, 0.4), (0.6, 1, 0.5)], [(0.5, 3, 0.6)])):
            (bars,) = axes.containers
            np.testing.assert_allclose(bars.lines[0].get_xydata(), [point[:2] for point in points])
            sizes = [np.ptp(mark[:, 1]) / 2 for mark in bars.lines[2][0].get_segments()]
            np.testing.assert_allclose(sizes, [point[2] for point in points])
        self.assertTrue(any("expected" in text.get_text() for text in figure.texts))
        self.assertFalse(figure.axes[2].containers)

    def test_study_shows_rms_error_with_orders(self):
        write_flow_study(self.folder / "study.csv")
        rows = read_run(self.folder).study
        self.assertEqual("l2_velocity", default_norm(rows))
        by_time, by_mesh = study_figure("taylor-green-2d", rows).axes
        self.assertEqual("rms error of velocity (m/s)", by_time.get_ylabel())
        self.assertEqual("cells along the longest axis", by_mesh.get_xlabel())
        self.assertEqual(
            ["WENO-Z RK3  order 3.00", "central AB2  order 2.00"], [text.get_text() for text in by_mesh.texts]
        )
        self.assertEqual(0, cli.main([str(self.folder), "--quiet", "--norm", "linf_velocity"]))
        (self.folder / "study.png").unlink()
        # Observed orders are no errors, and the divergence does not converge with the mesh.
        self.assertIn("no norm 'order_l2_velocity'", self.refusal(self.folder, "--norm", "order_l2_velocity"))
        (label, _) = study_figure("taylor-green-2d", rows, "divergence").axes[1].texts
        self.assertNotIn("order", label.get_text())

    def test_history_shows_energy_fall_of_closed_flow(self):
        closed, opened = (
            read_run(write_flow(self.folder / f"{is_open}", (4, 4, 1), (1.0, 1.0, 1.0), shear, is_open=is_open))
            for is_open in (False, True)
        )
        self.assertEqual((True, False), (keeps_energy(closed), keeps_energy(opened)))
        for name in ("body", "canopy", "flag"):
            self.assertFalse(keeps_energy(dataclasses.replace(closed, scene=closed.scene | {name: [{"mount": {"stiffness": 40.0}}]})))
        dissipation = flow_history_figure(closed).axes[1]
        np.testing.assert_allclose(dissipation.lines[0].get_ydata(), [1, 2, 3])
        np.testing.assert_allclose(dissipation.lines[1].get_xydata(), [[0.25, 2], [0.75, 6]])
        figure = flow_history_figure(opened)
        self.assertEqual(1, len(figure.axes[1].lines))
        np.testing.assert_allclose([line.get_ydata()[0] for line in figure.axes[-1].lines], [-1, 1])

    def test_history_without_second_row_is_not_drawn(self):
        run = write_flow(self.folder / "run", (4, 4, 1), (1.0, 1.0, 1.0), shear)
        history = run / "history.csv"
        history.write_text("\n".join(history.read_text().splitlines()[:2]) + "\n")
        self.assertIsNone(flow_history_figure(read_run(run)))
