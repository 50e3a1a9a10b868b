"""Full disks, file-size limits and unwritable directories: one sentence, no partial file, exit code 6."""

import os
import resource
import shutil
import subprocess

import gas_program
import small_disk


class DiskTest(gas_program.GasTest):
    def assert_no_half_files(self, directory):
        """Expects no temporary files, and readable files under their final names."""
        names = {path.name for path in directory.iterdir()}
        self.assertEqual([], sorted(name for name in names if name.startswith(".")))
        if "result.json" in names:
            self.assertEqual(("io-error", 6), tuple(gas_program.result(directory)[key] for key in
                                                    ("status", "exit_code")))
        for name in names & {"fields.h5", "restart.h5"}:
            file = gas_program.fields(directory, name)
            for path, content in file.datasets.items():
                self.assertTrue(content, path)

    def run_with_limit(self, bytes_allowed, *words, sets=()):
        """A file-size limit emulates a full disk without mounting a file system."""
        line = gas_program.arguments("sod", "--backend", "serial", "--quiet", "--out", "run", *words, sets=sets)
        limit = (bytes_allowed, resource.RLIM_INFINITY)
        return subprocess.run(line, cwd=self.folder, capture_output=True, text=True, check=False, timeout=300,
                              env=gas_program.ENVIRONMENT,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit))


class FileSizeLimit(DiskTest):
    def test_every_limit_is_reported_in_one_sentence(self):
        sets = ["mesh.cells=400", "output.restart_every=20", "output.history_every=1"]
        ends = set()
        for limit in (0, 100, 600, 3000, 20_000, 60_000, 120_000, 400_000, 4_000_000):
            with self.subTest(limit):
                shutil.rmtree(self.folder / "run", ignore_errors=True)
                run = self.run_with_limit(limit, sets=sets)
                ends.add(run.returncode)
                self.assertIn(run.returncode, (0, 6), run.stderr)
                if run.returncode == 6:
                    self.assertEqual(1, len(run.stderr.splitlines()), run.stderr)
                    self.assertRegex(run.stderr, "File too large|cannot write")
                    self.assert_no_half_files(self.folder / "run")
        self.assertEqual({0, 6}, ends)

    def test_keeps_the_former_restart_file(self):
        sets = ["mesh.cells=400", "output.restart_every=20", gas_program.NO_FIELDS, "run.max_steps=40"]
        self.expect(4, "sod", "--backend", "serial", "--quiet", "--out", "run", sets=sets)
        before = (self.folder / "run/restart.h5").read_bytes()
        sets[-1] = "run.max_steps=100"
        run = self.run_with_limit(5000, "--restart", "auto", sets=sets)
        self.assertEqual(6, run.returncode, run.stderr)
        self.assertEqual(before, (self.folder / "run/restart.h5").read_bytes())
        self.assert_no_half_files(self.folder / "run")
        sets[-1] = "run.max_steps=1000"
        self.expect(0, "sod", "--backend", "serial", "--quiet", "--out", "run", "--restart", "auto", sets=sets)

    def test_reports_a_full_device(self):
        with open("/dev/full", "w", encoding="utf-8") as full:
            line = gas_program.arguments("sod", "--print-scene")
            run = subprocess.run(line, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(6, run.returncode)
        self.assertEqual(1, len(run.stderr.splitlines()), run.stderr)


class OwnFileSystem(DiskTest):
    """Skipped without the right to mount: the tests with a limit on file sizes stand for these."""

    def mounted(self, options):
        return small_disk.mounted(self.folder / "disk", options)

    def test_reports_a_full_disk(self):
        """The disk fills at the start, during writes of fields or restart file, and just before the end."""
        for size in ("4k", "16k", "64k", "200k", "400k"):
            with self.subTest(size):
                with self.mounted(f"size={size}") as disk:
                    run = self.start("sod", "--backend", "serial", "--quiet", "--out", disk / "run",
                                     sets=["mesh.cells=800", "output.restart_every=20"])
                    self.assertEqual(6, run.returncode, run.stderr)
                    self.assertEqual(1, len(run.stderr.splitlines()), run.stderr)
                    self.assertIn("No space left", run.stderr)
                    if (disk / "run").exists():
                        self.assert_no_half_files(disk / "run")

    def test_continues_once_there_is_space(self):
        """The run continues from its restart file once there is space."""
        sets = ["mesh.cells=800", "output.restart_every=20"]
        with self.mounted("size=500k") as disk:
            run = self.start("sod", "--backend", "serial", "--quiet", "--out", disk / "run", sets=sets)
            self.assertEqual(6, run.returncode, run.stderr)
            subprocess.run(["mount", "-o", "remount,size=20m", disk], check=True)
            self.expect(0, "sod", "--backend", "serial", "--quiet", "--out", disk / "run", "--restart", "auto", sets=sets)
            self.expect(0, "sod", "--backend", "serial", "--quiet", "--out", "whole", sets=sets)
            self.assertEqual(gas_program.fields(self.folder / "whole").datasets,
                             gas_program.fields(disk / "run").datasets)

    def test_reports_a_read_only_file_system(self):
        with self.mounted("size=1m") as disk:
            (disk / "there").mkdir()
            subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
            for out in (disk / "new", disk / "there"):
                self.assertIn("Read-only", self.expect(6, "sod", "--quiet", "--out", out).stderr)


class Forbidden(DiskTest):
    def test_reports_missing_permission(self):
        locked = self.folder / "locked"
        locked.mkdir(mode=0o555)
        if os.access(locked, os.W_OK):
            self.skipTest("root may write everywhere")
        self.assertIn("Permission denied", self.expect(6, "sod", "--quiet", "--out", "locked").stderr)
        self.assertIn("Permission denied", self.expect(6, "sod", "--quiet", "--out", "locked/run").stderr)

    def test_reports_a_folder_without_write_access(self):
        self.assertIn("/proc", self.expect(6, "sod", "--quiet", "--out", "/proc/drogue").stderr)
