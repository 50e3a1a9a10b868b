"""Invalid springs scenes and meshes end with exit code 3 and a sentence that names file, line and part."""

import bad_springs
import mutations
import springs_program


class BadSprings(springs_program.SpringsTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write(bad_springs.GOOD)
        self.mesh = self.write(bad_springs.MESH, "m.obj")

    def assert_refused(self, start, words, *sets):
        process = self.expect(3, self.scene, "--check", sets=sets)
        self.assertTrue(process.stderr.startswith(start), f"{process.stderr!r} does not start with {start!r}")
        for word in words:
            self.assertIn(word, process.stderr)
        self.assertEqual("", process.stdout)

    @staticmethod
    def spoiled(text, line, replacement):
        lines = text.splitlines()
        lines[line - 1] = replacement
        return "\n".join(lines) + "\n"

    def test_unchanged_scene_is_valid(self):
        report = self.expect(0, self.scene, "--check").stdout
        for words in ("6 vertices, 2 triangles, 2 lines", "angle        45 .. 90", "area         0.5 .. 0.5"):
            self.assertIn(words, report)

    def test_rejects_invalid_scenes(self):
        self.assertGreaterEqual(len(bad_springs.BAD_LINES), 25)
        for line, text, blamed, words in bad_springs.BAD_LINES:
            with self.subTest(line=line, text=text):
                self.scene.write_text(self.spoiled(bad_springs.GOOD, line, text), encoding="utf-8")
                self.assert_refused(f"{self.scene}:{blamed}: ", words)

    def test_rejects_invalid_meshes(self):
        self.assertGreaterEqual(len(bad_springs.BAD_MESHES), 10)
        for line, text, blamed, words in bad_springs.BAD_MESHES:
            with self.subTest(line=line, text=text):
                self.mesh.write_text(self.spoiled(bad_springs.MESH, line, text), encoding="utf-8")
                self.assert_refused(f"{self.mesh}:{blamed}: ", words)

    def test_rejects_files_that_are_no_mesh(self):
        for content in (b"", b"\0" * 100, b"\xff\xfe", b"solid stl\n", b"f 1 2 3\n"):
            with self.subTest(content[:10]):
                self.mesh.write_bytes(content)
                self.assert_refused(f"{self.mesh}:1: ", [])
        self.mesh.unlink()
        self.assert_refused(f"{self.scene}:4: ", ["mesh.file", "there is no file"])
        self.mesh.mkdir()
        self.assert_refused(f"{self.scene}:4: ", ["mesh.file", "directory"])

    def test_rejects_stress_without_triangles(self):
        string = ["mesh={string={}}", "material={}", "pin=[{where='x==0'}]", "mass=[{where='x==1',add=1}]"]
        self.expect(0, self.scene, "--check", sets=string)
        self.assert_refused("--set output.fields", ["von_mises", "triangles"], *string, 'output.fields=["von_mises"]')

    def test_rejects_the_linear_vector_model_with_motion(self):
        cloth = ["mesh={disk={}}", "material={model='linear-vector'}", "mass=[{where='x>0',add=1}]"]
        self.assert_refused("--set material", ["Model I", "moves"], *cloth)

    def test_damaged_meshes_are_rejected_or_read(self):
        """A damaged mesh is rejected or read; the program never ends by a signal or with another exit code."""
        for seed in range(60):
            with self.subTest(seed):
                self.mesh.write_bytes(mutations.mutate(bad_springs.MESH.encode(), seed))
                process = self.start(self.scene, "--check")
                self.assertIn(process.returncode, (0, 3), process.stderr)
                self.assertEqual(1 if process.returncode else 0, len(process.stderr.splitlines()))
