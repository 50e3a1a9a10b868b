"""Figures of synthetic runs of drogue-parachute with canopies and bodies."""

import dataclasses
import subprocess
from unittest import mock

import packages  # before modules that need the packages  isort: skip
import h5py
import imageio_ffmpeg
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle
from drawn import PictureTest, texts_of
from PIL import Image, ImageSequence
from plot import cli, shading, style
from plot.checks import check_caption, failure_caption
from plot.flow.plane import plane_of
from plot.flow.quantities import quantities
from plot.parachute.canopies import Canopies, has_canopies, plane_through_canopy
from plot.parachute.canopies_history import canopies_history_figure, drag_coefficient, nominal_area, relative_velocity
from plot.parachute.canopy_figure import CanopyFigure, View, canopy_figure
from plot.parachute.forces_history import forces_history_figure, mean_between
from plot.parachute.time_figure import Panel
from plot.run_directory import read_run
from synthetic_canopies import GORES, write_bodies, write_canopies, write_cloth_drop, write_drum, write_springs_and_flags

assert packages.SOURCE


def panel_of(figure, words):
    """Axes whose title contains `words`."""
    (axes,) = [axes for axes in figure.axes if words in axes.get_title(loc="left")]
    return axes


class CanopyPictures(PictureTest):
    def view(self, run, normal="y"):
        known = quantities(run)
        return View(Canopies(run), plane_of(run, normal), [known["speed"]] if "speed" in known else [])

    def assert_no_text_overlaps_or_leaves(self, figure):
        self.assert_apart(texts_of(figure), figure.bbox)

    def test_draws_pictures_whatever_fields_run_has(self):
        for fields in (("velocity", "position", "von_mises"), ("velocity", "position"), ("position",),
                       ("position", "von_mises")):
            with self.subTest(fields):
                run = write_canopies(self.folder / "-".join(fields), fields)
                self.assertEqual(0, cli.main([str(run), "--quiet", "--dpi", "40"]))
                names = self.pictures(run)
                self.assertEqual({"fields.png", "fields.gif", "history.png", "canopies.png"}, names)
                with Image.open(run / "fields.gif") as movie:
                    self.assertEqual(3, movie.n_frames)

    def frames_of(self, run, *words):
        """Frames (height, width, 3) of the GIF of a run."""
        self.assertEqual(0, cli.main([str(run), "--quiet", "--dpi", "40", *words]))
        with Image.open(run / "fields.gif") as movie:
            return [np.asarray(frame.convert("RGB")).astype(int) for frame in ImageSequence.Iterator(movie)]

    def test_every_frame_of_movie_shows_streamlines_unless_run_has_vorticity(self):
        """The darkest of the three colours is bright in pixels of white lines, never in those of the colour map."""
        cloth = ("position", "von_mises")
        for fields, words, has_lines in (
            (("velocity", *cloth), (), True),
            (("velocity", "vorticity", *cloth), (), False),
            (("velocity", "vorticity", *cloth), ("--field", "speed"), True),
        ):
            with self.subTest(fields, words=words):
                path = write_canopies(self.folder / "-".join((*fields, *words)), fields)
                run = read_run(path)
                shown = quantities(run)["speed" if has_lines else "vorticity"]
                drawing = CanopyFigure(View(Canopies(run), plane_of(run, "y"), [shown]), run.snapshots).figure
                box, height = panel_of(drawing, shown.label).get_window_extent(), drawing.bbox.height
                rows, columns = (slice(int(low) + 2, int(high) - 2) for low, high in
                                 ((height - box.y1, height - box.y0), (box.x0, box.x1)))
                frames = self.frames_of(path, *words)
                self.assertEqual(3, len(frames))
                for frame in frames:
                    white = int((frame[rows, columns].min(axis=-1) > 160).sum())
                    (self.assertGreater if has_lines else self.assertLess)(white, 100)

    def test_streamlines_are_those_of_the_grid_and_steady(self):
        """The velocity in the file is that relative to the grid, and here always along z."""
        path = write_canopies(self.folder / "run", payload_speed=1.0)
        scene = (path / "scene.toml").read_text()
        drawn = []
        for frame in ("fixed", "follow"):
            (path / "scene.toml").write_text(scene.replace("[grid]\n", f'[grid]\nframe = "{frame}"\n'))
            run = read_run(path)
            drawing = CanopyFigure(self.view(run), run.snapshots)
            for snapshot in run.snapshots:
                drawing.show(snapshot)
                (lines,) = [item for item in panel_of(drawing.figure, "speed").collections
                            if isinstance(item, LineCollection) and np.all(item.get_color() == 1)]
                self.assertEqual(0, max(np.ptp(segment[:, 0]) for segment in lines.get_segments()))
                drawn.append(sorted({segment[0, 0] for segment in lines.get_segments()}))
        self.assertGreater(len(drawn[0]), 10)
        for other in drawn[1:]:
            self.assertEqual(drawn[0], other)

    def test_movie_both_writes_equal_frames_as_gif_and_mp4(self):
        path = write_canopies(self.folder / "run")
        frames = self.frames_of(path, "--movie", "both")
        raw = subprocess.run(
            [imageio_ffmpeg.get_ffmpeg_exe(), "-loglevel", "error", "-i", path / "fields.mp4", "-f", "rawvideo",
             "-pix_fmt", "rgb24", "-"], capture_output=True, check=True,
        ).stdout
        decoded = np.frombuffer(raw, np.uint8).reshape(-1, *frames[0].shape).astype(int)
        self.assertEqual(len(frames), len(decoded))
        differences = [[np.abs(a - b).mean() for b in decoded] for a in frames]
        for k, row in enumerate(differences):
            self.assertLess(row[k], 3)
            self.assertEqual(k, int(np.argmin(row)))

    def test_cloth_drop_is_drawn_without_a_flow(self):
        folder = write_cloth_drop(self.folder / "drop")
        self.assertEqual(0, cli.main([str(folder), "--quiet", "--dpi", "40"]))
        self.assertEqual({"fields.png", "fields.gif", "canopies.png"}, self.pictures(folder))
        run = read_run(folder)
        self.assert_no_text_overlaps_or_leaves(canopy_figure(View(Canopies(run), None, []), run.snapshots[-1]))
        figure = canopies_history_figure(run)
        energies = {tuple(line.get_ydata()) for line in panel_of(figure, "energy").lines}
        self.assertIn((0.0, -5.0, -5.0), energies)  # potential
        self.assertFalse([axes for axes in figure.axes if "drag" in axes.get_title(loc="left")])

    def test_cloth_without_positions_is_drawn_as_flow(self):
        run = read_run(write_canopies(self.folder / "run", ("velocity", "von_mises")))
        self.assertFalse(has_canopies(run))
        self.assertEqual(0, cli.main([str(run.path), "--quiet", "--movie", "none", "--dpi", "40"]))

    def test_lines_lead_to_payload_and_seams_do_not(self):
        canopies = Canopies(read_run(write_canopies(self.folder / "run")))
        self.assertEqual([GORES + 1], canopies.payloads.tolist())
        self.assertEqual(GORES, len(canopies.lines))
        self.assertEqual({GORES + 1}, set(canopies.lines[:, 1]))

    def test_risers_are_lines_and_no_payload_is_where_they_begin(self):
        path = write_canopies(self.folder / "run")
        with h5py.File(path / "fields.h5", "r+") as h5:
            mesh = h5["mesh/canopy"]
            for name, more in (("vertices", [[0.0, 0.0, -3.0]]), ("strings", [[GORES + 1, GORES + 2]])):
                values = np.concatenate((mesh[name][:], more)).astype(mesh[name].dtype)
                attributes = dict(mesh[name].attrs)
                del mesh[name]
                mesh[name] = values
                mesh[name].attrs.update(attributes)
        canopies = Canopies(read_run(path))
        self.assertEqual([GORES + 2], canopies.payloads.tolist())
        self.assertEqual(GORES + 1, len(canopies.lines))

    def test_nominal_area_is_that_of_disk_and_skirt(self):
        path = write_canopies(self.folder / "run")
        self.assertAlmostEqual(np.pi, nominal_area(read_run(path), 0))
        scene = (path / "scene.toml").read_text(encoding="utf-8")
        skirt = "diameter = 2.0\n[canopy.skirt]\nlength = 0.5\ndiameter = 1.0\n"
        (path / "scene.toml").write_text(scene.replace("diameter = 2.0\n", skirt), encoding="utf-8")
        self.assertAlmostEqual(np.pi * (1 + 0.75), nominal_area(read_run(path), 0))

    def test_section_of_cone_is_its_profile(self):
        run = read_run(write_canopies(self.folder / "run"))
        canopies, snapshot = Canopies(run), run.snapshots[2]
        section = canopies.section(snapshot, 1, 0.0)
        # Triangles that only touch the plane with the tip give points.
        section = section[np.linalg.norm(section[:, 1] - section[:, 0], axis=1) > 1e-12]
        self.assertEqual((2, 2, 3), section.shape)
        np.testing.assert_allclose(section[..., 1], 0, atol=1e-14)
        ends = sorted(map(tuple, np.round(section[..., [0, 2]].reshape(-1, 2), 12)))
        edge = round(np.cos(np.pi / GORES), 12)
        self.assertEqual([(-edge, 0.0), (0.0, 1.0), (0.0, 1.0), (edge, 0.0)], ends)
        self.assertEqual(0, len(canopies.section(snapshot, 2, 1.5)))
        self.assertEqual(GORES, len(canopies.section(snapshot, 2, 0.25)))

    def test_payload_hangs_below_cloth_in_both_views(self):
        run = read_run(write_canopies(self.folder / "run"))
        figure = canopy_figure(self.view(run), run.snapshots[2])
        flow = panel_of(figure, "speed")
        (section,) = [item for item in flow.collections if item.get_zorder() == 4]
        for drawn in (figure.axes[0].collections[0], section):
            axes = drawn.axes
            (payload,) = [line for line in axes.lines if line.get_marker() == "o"]
            highest = max(path.vertices[:, 1].max() for path in drawn.get_paths())
            self.assertGreater(highest, payload.get_ydata()[0] + 2)
            low, high = axes.get_ylim()
            self.assertTrue(low < payload.get_ydata()[0] < highest < high)

    def test_slice_shows_flow_behind_canopy_in_true_proportion(self):
        run = read_run(write_canopies(self.folder / "run"))
        figure = canopy_figure(self.view(run), run.snapshots[2])
        flow = panel_of(figure, "speed")
        box, (left, right, low, high) = flow.get_window_extent(), flow.axis()
        self.assertAlmostEqual((right - left) / (high - low), box.width / box.height, delta=1e-6)
        self.assertGreater(high - 1.0, 2.5)
        self.assertTrue(-3 <= left < -1 and 1 < right <= 3 and -4 <= low < -2 and high <= 6)

    def test_stress_colours_keep_one_scale(self):
        run = read_run(write_canopies(self.folder / "run"))
        drawing = CanopyFigure(self.view(run), run.snapshots)
        cloth = drawing.figure.axes[0].collections[0]
        colours = []
        for snapshot in run.snapshots[1:]:
            drawing.show(snapshot)
            colours.append(len({tuple(colour) for colour in np.round(cloth.get_facecolor(), 6)}))
            self.assertGreater(colours[-1], GORES)
        key = next(axes for axes in drawing.figure.axes if "von Mises" in axes.get_title(loc="left"))
        self.assertEqual(0, key.get_ylim()[0])
        self.assertAlmostEqual(GORES - 1, key.get_ylim()[1])

    def test_few_far_larger_stresses_exceed_the_scale(self):
        run = read_run(write_canopies(self.folder / "run"))
        stress = run.snapshots[2].canopy["von_mises"].values
        with mock.patch.object(Canopies, "stress", lambda *_: np.append(np.tile(stress, 100), 1e3)):
            drawing = CanopyFigure(self.view(run), [run.snapshots[2]])
        key = next(axes for axes in drawing.figure.axes if "von Mises" in axes.get_title(loc="left"))
        self.assertAlmostEqual(GORES - 1, key.get_ylim()[1])

    def test_plane_of_the_flow_follows_the_canopy(self):
        folder = write_canopies(self.folder / "run")
        with h5py.File(folder / "fields.h5", "a") as h5:
            for k in range(3):
                h5[f"steps/{k:06d}/canopy/position"][:] += [0, 0.95 * k, 0]
        run = read_run(folder)
        view = self.view(run)
        self.assertEqual(0, len(view.canopies.section(run.snapshots[2], 1, view.plane.place)))
        view.plane = plane_through_canopy(view.canopies, view.plane)
        # Cells are 1 m wide; a canopy that moves less leaves the plane where it is.
        self.assertEqual([0.5, 0.5, 1.5], [view.plane.at(snapshot).place for snapshot in run.snapshots])
        drawing = CanopyFigure(view, run.snapshots)
        for snapshot, place in zip(run.snapshots, (0.5, 0.5, 1.5)):
            drawing.show(snapshot)
            self.assertIn(f"y = {place} m", "".join(text.get_text() for text in drawing.figure.texts))
            _, image, *_, cut, _ = drawing._slices[0]
            self.assertGreater(len(cut.get_segments()), 0)
            speed = np.linalg.norm(snapshot.fields["velocity"].values, axis=-1)
            np.testing.assert_array_equal(view.plane.at(snapshot).cut(speed), image.get_array())
        with mock.patch.object(style, "save_figure", lambda figure, *_: "".join(t.get_text() for t in figure.texts)):
            for words, place in ((["--movie", "none"], "y = 1.5"), (["--movie", "none", "--slice", "y=0.2"], "y = 0.5")):
                drawn = list(cli.draw(cli.arguments([str(folder), *words])))
                self.assertIn(place, drawn[0])

    def test_plane_passes_through_the_canopy_nearest_to_it(self):
        run = read_run(write_canopies(self.folder / "run"))
        mesh, snapshot = run.canopy_mesh, run.snapshots[0]
        count = len(mesh["vertices"].values)
        for name in ("vertices", "triangles"):
            more = mesh[name].values + ([0, 3.0, 0] if name == "vertices" else count)
            mesh[name] = dataclasses.replace(mesh[name], values=np.concatenate((more * 0 + mesh[name].values, more)))
        place = snapshot.canopy["position"]
        both = np.concatenate((place.values + [0, -2.0, 0], place.values + [0, 1.4, 0]))
        snapshot.canopy["position"] = dataclasses.replace(place, values=both)
        canopies = Canopies(run)
        self.assertEqual([GORES + 1, GORES + 1], [len(part) for part in canopies.parts()])
        moving = plane_through_canopy(canopies, plane_of(run, "y"))
        self.assertEqual(set(range(count, count + GORES + 1)), set(moving.vertices.tolist()))

    def test_shows_the_most_telling_check_in_the_heading(self):
        run = read_run(write_canopies(self.folder / "run"))
        check = {"value": 0.03, "tolerance": 0.1, "passed": True}
        run.result["checks"] = [check | {"name": name} for name in ("divergence", "canopy_0_drag_coefficient_mean", "force_balance")]
        (title,) = [text.get_text() for text in canopy_figure(self.view(run), run.snapshots[2]).texts if "t =" in text.get_text()]
        self.assertIn(", canopy drag coefficient mean off by 0.03 (tolerance 0.1)", title)

    def test_says_in_every_heading_which_check_failed_most(self):
        run = read_run(write_canopies(self.folder / "run", payload_speed=1.0))
        failed = {"name": "divergence", "value": 2e-6, "tolerance": 1e-9, "passed": False}
        run.result["checks"] = [{"name": "canopy_0_drag_coefficient_mean", "value": 0.03, "tolerance": 0.1, "passed": True}, failed,
                                failed | {"name": "momentum", "value": 2e-9}]
        words = ", FAILED: divergence 2e-06 (tolerance 1e-09)"
        for figure in (canopy_figure(self.view(run), run.snapshots[2]), canopies_history_figure(run)):
            self.assertTrue(any(text.get_text().endswith(words) for text in figure.texts))
        run.result["checks"] = [failed | {"value": None}, failed]
        self.assertEqual(", FAILED: divergence is not finite (tolerance 1e-09)", check_caption(run.result))
        run.result["checks"] = [failed | {"value": 1e-3, "tolerance": 0.0}, failed]
        self.assertEqual(", FAILED: divergence 0.001 (tolerance 0)", check_caption(run.result))
        self.assertEqual(", FAILED: numerical failure", check_caption({"status": "numerical-failure", "checks": []}))
        run.result["checks"] = [failed | {"passed": True}]
        self.assertEqual("", failure_caption(run.result))

    def test_shades_are_equal_for_both_sides_and_limited(self):
        corners = np.random.default_rng(5).normal(size=(200, 3, 3))
        white = np.ones((200, 4))
        shaded = shading.shade(corners, white, 0.7)
        np.testing.assert_allclose(shaded, shading.shade(corners[:, ::-1], white, 0.7))
        self.assertTrue(0.7 <= shaded[:, :3].min() and shaded[:, :3].max() <= 1)
        self.assertEqual(4, len(np.unique(np.round(shading.shade(corners, white, 0.7, 4)[:, 0], 9))))

    def test_drag_coefficient_is_that_of_velocity_relative_to_payload(self):
        run = read_run(write_canopies(self.folder / "run", payload_speed=1.0))
        np.testing.assert_allclose(relative_velocity(run, 0), [[0, 0, 3]] * 3)
        np.testing.assert_allclose(
            drag_coefficient(run, 0), np.array([0, 50, 25]) / (0.5 * 1.5 * 9 * np.pi), rtol=1e-12
        )

    def test_velocity_that_changes_counts_as_zero(self):
        run = read_run(write_canopies(self.folder / "run", side='"sin(t)"'))
        np.testing.assert_allclose(relative_velocity(run, 0), [[0, 0, 4]] * 3)

    def test_history_shows_what_checks_allow(self):
        fixed, free = (
            canopies_history_figure(read_run(write_canopies(self.folder / f"{speed}", payload_speed=speed)))
            for speed in (0.0, 1.0)
        )
        self.assertEqual(4, len(fixed.axes))
        self.assertEqual(6, len(free.axes))
        expected = {"lines on the payload": (0.5, 40, 1, 40), "drag": (1, 0.4, 1, 0.2), "speed": (1, 2.7, 1, 0.6)}
        for words, (start, low, length, height) in expected.items():
            axes = panel_of(free, words)
            (band,) = axes.patches
            np.testing.assert_allclose(
                (*band.get_xy(), band.get_width(), band.get_height()), (start, low, length, height)
            )
            self.assertTrue(axes.get_ylim()[0] < low and low + height < axes.get_ylim()[1])
        air, lines = panel_of(fixed, "lines on the payload").lines
        np.testing.assert_allclose(air.get_ydata(), [0, 50, 25])
        np.testing.assert_allclose(lines.get_ydata(), [0, 50, 24])
        self.assertIn("nominal: 3.1", [text.get_text() for text in panel_of(fixed, "projected area").texts])

    def test_curves_of_several_canopies_are_labelled(self):
        run = read_run(write_canopies(self.folder / "run", canopies=5, payload_speed=0.5))
        figure = canopies_history_figure(run)
        labels = [text.get_text() for text in panel_of(figure, "lines on the payload").texts]
        self.assertEqual({f"{words} {k}" for words in ("air", "lines") for k in range(5)}, set(labels))

    def test_no_text_overlaps_or_leaves_figure(self):
        run = read_run(write_canopies(self.folder / "run", payload_speed=1.0))
        bodies = read_run(write_bodies(self.folder / "bodies"))
        for figure in (
            canopy_figure(self.view(run), run.snapshots[2]),
            canopies_history_figure(run),
            forces_history_figure(bodies),
        ):
            self.assert_no_text_overlaps_or_leaves(figure)

    def test_forces_on_bodies_stand_beside_expected_mean(self):
        run = read_run(write_bodies(self.folder / "run"))
        figure = forces_history_figure(run)
        cylinder, sphere = panel_of(figure, "cylinder 0"), panel_of(figure, "sphere 1")
        self.assertIn("mean along x / 2 N = 1.5, expected 1.4", cylinder.get_title(loc="left"))
        (band,) = cylinder.patches
        np.testing.assert_allclose((*band.get_xy(), band.get_width(), band.get_height()), (2, 2.52, 2, 0.56))
        self.assertEqual({"x", "y"}, {text.get_text() for text in cylinder.texts})  # z is round-off
        self.assertLess(cylinder.get_ylim()[1], 10)  # without the start
        self.assertEqual((3, 0), (len(sphere.lines), len(sphere.patches)))
        self.assertEqual(0, cli.main([str(run.path), "--quiet"]))
        self.assertTrue((run.path / "forces.png").is_file())

    def test_drums_have_no_panels_of_lines_and_payloads(self):
        run = read_run(write_drum(self.folder / "run"))
        figure = canopies_history_figure(run)
        titles = [axes.get_title(loc="left") for axes in figure.axes]
        self.assertEqual([], [title for title in titles if any(word in title for word in ("line", "payload", "drag"))])
        self.assertIn("height of the centre of mass, z (m)", titles)
        self.assertTrue(all(axes.lines for axes in figure.axes))
        self.assert_no_text_overlaps_or_leaves(figure)

    def test_spheres_stand_beside_canopies(self):
        run = read_run(write_drum(self.folder / "run"))
        figure = canopy_figure(self.view(run), run.snapshots[-1])
        view, plane = self.view(run), panel_of(figure, "speed")
        circles = [[patch for patch in axes.patches if isinstance(patch, Circle)] for axes in (figure.axes[0], plane)]
        (beside,), (cut,) = circles
        self.assertEqual(0.8, beside.radius)
        self.assertAlmostEqual(np.sqrt(0.8**2 - view.plane.place**2), cut.radius)

    def test_plates_on_springs_and_flags_are_drawn(self):
        run = read_run(write_springs_and_flags(self.folder / "run"))
        figure = forces_history_figure(run)
        (plate,) = panel_of(figure, "displacement of plate 0").lines
        np.testing.assert_allclose(plate.get_ydata(), [0, 0.01, -0.02])
        self.assertEqual({"x", "y"}, {text.get_text() for text in panel_of(figure, "tip of flag 0").texts})
        self.assertEqual(2, len(panel_of(figure, "force on flag 0").lines))
        self.assert_no_text_overlaps_or_leaves(figure)

    def test_mean_is_that_of_trapezoidal_rule(self):
        time, values = np.array([0, 1, 2, 4.0]), np.array([9, 1, 2, 3.0])
        self.assertAlmostEqual((1.5 + 2 * 2.5) / 3, mean_between(time, values, 1.0, 4.0))
        self.assertAlmostEqual(1.5, mean_between(time, values, 1.0, 3.0))

    def test_history_without_canopies_or_second_row_is_not_drawn(self):
        run = write_canopies(self.folder / "run")
        self.assertIsNone(forces_history_figure(read_run(run)))
        self.assertIsNone(canopies_history_figure(read_run(write_bodies(self.folder / "bodies"))))
        history = run / "history.csv"
        history.write_text("\n".join(history.read_text().splitlines()[:2]) + "\n")
        self.assertIsNone(canopies_history_figure(read_run(run)))

    def test_panel_of_undefined_values_has_a_range(self):
        low, high = Panel("", {"": np.full(3, np.nan)}).limits(np.arange(3.0))
        self.assertLess(low, high)
