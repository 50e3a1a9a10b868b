"""Figures of synthetic runs of cloth, strings and contact bodies."""


import packages  # before modules that need the packages  isort: skip
import h5py
import numpy as np
from drawn import PictureTest
from PIL import Image, ImageSequence
from plot import cli, style
from plot.run_directory import read_run
from plot.springs.fabric_figure import View, fabric_figure
from plot.springs.history_figure import springs_history_figure

assert packages.SOURCE


def write_run(folder, vertices, triangles, edges, moved, stress=None, directions=None, contact="", strings=None):
    """Writes a run directory whose snapshots have the positions `moved`; returns its path."""
    folder.mkdir()
    (folder / "scene.toml").write_text('app = "springs"\n' + contact)
    header = "time [s],step,kinetic [J],elastic [J],potential [J],energy [J],probe_0_x [m],probe_0_y [m],probe_0_z [m]"
    rows = [f"{0.1 * k},{k},{1.0 + k},{2.0 - k},0,3,0,0,{0.1 * k}" for k in range(3)]
    (folder / "history.csv").write_text("\n".join([header, *rows]) + "\n")
    with h5py.File(folder / "fields.h5", "w") as h5:
        for name, values in (("vertices", vertices), ("triangles", triangles), ("edges", edges)):
            h5[f"mesh/{name}"] = np.array(values).reshape(-1, 2 if name == "edges" else 3)
        if strings is not None:
            h5["mesh/strings"] = np.array(strings)
        h5.create_group("steps")
        for k, positions in enumerate(moved):
            group = h5.create_group(f"steps/{k:06d}")
            group.attrs["time"] = 0.1 * k
            group["position"] = positions
            if stress is not None:
                group["von_mises"] = stress[k]
            if directions is not None:
                group["major_direction"] = np.array(directions, float)
    return folder


SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
TRIANGLES = [[0, 1, 2], [0, 2, 3]]
EDGES = [[0, 1], [1, 2], [2, 3], [0, 3], [0, 2]]


