"""Installs this build into a fresh prefix, builds the programs of examples/ against the package, and runs them."""

import json
import math
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(os.environ["DROGUE_SOURCE"])
BUILD = Path(os.environ["DROGUE_BUILD"])
CACHE = dict(
    line.split("=", 1)
    for line in (BUILD / "CMakeCache.txt").read_text(encoding="utf-8").splitlines()
    if "=" in line and not line.startswith(("#", "//"))
)


def cached(name):
    """The value of a CMake cache variable whatever its type, empty if there is none."""
    return next((value for key, value in CACHE.items() if key.split(":")[0] == name), "")


def has_gpu():
    return shutil.which("nvidia-smi") and subprocess.run(["nvidia-smi", "-L"], capture_output=True).returncode == 0


def binomial_put(spot, strike, rate, sigma, years, steps):
    """American put by the tree of Cox, Ross and Rubinstein (1979)."""
    dt = years / steps
    up = math.exp(sigma * math.sqrt(dt))
    p, discount = (math.exp(rate * dt) - 1 / up) / (up - 1 / up), math.exp(-rate * dt)
    payoff = [strike - spot * up ** k for k in range(-steps, steps + 1)]
    values = [max(payoff[k], 0.0) for k in range(0, 2 * steps + 1, 2)]
    for level in range(steps - 1, -1, -1):
        values = [max(discount * (p * values[k + 1] + (1 - p) * values[k]), payoff[steps - level + 2 * k])
                  for k in range(level + 1)]
    return values[0]


