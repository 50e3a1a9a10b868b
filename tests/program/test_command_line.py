"""Options, messages and exit codes of the command line of drogue-gas."""

import os
import pathlib
import re
import shutil
import subprocess

import gas_program

COARSE = ["mesh.cells=50", "verify.l1_density=1.0", gas_program.NO_FIELDS]

# Kokkos tool that counts kernels.
TOOL = """
#include <stdint.h>
#include <stdio.h>
static long count = 0;
static void begin(uint64_t* id) { *id = (uint64_t)++count; }
void kokkosp_begin_parallel_for(const char* name, uint32_t device, uint64_t* id) { begin(id); }
void kokkosp_begin_parallel_reduce(const char* name, uint32_t device, uint64_t* id) { begin(id); }
void kokkosp_begin_parallel_scan(const char* name, uint32_t device, uint64_t* id) { begin(id); }
void kokkosp_finalize_library(void) { printf("tool saw %ld kernels\\n", count); }
"""


class Information(gas_program.GasTest):
    def test_help_lists_the_options(self):
        text = self.expect(0, "--help").stdout
        for option in ("--backend", "--set", "--out", "--restart", "--check", "--print-scene", "--list-scenes",
                       "--overwrite", "--quiet", "--seed-mode", "--study", "--version", "--kokkos-"):
            self.assertIn(option, text)

    def test_version_lists_the_build(self):
        text = self.expect(0, "--version").stdout
        self.assertRegex(text, r"^drogue-gas \d+\.\d+\.\d+\n")
        commands = (pathlib.Path(os.environ["DROGUE_BUILD"]) / "compile_commands.json").read_text(encoding="utf-8")
        backends = "serial openmp" if "-DDROGUE_HAVE_OPENMP=1" in commands else "serial\n"
        for word in ("git: ", "Kokkos: 4.5.1", "backends: " + backends, "MPI: ", "HDF5: ", "FFTW: ", "hypre: "):
            self.assertIn(word, text)

    def test_list_names_every_scene(self):
        self.assert_lists(gas_program.SCENES)

    def test_information_writes_no_files(self):
        for words in (["--help"], ["--version"], ["--list-scenes"], ["sod", "--check"], ["sod", "--print-scene"]):
            self.expect(0, *words)
        self.assertEqual([], list(self.folder.iterdir()))


class PrintScene(gas_program.GasTest):
    def test_printed_scene_resolves_to_itself(self):
        for scene in gas_program.SCENES:
            with self.subTest(scene):
                self.resolved(scene)

    def test_prints_assigned_values(self):
        for sets in (['scheme.weno="js"'], ['scheme.weno="teno5"', "scheme.fixed_dt=1e-4"], [gas_program.NO_FIELDS],
                     ["tuning.stage.block=64"], ["tuning.seed.pinned=true"], ['boundary.left="periodic"', 'boundary.right="periodic"', "verify={}"],
                     ["run.end_time=0.123456789012345678", "output.times=[1e-300, 0.1]"]):
            with self.subTest(sets=sets):
                self.resolved("sod", sets=sets)

    def test_baseline_prints_its_own_scheme(self):
        text = self.resolved("sod", "--seed-mode")
        for line in ('weno = "js"', 'splitting = "lf-global"', 'mean = "conserved"', 'time = "ssprk3"'):
            self.assertIn(line, text)

    def test_omits_inapplicable_keys(self):
        text = self.resolved("sod", sets=['scheme.weno="js"', "scheme.fixed_dt=1e-4", gas_program.NO_FIELDS])
        for key in ("weno_power", "cfl", "ramp_steps", "times", "regions", "expression"):
            self.assertNotRegex(text, rf"(?m)^{key} =")
        for key in ("max_steps", "positivity", "precision", "history_every", "left", "right"):
            self.assertRegex(text, rf"(?m)^{key} =")


