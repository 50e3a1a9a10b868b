"""Makes a bundle for the host and runs it in a bare root, which holds the C library, a shell and nothing else."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["DROGUE_SOURCE"])
# The C library, and a static program that is the shell, readlink and env.
PACKAGES = ("libc6", "busybox-static")


def missing():
    """The reason why this machine cannot make a bare root; None where it can."""
    for tool in ("apt-get", "dpkg-deb", "unshare", "chroot", "tar"):
        if not shutil.which(tool):
            return f"a bare root needs {tool}, which is not here"
    if os.geteuid() != 0:
        return "chroot needs root"
    if subprocess.run(["unshare", "--mount", "--pid", "--fork", "true"], capture_output=True).returncode:
        return "this machine does not let root make mount namespaces"
    return None


@unittest.skipIf(missing(), missing())
class Bundle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.work = Path(folder.name)
        cls.root = cls.work / "root"
        cls.make_root()
        result = subprocess.run([SOURCE / "scripts/bundle.sh", "--no-cuda"], capture_output=True, text=True)
        if result.returncode:
            raise AssertionError(f"{result.stdout}\n{result.stderr}")
        cls.messages = result.stderr.splitlines()
        archive = cls.work / "bundle.tar"
        subprocess.run(["tar", "-cf", archive, "-C", SOURCE / "build/bundle", "drogue"], check=True)
        subprocess.run(["tar", "-xf", archive, "-C", cls.root], check=True)

    @classmethod
    def make_root(cls):
        cls.root.mkdir()
        # A folder that the user of apt's downloads may write.
        packages = cls.work / "packages"
        packages.mkdir()
        result = subprocess.run(["apt-get", "download", *PACKAGES], cwd=packages, capture_output=True, text=True)
        if result.returncode:
            raise unittest.SkipTest(f"apt-get cannot download {' and '.join(PACKAGES)}: {result.stderr.splitlines()[-1]}")
        for package in packages.glob("*.deb"):
            subprocess.run(["dpkg-deb", "-x", package, cls.root], check=True)
        for name in ("bin", "tmp", "proc", "dev"):
            (cls.root / name).mkdir(exist_ok=True)
        for name in ("sh", "readlink", "env"):
            (cls.root / "bin" / name).symlink_to("/bin/busybox")

    def run_there(self, *words, code=0):
        """The output of a program of the bundle in the root, without any environment."""
        command = ("mount -t proc proc \"$0/proc\" && mount --bind /dev \"$0/dev\" && "
                   "exec chroot \"$0\" /bin/env -i PATH=/bin sh -c 'cd /tmp && exec \"$@\"' sh \"$@\"")
        result = subprocess.run(["unshare", "--mount", "--pid", "--fork", "sh", "-c", command, self.root, *words],
                                capture_output=True, text=True)
        self.assertEqual(code, result.returncode, f"{words}\n{result.stdout}\n{result.stderr}")
        return result.stdout

    def test_root_is_bare(self):
        libraries = [path.name for path in self.root.rglob("lib*.so*") if "drogue" not in path.parts]
        self.assertIn("libc.so.6", libraries)
        self.assertFalse([name for name in libraries if name.startswith(("libstdc++", "libgomp", "libmpi", "libhdf5"))])

    def test_size_is_stated_before_and_after(self):
        first = next(line for line in self.messages if "will have about" in line)
        expected = int(first.split("about ")[1].split(" MB")[0])
        size = int(self.messages[-1].split(" has ")[1].split(" MB")[0])
        self.assertEqual("== build/bundle/drogue", self.messages[-1].split(" has ")[0])
        self.assertLess(abs(size - expected), 0.25 * expected)

    def test_lists_scenes(self):
        for program, scene in (("drogue-gas", "sod"), ("drogue-springs", "drum")):
            self.assertIn(scene, self.run_there(f"/drogue/bin/{program}", "--list-scenes"))

    def test_runs_a_verified_scene(self):
        output = self.run_there("/drogue/bin/drogue-gas", "sod", "--backend", "openmp", "--out", "sod")
        self.assertIn("l1", output)
        self.assertTrue((self.root / "tmp/sod/result.json").is_file())

    def test_prices_a_batch(self):
        self.run_there("/drogue/bin/drogue-options", "price", "example", "--out", "prices.csv", "--result", "prices.json")
        self.assertTrue((self.root / "tmp/prices.csv").is_file())

    def test_measures_a_case(self):
        self.assertIn("gas", self.run_there("/drogue/bin/drogue-perf", "list"))

    def test_name_of_no_program(self):
        (self.root / "drogue/bin/other").symlink_to("drogue.host")
        self.run_there("/drogue/bin/other", code=2)