def merton_put(spot, strike, rate, sigma, years, intensity, mean, deviation):
    """European put under normal jumps of the logarithm: a Poisson sum of prices of Black and Scholes (Merton 1976)."""
    def normal(x):
        return 0.5 * math.erfc(-x / math.sqrt(2))

    growth = math.exp(mean + 0.5 * deviation ** 2) - 1
    price = 0.0
    for jumps in range(30):
        variance = sigma ** 2 * years + jumps * deviation ** 2
        forward = spot * math.exp((rate - intensity * growth) * years + jumps * (mean + 0.5 * deviation ** 2))
        d = (math.log(forward / strike) + 0.5 * variance) / math.sqrt(variance)
        put = strike * normal(math.sqrt(variance) - d) - forward * normal(-d)
        price += math.exp(-intensity * years) * (intensity * years) ** jumps / math.factorial(jumps) * put
    return math.exp(-rate * years) * price


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.prefix = Path(folder.name) / "prefix"
        cls.work = Path(folder.name)
        cls.run_command("cmake", "--install", BUILD, "--prefix", cls.prefix)

    @classmethod
    def run_command(cls, *command):
        result = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if result.returncode:
            raise AssertionError(f"{command}\n{result.stdout}\n{result.stderr}")
        return result.stdout

    def build(self, example, program):
        """Configures and builds a folder of examples/ against the package; returns its program."""
        options = [f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_BUILD_TYPE={cached('CMAKE_BUILD_TYPE')}"]
        if cached("DROGUE_SANITIZE") == "ON":
            options.append("-DCMAKE_CXX_FLAGS=-fsanitize=address,undefined")
        if cached("DROGUE_CUDA") == "ON":
            options.append(f"-DCMAKE_CUDA_COMPILER={cached('CMAKE_CUDA_COMPILER')}")
        folder = self.work / example
        self.run_command("cmake", "-S", SOURCE / "examples" / example, "-B", folder, "-G", "Ninja", *options)
        self.run_command("cmake", "--build", folder)
        if cached("DROGUE_CUDA") == "ON" and not has_gpu():
            self.skipTest("built and linked; a CUDA build of Kokkos starts on no machine without a GPU")
        return folder / program

    def test_examples_are_short(self):
        """At most 120 lines that are neither empty nor comments."""
        found = sorted((SOURCE / "examples").rglob("*.cpp"))
        self.assertEqual(3, len(found))
        for path in found:
            lines = path.read_text(encoding="utf-8").splitlines()
            self.assertLessEqual(sum(bool(re.match(r"\s*[^\s/]", line)) for line in lines), 120, path)

    def test_coupled_solvers(self):
        """Exact solution of the scheme, which converges to that of the sheet and the air; momentum, to round-off."""
        program = self.build("coupled_solvers", "coupled_solvers")
        # Sheet of 1 kg/m^2, 4 m of air of 1.2 kg/m^3, drag of 2 Pa s/m; the air moves as a whole.
        rate, end = 2 * (1 + 1 / 4.8), 0.32
        numbers = re.compile(r"\d+\.\d+")
        page = (SOURCE / "examples/README.md").read_text(encoding="utf-8").partition("```text\n")[2].partition("```")[0]
        output = self.run_command(program, "serial")
        self.assertEqual(numbers.sub("", page), numbers.sub("", output))
        for shown, now in zip(numbers.findall(page), numbers.findall(output)):
            self.assertAlmostEqual(float(shown), float(now), delta=2e-9)
        errors = []
        for steps in (64, 128):
            printed = numbers.findall(self.run_command(program, "serial", steps))
            sheet, relative, exact, momentum, expected = map(float, printed)
            self.assertAlmostEqual((1 - rate * end / steps) ** steps, relative, delta=2e-9)
            self.assertAlmostEqual(math.exp(-rate * end), exact, delta=1e-9)
            self.assertAlmostEqual((1 + 4.8 * relative) / 5.8, sheet, delta=2e-9)
            self.assertAlmostEqual(expected, momentum, delta=1e-14)
            errors.append(abs(relative - exact))
        self.assertAlmostEqual(2.0, errors[0] / errors[1], delta=0.05)

    def test_option_prices(self):
        """Prices are within their stated errors of a binomial tree and of the series of Merton (1976)."""
        output = self.run_command(self.build("option_prices", "option_prices"), "serial")
        prices = [tuple(map(float, line.split())) for line in output.splitlines()[1:]]
        (american, error, delta), (with_jumps, *_), (european, european_error, _) = prices
        tree = 0.5 * (binomial_put(40, 40, 0.05, 0.3, 0.5, 1000) + binomial_put(40, 40, 0.05, 0.3, 0.5, 1001))
        self.assertAlmostEqual(tree, american, delta=5e-4 + error)
        self.assertLess(error, 40 * 1e-5)
        self.assertTrue(-0.5 < delta < 0, delta)
        self.assertAlmostEqual(merton_put(40, 40, 0.05, 0.3, 0.5, 0.5, -0.1, 0.2), european, delta=1e-5 + european_error)
        self.assertGreater(with_jumps, max(american, european))

    def test_mini_app(self):
        """A mini-app outside of the repository has the command line, files and exit codes of the shipped ones."""
        program = self.build("mini_app", "drogue-heat")

        def run(code, *words):
            result = subprocess.run([program, *words], cwd=self.work, capture_output=True, text=True)
            self.assertEqual(code, result.returncode, f"{words}\n{result.stdout}\n{result.stderr}")
            return result.stdout + result.stderr

        self.assertIn("sine  A sine decays", run(0, "--list-scenes"))
        self.assertIn("drogue-heat", run(0, "--version"))
        self.assertIn("end_time = 0.02", run(0, "sine", "--print-scene"))
        common = ["sine", "--backend", "serial", "--out", "heat"]
        self.assertIn("linf", run(0, *common))
        folder = self.work / "heat"
        self.assertEqual({"fields.h5", "fields.xdmf", "history.csv", "restart.h5", "result.json", "scene.toml"},
                         {path.name for path in folder.iterdir()})
        reported = json.loads((folder / "result.json").read_text(encoding="utf-8"))
        self.assertEqual(("drogue-heat", "ok", 0.02), (reported["program"], reported["status"], reported["time"]))
        self.assertLess(reported["errors"]["linf"], 1e-3)
        self.assertEqual(3, (folder / "fields.xdmf").read_text(encoding="utf-8").count("<Time Value="))
        whole = (folder / "history.csv").read_text(encoding="utf-8")
        self.assertIn("holds a run", run(2, *common))
        self.assertIn("unknown key", run(3, *common, "--overwrite", "--set", "ends=1"))
        self.assertIn("linf is", run(5, *common, "--overwrite", "--set", "linf=0"))
        self.assertIn("no --study", run(2, "sine", "--study", "meshes=10:20"))
        with self.subTest("a run in two parts equals one run"):
            first = ["--overwrite", "--set", "end_time=0.01", "--set", "output.times=[0.0, 0.01]"]
            run(5, *common, *first, "--set", "output.restart_every=41", "--set", "linf=0")
            run(0, *common, "--restart", "auto")
            self.assertEqual(whole.splitlines()[-1], (folder / "history.csv").read_text(encoding="utf-8").splitlines()[-1])

    def test_headers_name_no_other_layer(self):
        include = self.prefix / "include/drogue"
        self.assertTrue((include / "kernels/gas/solver.hpp").is_file())
        self.assertEqual(["common", "kernels", "miniapps"], sorted(path.name for path in include.iterdir()))
        self.assertEqual(["framework"], [path.name for path in (include / "miniapps").iterdir()])
        self.assertFalse((include / "kernels/reference").exists())

    def test_arithmetic_is_handed_on(self):
        """A consumer of an exact build, and no other, compiles without fused multiply-add."""
        targets = (self.prefix / "lib/cmake/Drogue/DrogueTargets.cmake").read_text(encoding="utf-8")
        exact = cached("DROGUE_EXACT") == "ON"
        self.assertEqual(exact, "DROGUE_EXACT=1" in targets)
        self.assertEqual(exact, "-ffp-contract=off" in targets)

    def test_no_path_of_the_source_tree(self):
        for path in (self.prefix / "lib/cmake/Drogue").iterdir():
            text = path.read_text(encoding="utf-8")
            self.assertNotIn(f"{SOURCE}/cmake", text, path)
            for layer in ("common", "kernels", "miniapps"):
                self.assertNotIn(f"{SOURCE}/{layer}", text, path)
