"""drogue-plot and the demo execute no file of the user's folder, and obey none of the user's settings of Python and matplotlib."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import packages  # before modules that need the packages  isort: skip
from folder_test import FolderTest
import synthetic

_SHADOWED = ("plot", "csv", "json", "numpy", "matplotlib", "h5py", "PIL", "runpy", "sitecustomize", "usercustomize")
_TRAP = "import pathlib\npathlib.Path({mark!r}).touch()\nraise SystemExit(0)\n"


def write_launcher(folder, python=sys.executable, package=packages.SOURCE / "scripts"):
    """The launcher as CMake writes it, in `folder`/bin; returns its path."""
    text = (packages.SOURCE / "cmake" / "drogue-plot.in").read_text()
    text = text.replace("@PROJECT_SOURCE_DIR@/scripts", str(package)).replace("@PROJECT_VERSION@", "1.2.3")
    launcher = folder / "bin" / "drogue-plot"
    launcher.parent.mkdir(parents=True)
    launcher.write_text(text.replace("@PROJECT_SOURCE_DIR@/build/venv/bin/python", str(python)))
    launcher.chmod(0o755)
    return launcher


class Isolation(FolderTest):
    def setUp(self):
        super().setUp()
        self.folder = self.folder.resolve()
        self.here = self.folder / "here"
        self.here.mkdir()
        self.mark = self.folder / "executed"
        self.launcher = write_launcher(self.folder)

    def start(self, *words, environment=None):
        return subprocess.run([str(word) for word in words], capture_output=True, text=True, cwd=self.here,
                              env=os.environ | (environment or {}), timeout=300, check=False)

    def assert_draws(self, environment=None, launcher=None):
        """Asserts that the history in the working folder is drawn as in an empty one, without a word of Python or matplotlib."""
        synthetic.write_history(self.here / "history.csv")
        done = self.start(launcher or self.launcher, ".", environment=environment)
        self.assertEqual((0, "history.png\n", ""), (done.returncode, done.stdout, done.stderr))
        self.assertFalse(self.mark.exists())
        return (self.here / "history.png").read_bytes()

    def write_traps(self, folder):
        trap = _TRAP.format(mark=str(self.mark))
        for name in _SHADOWED:
            (folder / f"{name}.py").write_text(trap)
        (folder / "plot").mkdir(parents=True)
        for name in ("__init__", "__main__"):
            (folder / "plot" / f"{name}.py").write_text(trap)

    def test_executes_no_file_of_the_working_folder(self):
        self.write_traps(self.here)
        self.assert_draws()
        self.assert_draws({"PYTHONPATH": f":.:{self.here}"})

    def test_finds_an_installed_package_through_a_link(self):
        shutil.copytree(packages.SOURCE / "scripts" / "plot", self.folder / "share" / "drogue" / "plot")
        (self.folder / "bin" / "drogue-plot").unlink()
        (self.folder / "bin").rmdir()
        launcher = write_launcher(self.folder, package=self.folder / "absent")
        self.write_traps(self.here)
        link = self.folder / "drogue-plot"
        link.symlink_to(launcher)
        for name in (launcher, link):
            self.assert_draws({"CDPATH": str(self.folder)}, name)
        self.assertIn("drogue-plot 1.2.3 (git", self.start(link, "--version").stdout)

    def test_demo_executes_no_file_of_the_working_folder(self):
        self.write_traps(self.here)
        (self.folder / "empty").mkdir()
        line = next(line for line in (packages.SOURCE / "scripts/demo.sh").read_text().splitlines() if "plot.demo" in line)
        command = line.removesuffix("\\").replace("$root", str(packages.SOURCE)).replace("$python", sys.executable)
        done = self.start("sh", "-c", f"{command} --bin {self.folder / 'empty'} --out out", environment={"PYTHONPATH": "."})
        self.assertEqual((2, 1), (done.returncode, done.stderr.count("\n")), done.stderr)
        self.assertIn("holds no mini-app", done.stderr)
        self.assertFalse(self.mark.exists())

    def test_settings_of_python_change_nothing(self):
        plain = self.assert_draws()
        other = self.folder / "other"
        (other / "numpy").mkdir(parents=True)
        (other / "numpy" / "__init__.py").write_text("raise ImportError('numpy for another Python')\n")
        (other / "start.py").write_text(_TRAP.format(mark=str(self.mark)))
        self.assertEqual(plain, self.assert_draws({"PYTHONPATH": str(other)}))
        self.assertEqual(plain, self.assert_draws({
            "PYTHONHOME": str(other), "PYTHONSTARTUP": str(other / "start.py"), "PYTHONINSPECT": "1", "PYTHONPLATLIBDIR": "none",
            "PYTHONOPTIMIZE": "2", "PYTHONUSERBASE": str(other), "PYTHONIOENCODING": "ascii",
        }))

    def test_settings_of_matplotlib_change_nothing(self):
        plain = self.assert_draws()
        home = self.folder / "home"
        settings = home / ".config" / "matplotlib"
        (settings / "stylelib").mkdir(parents=True)
        # The cache of fonts stays: making it takes seconds, and a sentence.
        cache = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
        own = {"HOME": str(home), "XDG_CONFIG_HOME": str(home / ".config"), "XDG_CACHE_HOME": cache}
        for text in (b"text.usetex: True\nsavefig.dpi: 30\nlines.linewidth: 9\nbackend: module://absent\n", b"no.such.key: 1\n", b"\xff\xfe"):
            with self.subTest(text):
                (settings / "matplotlibrc").write_bytes(text)
                (settings / "stylelib" / "own.mplstyle").write_bytes(text)
                self.assertEqual(plain, self.assert_draws(own | {"MPLBACKEND": "module://matplotlib_inline.backend_inline"}))
                (self.here / "matplotlibrc").write_bytes(text)
                self.assertEqual(plain, self.assert_draws({"MATPLOTLIBRC": str(settings), "MPLBACKEND": "absent"}))
                (self.here / "matplotlibrc").unlink()

    def test_folder_of_settings_that_cannot_be_made_prints_nothing(self):
        """It is below a file, so that no user can make it."""
        (self.folder / "file").touch()
        self.assert_draws({"MPLCONFIGDIR": str(self.folder / "file" / "settings")})

    def test_finds_packages_of_a_path_where_the_interpreter_has_none(self):
        bare = self.folder / "bare"
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", bare], check=True)
        launcher = write_launcher(self.folder / "second", bare / "bin" / "python")
        absent = {"DROGUE_VENV": str(self.folder / "absent")}
        done = self.start(launcher, ".", environment=absent)
        self.assertEqual((2, 1), (done.returncode, done.stderr.count("\n")), done.stderr)
        site = next(path for path in sys.path if (Path(path) / "numpy" / "__init__.py").is_file())
        self.assert_draws(absent | {"PYTHONPATH": site}, launcher)

    def test_names_broken_packages_in_one_sentence(self):
        bare = self.folder / "bare"
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", bare], check=True)
        launcher = write_launcher(self.folder / "second", bare / "bin" / "python")
        broken = self.folder / "broken"
        for name in ("numpy", "matplotlib", "h5py", "PIL"):
            (broken / name).mkdir(parents=True)
            (broken / name / "__init__.py").write_text("raise ImportError('compiled for another Python')\n")
        done = self.start(launcher, ".", environment={"PYTHONPATH": str(broken)})
        self.assertEqual((2, 1), (done.returncode, done.stderr.count("\n")), done.stderr)
        self.assertIn("compiled for another Python", done.stderr)
