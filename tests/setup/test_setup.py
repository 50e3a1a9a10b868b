"""Every failure of scripts/setup.sh is one sentence with the remedy. Fakes stand in for the tools of the system."""

import os
import re
import shutil
import subprocess
from pathlib import Path

from folder_test import FolderTest

SOURCE = Path(os.environ.get("DROGUE_SOURCE", Path(__file__).resolve().parents[2]))
ALL_PACKAGES_THERE = 'shift 3; for name in "$@"; do echo "ii $name"; done'


class Setup(FolderTest):
    def setUp(self):
        super().setUp()
        self.fakes, self.deps = self.folder / "fakes", self.folder / "deps"
        self.fakes.mkdir()
        self.fake("dpkg-query", ALL_PACKAGES_THERE)
        self.fake("apt-get", "exit 0")

    def fake(self, name, script):
        path = self.fakes / name
        path.write_text(f"#!/bin/bash\n{script}\n", encoding="utf-8")
        path.chmod(0o755)
        return path

    def refused(self, *arguments, **environment):
        """The last line of standard error of a set-up that must fail."""
        settings = {
            **os.environ, "PATH": f"{self.fakes}:{os.environ['PATH']}", "DROGUE_DEPS": str(self.deps),
            **{name: str(value) for name, value in environment.items()},
        }
        result = subprocess.run(
            [SOURCE / "scripts/setup.sh", *arguments], env=settings, capture_output=True, text=True, timeout=60
        )
        self.assertEqual(1, result.returncode, result.stderr)
        last = result.stderr.strip().splitlines()[-1]
        self.assertTrue(last.startswith("setup.sh: "), last)
        self.assertTrue(last.endswith("."), last)
        return last

    def test_unknown_argument(self):
        self.assertIn("--cude", self.refused("--cude"))

    def test_help_is_the_head_of_the_script(self):
        for name in ("setup", "build", "test", "demo", "bench", "bundle"):
            said = subprocess.run([SOURCE / f"scripts/{name}.sh", "--help"], capture_output=True, text=True, check=True).stdout
            head = (SOURCE / f"scripts/{name}.sh").read_text(encoding="utf-8").split("\n. ")[0].splitlines()[1:]
            self.assertEqual([line.removeprefix("#").removeprefix(" ") for line in head], said.splitlines())

    def test_architecture_of_hip(self):
        self.assertIn("DROGUE_HIP_ARCH=gfx9 is not one of gfx906,", self.refused("--hip", DROGUE_HIP_ARCH="gfx9"))
        page = (SOURCE / "docs/building.md").read_text(encoding="utf-8")
        row = re.search(r"(?m)^\| `DROGUE_HIP_ARCH` \| (.+) \|$", page)[1]
        self.assertIn(f"not one of {', '.join(re.findall(r'gfx[0-9a-z]+', row))}, and", self.refused("--hip", DROGUE_HIP_ARCH="none"))
        self.fake("hipcc", '[[ "$*" != *=gfx942* ]]')
        message = self.refused("--hip", DROGUE_HIP_ARCH="gfx942")
        self.assertIn("does not compile for DROGUE_HIP_ARCH=gfx942: put hipcc of a newer ROCm first in PATH", message)
        self.fake("python3", "exit 1")
        self.assertIn("venv failed", self.refused("--hip"))

    def test_rejects_a_wrong_hash(self):
        archive = self.fakes / "kokkos.tar.gz"
        archive.write_bytes(b"something else")
        message = self.refused(DROGUE_KOKKOS_ARCHIVE=archive)
        self.assertIn("has SHA-256", message)
        self.assertIn("delete the file", message)

    def test_missing_archive(self):
        self.assertIn("cannot be read", self.refused(DROGUE_KOKKOS_ARCHIVE=self.fakes / "none"))

    def test_folder_that_cannot_be_written(self):
        self.assertIn("choose another folder with DROGUE_DEPS", self.refused(DROGUE_DEPS="/dev/null/deps"))

    def test_compiler_too_old(self):
        compiler = self.fake("g++-9", 'case "$1" in --version) echo "g++ (GCC) 9.4.0" ;; *) echo 9.4.0 ;; esac')
        self.assertIn("version 9.4.0 and C++20 needs 12", self.refused(CXX=compiler))

    def test_compiler_missing_with_system(self):
        self.assertIn("no C++ compiler", self.refused("--system", CXX="no-such-compiler"))
        if not shutil.which("hipcc"):
            self.assertIn("there is no hipcc: load a module of ROCm", self.refused("--system", "--hip", ROCM_PATH=self.folder))

    def test_cmake_too_old(self):
        self.fake("cmake", "echo cmake version 3.22.1")
        self.assertIn("cmake is version 3.22.1: install 3.25", self.refused())

    def test_no_permission_to_install(self):
        self.fake("dpkg-query", "exit 1")
        self.fake("id", "echo 1000")
        self.fake("sudo", "exit 1")
        self.assertRegex(self.refused(), r"run `sudo apt-get install -y --no-install-recommends g\+\+ .*libboost-math-dev`")

    def test_reports_a_missing_network(self):
        self.fake("dpkg-query", "exit 1")
        self.fake("id", "echo 0")
        self.fake("apt-get", "echo \"E: Temporary failure resolving 'deb.debian.org'\"; exit 100")
        self.assertIn("check the connection", self.refused())

    def test_disk_full_before_packages(self):
        self.fake("dpkg-query", "exit 1")
        self.fake("id", "echo 0")
        self.fake("df", "printf 'Filesystem 1024-blocks Used Available\\n/dev/x 100000 99000 1000 99%% /\\n'")
        self.assertIn("free some space", self.refused())

    def test_disk_full_while_installing(self):
        self.fake("dpkg-query", "exit 1")
        self.fake("id", "echo 0")
        self.fake("apt-get", 'if [[ "$*" == *install* ]]; then echo "No space left on device"; exit 100; fi')
        self.assertIn("the disk is full", self.refused())

    def test_other_systems(self):
        self.fake("dpkg-query", "exit 1")
        for tool in ("bash", "dirname", "basename", "nproc", "mkdir", "sed", "tr", "id"):
            real = subprocess.run(["which", tool], capture_output=True, text=True, check=True).stdout.strip()
            self.fake(tool, f'exec {real} "$@"')
        (self.fakes / "apt-get").unlink()
        self.assertIn("use --system", self.refused(PATH=self.fakes))

    def test_reasons_to_go_without_packages(self):
        log = self.deps / "log/apt-update.log"
        log.parent.mkdir(parents=True)
        script = f"cd {SOURCE} && . scripts/lib/common.sh && . scripts/lib/packages.sh && why_no_packages"

        def reason():
            environment = os.environ | {"PATH": f"{self.fakes}:{os.environ['PATH']}", "DROGUE_DEPS": str(self.deps)}
            return subprocess.run(["bash", "-c", script], env=environment, capture_output=True, text=True, check=True).stdout.strip()

        self.fake("id", "echo 0")
        self.assertEqual("", reason())
        log.write_text("Err:1 http://deb.debian.org/debian bookworm InRelease\n  Temporary failure resolving\n", encoding="utf-8")
        self.assertEqual("no network", reason())
        log.write_text("Hit:1 http://deb.debian.org/debian bookworm InRelease\nErr:2 http://x.org\n", encoding="utf-8")
        self.assertEqual("", reason())
        self.fake("id", "echo 1000")
        self.fake("sudo", "exit 1")
        self.assertEqual("no right to install packages", reason())
