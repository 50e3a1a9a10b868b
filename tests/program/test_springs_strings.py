"""Strings in fields.h5 and fields.xdmf of drogue-springs, beside cloth and alone."""

import array
import math
import xml.etree.ElementTree

import springs_program

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"
# A rope from a corner, and a seam along the edge that both triangles share.
STRINGS = "v 1.5 0 -0.5\nv 2 0 -1\nl 2 5 6\nl 3 1\n"
SCENE = """app = "springs"
mesh.file = "m.obj"
pin = [{ where = "x==0" }]
load = [{ gravity = [0, 0, -9.81] }]
time.end_time = 0.002
output = { fields = ["position", "velocity", "von_mises", "vertex_stress"], times = [0, 0.002] }
"""
TAPE = 'reinforcement = [{ where = "y==0 && x<=1", axial_stiffness = 80.0, line_density = 0.002 }]\n'


class Strings(springs_program.SpringsTest):
    def run_of(self, obj, scene=SCENE):
        self.write(obj, "m.obj")
        self.expect(0, self.write(scene), "--quiet", "--backend", "serial", "--overwrite", "--out", "out")
        return self.fields("out")

    def strings_of(self, obj, scene=SCENE):
        file = self.run_of(obj, scene)
        self.assertEqual({"units", "centering", "description"}, set(file.attributes["/mesh/strings"]))
        numbers = list(array.array("q", file.datasets["/mesh/strings"]))
        return list(zip(numbers[::2], numbers[1::2], strict=True))

    def meshes(self):
        """Tuples (name, kind, path of the cells, centering of fields by name, times) of all grids of fields.xdmf."""
        datasets = self.fields("out").datasets
        root = xml.etree.ElementTree.parse(self.folder / "out/fields.xdmf").getroot()
        for item in root.iter("DataItem"):
            name, path = item.text.strip().split(":")
            self.assertEqual("fields.h5", name)
            self.assertEqual(8 * math.prod(map(int, item.get("Dimensions").split())), len(datasets[path]), path)
        found = []
        for series in root.findall("Domain/Grid"):
            self.assertEqual(("Collection", "Temporal"), (series.get("GridType"), series.get("CollectionType")))
            times = {}
            for k, grid in enumerate(series.findall("Grid")):
                self.assertEqual(f"fields.h5:/steps/{k:06d}/position", grid.find("Geometry/DataItem").text)
                cells = grid.find("Topology")
                fields = {field.get("Name"): field.get("Center") for field in grid.findall("Attribute")}
                mesh = (grid.get("Name"), cells.get("TopologyType"), cells.find("DataItem").text.split(":")[1], fields)
                times[float(grid.find("Time").get("Value"))] = mesh
            self.assertTrue(all(mesh == times[0.0] for mesh in times.values()))
            found.append((*times[0.0], list(times)))
        return found

    def test_strings_beside_cloth_form_their_own_grid(self):
        self.assertEqual([(1, 4), (4, 5), (2, 0)], self.strings_of(SQUARE + STRINGS))
        at_vertices = {"velocity": "Node", "vertex_stress": "Node"}
        self.assertEqual([("scene triangles", "Triangle", "/mesh/triangles", {**at_vertices, "von_mises": "Cell"}, [0.0, 0.002]),
                          ("scene strings", "Polyline", "/mesh/strings", at_vertices, [0.0, 0.002])], self.meshes())

    def test_reinforcements_come_last(self):
        self.assertEqual([(1, 4), (4, 5), (2, 0), (0, 1)], self.strings_of(SQUARE + STRINGS, SCENE + TAPE))
        self.assertEqual([(0, 1)], self.strings_of(SQUARE, SCENE + TAPE))

    def test_cloth_alone_forms_one_grid(self):
        self.assertEqual([], self.strings_of(SQUARE))
        self.assertEqual([("scene", "Triangle", "/mesh/triangles")], [mesh[:3] for mesh in self.meshes()])

    def test_strings_alone_form_one_grid(self):
        scene = SCENE.replace(', "von_mises", "vertex_stress"', "")
        self.assertEqual([(2, 1), (1, 0)], self.strings_of("v 0 0 0\nv 1 0 0\nv 2 0 0\nl 3 2 1\n", scene))
        self.assertEqual([("scene", "Polyline", "/mesh/strings")], [mesh[:3] for mesh in self.meshes()])