class SpringsPictures(PictureTest):
    def assert_drawn(self, run):
        self.assertEqual(0, cli.main([str(run), "--quiet"]))
        self.assertEqual({"fields.png", "fields.gif", "history.png"}, self.pictures(run))

    def test_draws_cloth_in_space(self):
        raised = SQUARE + [[0, 0, 0], [0, 0, 0], [0, 0, 0.5], [0, 0, 0]]
        run = write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE, raised], [[0.0, 0.0], [2.0, 1.0]])
        self.assert_drawn(run)
        view = View(read_run(run))
        self.assertIsNone(view.labels)
        self.assertEqual(("von Mises stress", "N/m"), view.quantity)
        np.testing.assert_allclose(np.eye(3), view.projection @ view.projection.T, atol=1e-15)
        self.assertGreater(view.projection[1] @ [0, 0, 1], 0.5, "the vertical axis must point upwards")
        with Image.open(run / "fields.gif") as movie:
            self.assertEqual(2, movie.n_frames)

    def test_rejects_unknown_field_with_nearest_name(self):
        run = write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE], [[1.0, 1.0]])
        self.assertIn("no field 'von_mise'; nearest is von_mises", self.refusal(run, "--field", "von_mise"))
        self.assertEqual(0, cli.main([str(run), "--quiet", "--field", "von_mises"]))

    def test_rejects_run_without_snapshots(self):
        run = write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [])
        history = run / "history.csv"
        history.write_text("\n".join(history.read_text().splitlines()[:2]) + "\n")
        self.assertIn("nothing to draw", self.refusal(run))
        self.assertIn("no field 'position'; it has none", self.refusal(run, "--field", "position"))

    def test_draws_flat_cloth_in_its_plane(self):
        run = write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE, 1.5 * SQUARE])
        self.assert_drawn(run)
        view = View(read_run(run))
        self.assertEqual(("x", "y"), view.labels)
        np.testing.assert_allclose(view.values(view.run.snapshots[1]), (0.5 + np.sqrt(0.5)) / 3)

    def test_displacement_excludes_prestretch(self):
        moved = 1.5 * SQUARE + [0, 0, 1e-6]
        run = write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [moved], contact="[initial]\nprestretch = 0.5\n")
        view = View(read_run(run))
        np.testing.assert_allclose(view.values(view.run.snapshots[0]), 1e-6)

    def test_draws_string_in_its_plane(self):
        line = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], float)
        sagging = line - [[0, 0, 0], [0, 0, 1], [0, 0, 0]]
        run = write_run(self.folder / "run", line, [], [[0, 1], [1, 2]], [line, sagging])
        self.assert_drawn(run)
        self.assertEqual(("x", "z"), View(read_run(run)).labels)

    def test_strings_beside_cloth_are_visible(self):
        """Strings hang from a corner, or lie along the common edge of two triangles, on a ridge or in a valley."""
        place = np.array([*SQUARE, [1.5, 0, -0.5], [2, 0, -1]], float)
        for name, height in (("valley", 0.4), ("ridge", -0.4), ("flat", 0)):
            folded = place * [1, 1, int(height != 0)] + np.outer([0, 1, 0, 1, 0, 0], [0, 0, height])
            for strings, least in (([], 0), ([[5, 4], [4, 1]], 200), ([[2, 0]], 200)):
                for stress in (None, [[0.0, 2.0]]):
                    with self.subTest(name, strings=strings, stress=stress):
                        run = write_run(
                            self.folder / f"{name}-{len(strings)}-{stress is None}", place, TRIANGLES,
                            [*EDGES, [1, 4], [4, 5]], [folded], stress, strings=np.array(strings, int).reshape(-1, 2),
                        )
                        pixels = self.vermilion(run)
                        self.assertTrue(pixels > least if strings else pixels == 0, pixels)

    def test_strings_beside_cloth_move_in_movie(self):
        place = np.array([*SQUARE, [1.5, 0, -0.5]], float)
        moved = place + np.outer([0, 0, 0, 0, 1], [0, 0.5, 0.2])
        run = write_run(self.folder / "run", place, TRIANGLES, [*EDGES, [1, 4]], [place, moved], strings=[[1, 4]])
        self.assert_drawn(run)
        with Image.open(run / "fields.gif") as movie:
            frames = [np.asarray(frame.convert("RGB"), float) for frame in ImageSequence.Iterator(movie)]
        first, last = (self.vermilion_of(frame.reshape(-1, 3).T) for frame in frames)
        self.assertGreater(np.count_nonzero(first & ~last), 20)
        self.assertGreater(np.count_nonzero(last & ~first), 20)

    def test_edges_are_strings_only_without_cloth(self):
        for triangles, count in ((TRIANGLES, 0), ([], 5)):
            run = write_run(self.folder / f"run{count}", SQUARE, triangles, EDGES, [SQUARE])
            self.assertEqual(count, len(View(read_run(run)).segments))

    def test_history_subtracts_works_of_contact_and_friction(self):
        run = write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE])
        rows = ["time [s],step,kinetic [J],elastic [J],potential [J],energy [J],contact_work [J],friction_work [J]",
                "0,0,4,0,0,4,0,0", "1,1,2,0,0,2,-1.5,-0.5", "2,2,1,0,0,1,-2,-0.9"]
        (run / "history.csv").write_text("\n".join(rows) + "\n")
        figure = springs_history_figure(read_run(run))
        energies, rest = figure.axes
        title = rest._left_title.get_window_extent(figure.canvas.get_renderer())
        self.assertLess(title.x1, figure.bbox.width)
        self.assertEqual(5, len(energies.lines))
        np.testing.assert_allclose(rest.lines[0].get_ydata(), [0, 0, -0.1 / 4], atol=1e-15)

    def test_history_scales_like_energy_check(self):
        """The scale includes the kinetic energy that the released elastic and potential energy could give."""
        run = write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE])
        rows = ["time [s],step,kinetic [J],elastic [J],potential [J],energy [J]",
                "0,0,1,3,5,9", "1,1,4,0,5,9", "2,2,0,1,-2,-1"]
        (run / "history.csv").write_text("\n".join(rows) + "\n")
        change = springs_history_figure(read_run(run)).axes[1].lines[0].get_ydata()
        np.testing.assert_allclose(change, [0, 0, -10 / (1 + 2 + 7)], atol=1e-15)

    def test_history_draws_no_sum_of_energies_where_pins_work(self):
        run = read_run(write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE]))
        for motion, count in ({}, 3), ({"x": "0", "y": 0.0}, 3), ({"x": "0", "z": "sin(t)"}, 2):
            run.scene["pin"] = [{"where": "1"}, {"where": "x < 0", "motion": motion}]
            titles = [axes.get_title(loc="left") for axes in springs_history_figure(run).axes]
            self.assertEqual((count, count == 3), (len(titles), any("change of sum" in title for title in titles)))

    def test_draws_directions_of_larger_stress(self):
        """Directions appear on flat cloth where the stress is large enough, and are shorter than the triangles."""
        run = write_run(
            self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE, SQUARE], [[1.0, 0.01]] * 2,
            [[0.6, 0.8, 0], [1, 0, 0]],
        )
        self.assert_drawn(run)
        view = View(read_run(run))
        ((start, end),) = view.stress_directions(view.run.snapshots[0])
        np.testing.assert_allclose((start + end) / 2, [2 / 3, 1 / 3])
        np.testing.assert_allclose((end - start) / np.linalg.norm(end - start), [0.6, 0.8])
        self.assertLess(np.linalg.norm(end - start), 0.6)
        without = write_run(self.folder / "without", SQUARE, TRIANGLES, EDGES, [SQUARE], [[1.0, 0.01]])
        view = View(read_run(without))
        self.assertEqual(0, len(view.stress_directions(view.run.snapshots[0])))

    def test_facets_lie_on_bodies_and_are_visible(self):
        """All facets lie on the body, cover its extent, and add grey pixels."""
        raised = SQUARE + [[0, 0, 0], [0, 0, 0], [0, 0, 0.5], [0, 0, 0]]
        bodies = {
            "disk": ("centre = [0.0, -0.1, 0.2], normal = [0, -0.6, 0.8], radius = 0.3",
                     lambda x: (np.abs((x - [0.0, -0.1, 0.2]) @ [0, -0.6, 0.8]), np.linalg.norm(x - [0.0, -0.1, 0.2], axis=-1), 0.3)),
            "sphere": ("centre = [0.5, 0.5, -1.0], radius = 0.4",
                       lambda x: (np.abs(np.linalg.norm(x - [0.5, 0.5, -1.0], axis=-1) - 0.4), x[..., 2], -0.6)),
            "plane": ("centre = [0.0, 0.0, -0.1], normal = [0, 0, 2]",
                      lambda x: (np.abs(x[..., 2] + 0.1), x[..., 0], 1.1)),
        }
        stress = [[0.0, 0.0], [2.0, 1.0]]
        plain = self.greys(write_run(self.folder / "plain", SQUARE, TRIANGLES, EDGES, [SQUARE, raised], stress))
        for kind, (words, of) in bodies.items():
            with self.subTest(kind):
                contact = f'[contact]\nobjects = [{{ kind = "{kind}", {words} }}, {{ kind = "level-set", expression = "z+9" }}]\n'
                run = write_run(self.folder / kind, SQUARE, TRIANGLES, EDGES, [SQUARE, raised], stress, contact=contact)
                distance, coordinate, largest = of(View(read_run(run)).body_facets)
                self.assertLess(distance.max(), 1e-12)
                self.assertAlmostEqual(largest, coordinate.max())
                self.assertGreater(self.greys(run), plain + 1000)

    def test_level_set_gives_closed_surface(self):
        """A level set that is not a number in parts of space gives facets where it is finite."""
        raised = SQUARE + [0, 0, 0.6]
        for text, closed in (
            ("(x-0.5)^2+(y-0.5)^2+(z-0.3)^2-0.16", True),
            ("sqrt((z+0.1)*(z+0.1))-0.2+0*sqrt(x)", False),
        ):
            with self.subTest(text):
                contact = f'[contact]\nobjects = [{{ kind = "level-set", expression = "{text}" }}]\n'
                run = write_run(
                    self.folder / f"run{closed}", SQUARE, TRIANGLES, EDGES, [SQUARE, raised], contact=contact
                )
                facets = View(read_run(run)).body_facets
                self.assertTrue(np.isfinite(facets).all())
                if closed:
                    distance = np.abs(np.linalg.norm(facets - [0.5, 0.5, 0.3], axis=-1) - 0.4)
                    self.assertLess(distance.max(), (1.6 / 48) ** 2)  # the square of the cells
                    _, corners = np.unique(facets.reshape(-1, 3), axis=0, return_inverse=True)
                    loops = corners.reshape(-1, 4)
                    edges = np.sort(np.stack((loops, np.roll(loops, 1, axis=1)), axis=-1).reshape(-1, 2), axis=1)
                    self.assertTrue((np.unique(edges, axis=0, return_counts=True)[1] == 2).all())
                else:
                    inner = facets[(facets[..., 0] > 0.1).all(axis=1)]
                    self.assertLess(np.abs(np.abs(inner[..., 2] + 0.1) - 0.2).max(), 1e-12)
                self.assertGreater(self.greys(run), 1000)

    @staticmethod
    def last_picture(run):
        """Red, green and blue of the pixels of the last snapshot, (3, n)."""
        view = View(read_run(run))
        drawn = fabric_figure(view, view.run.snapshots[-1])
        drawn.canvas.draw()
        colours = np.asarray(drawn.canvas.buffer_rgba(), float)[..., :3].reshape(-1, 3).T
        style.plt.close(drawn)
        return colours

    @staticmethod
    def vermilion_of(colours):
        """Mask of the pixels in the colour of strings."""
        red, green, blue = colours
        return (red > 190) & (np.abs(green - 94) < 30) & (blue < 40)

    def vermilion(self, run):
        return int(self.vermilion_of(self.last_picture(run)).sum())

    def greys(self, run):
        """Number of pixels of the last snapshot in the colour of bodies, lit or shaded."""
        red, green, blue = self.last_picture(run)
        return int(((red > green) & (green > blue) & (red - blue < 12) & (red > 90) & (red < 200)).sum())

    def test_body_below_cloth_is_outlined(self):
        contact = (
            "[contact]\nobjects = [{ kind = 'disk', centre = [0.5, 0.5, -0.1], normal = [0, 0, 1], radius = 0.3 },"
            "{ kind = 'sphere', centre = [0.5, 0.5, -0.4], radius = 0.2 }]\n"
        )
        bent = SQUARE + [[0, 0, 0.3], [0, 0, 0], [0, 0, 0.3], [0, 0, 0]]
        run = read_run(write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE, bent], contact=contact))
        view = View(run)
        figure = fabric_figure(view, run.snapshots[1])
        (outlines,) = [item for item in figure.axes[0].collections if item.get_linestyle()[0][1] is not None]
        disk, sphere = outlines.get_segments()
        centre, height = view.projection[:2] @ [0.5, 0.5, -0.1], view.projection[1] @ [0, 0, 1]
        np.testing.assert_allclose((disk.max(axis=0) - disk.min(axis=0)) / 2, [0.3, 0.3 * np.sqrt(1 - height**2)], rtol=1e-3)
        np.testing.assert_allclose((disk.max(axis=0) + disk.min(axis=0)) / 2, centre, atol=1e-3)
        np.testing.assert_allclose(np.linalg.norm(sphere - view.projection[:2] @ [0.5, 0.5, -0.4], axis=1), 0.2)
        self.assertTrue(any("outline of a body" in text.get_text() for text in figure.texts))

    def test_colour_scale_holds_all_values_but_a_few_that_are_far_larger(self):
        side = np.linspace(0, 1, 21)
        x, y = (values.ravel() for values in np.meshgrid(side, side))
        vertices = np.stack((x, y, 0.3 * x * y), axis=1)
        first = (21 * np.arange(20)[:, None] + np.arange(20)).ravel()
        triangles = np.concatenate([np.stack((first, first + 1, first + 22), 1), np.stack((first, first + 22, first + 21), 1)])
        even = np.linspace(0, 1, len(triangles))
        for name, largest, top, end in (("even", 1.0, 1.0, "neither"), ("far", 50.0, np.percentile(even, 99.5), "max")):
            stress = even.copy()
            stress[-1] = largest
            run = read_run(write_run(self.folder / name, vertices, triangles, EDGES, [vertices] * 2, stress=[3 * stress, stress]))
            figure = fabric_figure(View(run), run.snapshots[1])
            key = figure.axes[1]
            self.assertAlmostEqual(top, key.get_ylim()[1], delta=5e-3)  # of the drawn snapshot alone
            self.assertEqual(end, key._colorbar.extend)

    def test_colours_of_shaded_cloth_form_equal_classes(self):
        bent = SQUARE + [[0, 0, 0.3], [0, 0, 0], [0, 0, 0.3], [0, 0, 0]]
        run = write_run(self.folder / "run", SQUARE, TRIANGLES, EDGES, [SQUARE, bent], stress=[[0.0, 1.0], [0.2, 1.0]])
        self.assert_drawn(run)
        with Image.open(run / "fields.png") as image:
            pixels = np.asarray(image.convert("RGB")).astype(int)
        # The colour bar is the longest column of saturated colours.
        coloured = np.ptp(pixels, axis=2) > 40
        key = pixels[coloured[:, (column := coloured[:, 700:].sum(axis=0).argmax() + 700)], column]
        lengths = np.diff(np.flatnonzero(np.any(np.diff(key, axis=0) != 0, axis=1)))
        self.assertGreater(len(lengths), 200)
        self.assertLessEqual(lengths.max(), 4)

    def test_sphere_below_string_is_visible(self):
        line = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], float)
        sagging = line - [[0, 0, 0], [0, 0, 1], [0, 0, 0]]
        run = write_run(
            self.folder / "run", line, [], [[0, 1], [1, 2]], [line, sagging],
            contact='[contact]\nobjects = [{ kind = "sphere", centre = [1, 0, -2], radius = 0.5 }]\n',
        )
        self.assertGreater(self.greys(run), 1000)
