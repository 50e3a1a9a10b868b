"""Rejected restart files, and permitted changes between a run and its continuation."""

import os
import sys
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import gas_program

SETS = ["mesh.cells=200", "output.restart_every=25", "output.times=[0.1, 0.2]", "run.end_time=0.2",
        "verify.l1_density=1.0"]


class RestartFiles(gas_program.GasTest):
    def setUp(self):
        super().setUp()
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "run", sets=SETS)
        self.file = self.folder / "run/restart.h5"
        self.bytes = self.file.read_bytes()

    def resume(self, code, *words, scene="sod", sets=SETS):
        words = words or ("--restart", "auto")
        return self.expect(code, scene, "--quiet", "--backend", "serial", "--out", "run", *words, sets=sets).stderr

    def assert_refused(self, word, scene="sod", sets=SETS):
        kept = {name: (self.folder / "run" / name).read_bytes() for name in ("history.csv", "fields.h5", "restart.h5")}
        message = self.resume(6, scene=scene, sets=sets)
        self.assertIn("restart.h5", message)
        self.assertIn(word, message)
        reported = self.result("run")
        self.assertEqual(("io-error", 6), (reported["status"], reported["exit_code"]))
        self.assertIn(reported["message"], message)
        for name, content in kept.items():
            self.assertEqual(content, (self.folder / "run" / name).read_bytes(), f"{name} was touched")

    def test_rejects_truncated_files(self):
        for length in (len(self.bytes) - 1, len(self.bytes) // 2, 600, 512):
            with self.subTest(length):
                self.file.write_bytes(self.bytes[:length])
                self.assert_refused("truncated")

    def test_rejects_files_that_are_no_restart_file(self):
        for content in (b"", b"x", b"time [s]\n0\n" * 100, bytes(range(256)) * 64, self.bytes[:100],
                        (self.folder / "run/fields.h5").read_bytes()):
            with self.subTest(length=len(content)):
                self.file.write_bytes(content)
                self.assert_refused("restart file")

    def test_rejects_damaged_files(self):
        for place in (513, 2048, len(self.bytes) - 1):
            with self.subTest(place):
                damaged = bytearray(self.bytes)
                damaged[place] ^= 0x10
                self.file.write_bytes(damaged)
                self.assert_refused("damaged")

    def test_rejects_a_later_format(self):
        self.file.write_bytes(self.bytes.replace(b"drogue.restart/1", b"drogue.restart/2", 1))
        self.assert_refused("drogue.restart/2")

    def test_rejects_another_scene(self):
        self.assert_refused("another scene", scene="toro-1",
                            sets=["run.end_time=0.1", "output.times=[0.1]", "verify.l1_density=1.0"])

    def test_rejects_the_folder_of_another_run(self):
        words = ["--quiet", "--backend", "serial", "--out", "other"]
        self.expect(0, "sod", *words, sets=[*SETS, "mesh.cells=100"])
        names = ("history.csv", "fields.h5", "scene.toml", "result.json")
        before = [(self.folder / "other" / name).read_bytes() for name in names]
        message = self.expect(2, "sod", *words, "--restart", "run/restart.h5", sets=SETS).stderr
        self.assertIn("'other' holds a run of another scene; choose another --out", message)
        self.assertEqual(before, [(self.folder / "other" / name).read_bytes() for name in names])
        later = [*SETS, "run.end_time=0.25", "output.times=[0.1, 0.2, 0.25]"]
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "new", "--restart", "run/restart.h5", sets=later)
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "new", "--restart", "run/restart.h5", sets=later)

    def test_rejects_another_scheme_or_mesh(self):
        for change in ("mesh.cells=100", 'scheme.weno="js"', "scheme.cfl=0.5", "gas.gamma=1.3",
                       'boundary.left="reflecting"'):
            with self.subTest(change):
                self.assert_refused("another scene", sets=[*SETS, change])

    def test_rejects_an_end_time_that_has_passed(self):
        self.assert_refused(" s, later than run.end_time = 0.1", sets=[*SETS, "run.end_time=0.1", "output.times=[0.1]"])

    def test_reports_a_missing_file(self):
        self.assertIn("no/such.h5", self.resume(2, "--restart", "no/such.h5"))

    def test_reports_a_folder_instead_of_a_file(self):
        self.assertIn("'run'", self.resume(6, "--restart", "run"))

    def test_continues_a_named_file_in_a_new_directory(self):
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "new", "--restart", str(self.file), sets=SETS)
        old, new = self.folder / "run", self.folder / "new"
        last = gas_program.fields(old), gas_program.fields(new)
        for field in ("rho", "u", "p"):
            one, other = (file.datasets[f"/steps/{file.children('/steps')[-1]}/{field}"] for file in last)
            self.assertEqual(one, other)

    def test_continues_to_a_later_end_time(self):
        longer = [*SETS, "run.end_time=0.4", "output.times=[0.1, 0.2, 0.4]", "run.max_steps=5000"]
        self.resume(0, sets=longer)
        self.expect(0, "sod", "--quiet", "--backend", "serial", "--out", "whole", sets=longer)
        whole, part = self.folder / "whole", self.folder / "run"
        self.assertEqual(gas_program.fields(whole).datasets, gas_program.fields(part).datasets)
        self.assertEqual((whole / "history.csv").read_text(), (part / "history.csv").read_text())
        self.assertEqual(0.4, self.result("run")["time"])

    def test_continues_on_another_backend(self):
        self.expect(0, "sod", "--quiet", "--backend", gas_program.threaded(), "--out", "run", "--restart", "auto", sets=SETS)

    def test_rejects_other_fields(self):
        """fields.xdmf lists the same fields for all outputs."""
        for fields in ('["rho"]', '["rho", "u"]'):
            with self.subTest(fields):
                message = self.resume(6, sets=[*SETS, f"output.fields={fields}"])
                self.assertIn("fields.h5", message)
                self.assertIn("other fields", message)
        self.resume(0, sets=[*SETS, 'output.fields=["p", "u", "rho"]'])

    def test_restart_and_overwrite_exclude_each_other(self):
        self.resume(2, "--restart", "auto", "--overwrite")


if __name__ == "__main__":
    unittest.main()