class Usage(gas_program.GasTest):
    def assert_usage(self, word, *words, code=2):
        message = self.expect(code, *words).stderr
        self.assertIn(word, message)
        self.assertEqual([], list(self.folder.iterdir()), "a refused command leaves nothing behind")

    def test_unknown_option_suggests_the_nearest(self):
        self.assert_usage('"--backend"', "sod", "--bakend", "serial")

    def test_unknown_scene_suggests_the_nearest(self):
        self.assert_usage('"sod"', "sodd")
        self.assert_usage("valid names are blast", "no/such/file.toml")

    def test_rejects_invalid_arguments(self):
        for words in (["sod", "extra"], ["sod", "--backend", "gpu"], ["sod", "--set", "foo"], ["sod", "--set"],
                      ["sod", "--out"], ["sod", "--check", "--print-scene"], ["--check"], ["--quiet"], [str(self.folder)]):
            with self.subTest(words=words):
                self.assert_usage("", *words)

    def test_rejects_invalid_study_axes(self):
        for lists in ("meshes=7", "meshes=a", "schemes=weno", "cells=10", "meshes=", "meshes", "times=rk4", "",
                      "meshes=100:50.5"):
            with self.subTest(lists):
                self.assert_usage("--study", "sod", "--study", lists)

    def test_reports_an_absent_backend(self):
        if "cuda" in self.expect(0, "--version").stdout.split("backends:")[1].splitlines()[0]:
            self.skipTest("a CUDA build has that backend")
        message = self.expect(77, "sod", "--backend", "cuda").stderr
        self.assertRegex(message, r"cuda.*not compiled in.*preset 'cuda'")
        reported = self.result("out/sod")
        self.assertEqual(("no-backend", 77), (reported["status"], reported["exit_code"]))
        self.expect(0, "sod", "--quiet", "--backend", "serial", sets=COARSE)  # a run with the same name still works

    def test_rejects_several_ranks(self):
        for environment in ({"OMPI_COMM_WORLD_SIZE": "2", "OMPI_COMM_WORLD_RANK": "0"}, {"OMPI_COMM_WORLD_SIZE": "2"},
                            {"PMI_SIZE": "4", "PMI_RANK": "0"}):
            with self.subTest(environment=environment):
                message = self.expect(2, "sod", environment=environment).stderr
                self.assertIn("one rank", message)
        silent = self.start("sod", environment={"OMPI_COMM_WORLD_SIZE": "2", "OMPI_COMM_WORLD_RANK": "1"})
        self.assertEqual((2, "", ""), (silent.returncode, silent.stdout, silent.stderr))
        self.expect(0, "sod", "--quiet", sets=COARSE,
                    environment={"OMPI_COMM_WORLD_SIZE": "1", "OMPI_COMM_WORLD_RANK": "0"})


class Kokkos(gas_program.GasTest):
    def coarse(self, code, *words, **settings):
        return self.expect(code, "sod", "--overwrite", "--quiet", "--out", "run", *words, sets=COARSE, **settings)

    @gas_program.needs_openmp
    def test_passes_kokkos_options_through(self):
        self.assertIn("Kokkos Version: 4.5.1", self.coarse(0, "--kokkos-print-configuration").stdout)
        self.coarse(0, "--backend", "openmp", "--kokkos-num-threads=1")
        self.assertEqual(1, self.result("run")["threads"])

    @gas_program.needs_openmp
    def test_passes_kokkos_variables_through(self):
        self.coarse(0, "--backend", "openmp", environment={"KOKKOS_NUM_THREADS": "1"})
        self.assertEqual(1, self.result("run")["threads"])

    @gas_program.needs_openmp
    def test_limits_the_number_of_threads(self):
        self.expect(0, "sod", "--quiet", "--backend", "openmp", "--out", "run", sets=[*COARSE, "run.end_time=1e-6"],
                    environment={"OMP_NUM_THREADS": "600"})
        self.assertEqual(512, self.result("run")["threads"])

    def test_rejects_invalid_numbers_of_threads(self):
        """Kokkos would abort or overrun its table of threads for these values."""
        for number in ("abc", "0", "-1", "1000", "99999999999"):
            with self.subTest(number):
                self.assertIn(number, self.coarse(2, f"--kokkos-num-threads={number}").stderr)
                self.assertIn(number, self.coarse(2, environment={"KOKKOS_NUM_THREADS": number}).stderr)

    def test_tools_see_every_kernel(self):
        """The profiling callbacks of the program do not replace those of a tool."""
        compiler = shutil.which("cc") or shutil.which("gcc")
        if compiler is None:
            self.skipTest("no C compiler to make a tool with")
        (self.folder / "tool.c").write_text(TOOL)
        subprocess.run([compiler, "-shared", "-fPIC", "-o", "tool.so", "tool.c"], cwd=self.folder, check=True)
        text = self.coarse(0, "--backend", "serial", environment={"KOKKOS_TOOLS_LIBS": str(self.folder / "tool.so")}).stdout
        seen = int(re.fullmatch(r"tool saw (\d+) kernels\n", text)[1])
        reported = self.result("run")
        self.assertGreaterEqual(seen, 2 * reported["steps"])
        self.assertGreaterEqual(seen, reported["ledger"]["kernel_launches"])

    def test_missing_tool_is_reported_and_ignored(self):
        run = self.start("sod", "--quiet", "--out", "run", sets=COARSE, environment={"KOKKOS_TOOLS_LIBS": "/no/tool.so"})
        self.assertEqual(0, run.returncode, run.stderr)
        self.assertTrue(re.search("KokkosP|tool", run.stderr))
