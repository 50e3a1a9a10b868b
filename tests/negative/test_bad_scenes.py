"""Invalid gas scenes end with exit code 3 and a sentence that names file, line, key and valid values."""

import os
import pathlib
import subprocess

import bad_scenes
from folder_test import FolderTest

PROGRAM = pathlib.Path(os.environ["DROGUE_BIN"]) / "drogue-gas"


def check(scene, *sets):
    arguments = [str(PROGRAM), str(scene), "--check"]
    for assignment in sets:
        arguments += ["--set", assignment]
    return subprocess.run(arguments, capture_output=True, timeout=60, check=False)


class BadScenes(FolderTest):
    def setUp(self):
        super().setUp()
        self.scene = self.folder / "scene.toml"

    def write(self, content):
        if isinstance(content, str):
            content = content.encode()
        self.scene.write_bytes(content)

    def assert_refused(self, start, words, *sets):
        result = check(self.scene, *sets)
        message = result.stderr.decode(errors="replace").strip()
        self.assertEqual(result.returncode, 3, message)
        self.assertTrue(message.startswith(start), f"{message!r} does not start with {start!r}")
        for word in words:
            self.assertIn(word, message)
        self.assertEqual(len(message.splitlines()), 1, "one sentence on one line")
        self.assertEqual(result.stdout, b"")

    def test_unchanged_scene_is_valid(self):
        self.write(bad_scenes.GOOD)
        result = check(self.scene)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_rejects_invalid_lines(self):
        self.assertGreaterEqual(len(bad_scenes.BAD_LINES), 45)
        for line, text, blamed, words in bad_scenes.BAD_LINES:
            with self.subTest(line=line, text=text):
                lines = bad_scenes.GOOD.splitlines()
                lines[line - 1] = text
                self.write("\n".join(lines) + "\n")
                self.assert_refused(f"{self.scene}:{blamed}: ", words)

    def test_rejects_invalid_assignments(self):
        self.write(bad_scenes.GOOD)
        for sets, words in bad_scenes.BAD_SETS:
            with self.subTest(sets=sets):
                result = check(self.scene, *sets)
                message = result.stderr.decode()
                self.assertTrue(any(message.startswith(f"--set {item}: ") for item in sets), message)
                self.assert_refused("--set ", words, *sets)

    def test_rejects_invalid_utf8(self):
        self.write(bad_scenes.GOOD.encode().replace(b"A shock", b"\xff\xfe"))
        self.assert_refused(f"{self.scene}:2: ", [])

    def test_rejects_an_empty_file(self):
        self.write("")
        self.assert_refused(f"{self.scene}:1: ", ['missing key "app"'])

    def test_split_precision_error_names_its_bound(self):
        strong = "riemann = { left = { rho = 1.0, p = 1e12 }, right = { rho = 1.0, p = 1.0 } }"
        lines = bad_scenes.GOOD.splitlines()
        lines[8] = strong
        lines[21] = 'precision = "split"'
        self.write("\n".join(lines) + "\n")
        self.assert_refused(f"{self.scene}:22: ", ["FP32", "1e11", "1e+12"])

    def test_missing_files_are_usage_errors(self):
        for argument, word in (("no-such-scene", "no-such-scene"), ("sodd", '"sod"'), (self.folder, "folder")):
            result = check(argument)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(word, result.stderr.decode())
