"""scripts/profile_occupancy.sh, with programs in place of ncu and of a build with CUDA."""

import os
import pathlib
import subprocess

import perf_program

SOURCE = pathlib.Path(os.environ["DROGUE_SOURCE"])
# Lists two cases, and has the table of the real program.
PERF = f"""#!/bin/sh
case "$1" in
  list) printf 'gas-step/cuda/8192\\ngas-step/serial/8192\\nsprings-step/cuda/2640\\n' ;;
  ncu) echo "ncu '$4' $3" ;;
  *) exec {perf_program.PROGRAM} "$@" ;;
esac
"""
NCU = """#!/bin/sh
case "$1" in
  gas-step* | --launches) cp PROFILE "$2" ;;
  *) echo '==ERROR== ERR_NVGPUCTRPERM - no permission' >"$2"; exit 1 ;;
esac
"""


class ProfileOccupancy(perf_program.PerfTest):
    def setUp(self):
        super().setUp()
        self.program("build/bin/drogue-perf", PERF)

    def program(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def profile(self, *words):
        return subprocess.run([SOURCE / "scripts/profile_occupancy.sh", "out", self.folder / "build", *words],
                              cwd=self.folder, capture_output=True, text=True, check=False,
                              env={**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}"})

    def test_keeps_other_cases_if_one_fails(self):
        self.program("bin/ncu", NCU.replace("PROFILE", str(SOURCE / "tests/support/profiles/kernels.csv")))
        process = self.profile()
        self.assertEqual(1, process.returncode, process.stderr)
        self.assertIn("springs-step/cuda/2640 has no profiled kernel: ==ERROR== ERR_NVGPUCTRPERM", process.stderr)
        self.assertIn("25 of 26 cases and runs were profiled", process.stderr)
        self.assertIn("kernels are predicted to the block", process.stdout)
        self.assertTrue((self.folder / "out/occupancy.jsonl").exists())
        self.assertEqual(["gas-step-cuda-8192.csv"], [file.name for file in (self.folder / "out").glob("*-step-*.csv")])
        self.assertEqual(0, self.profile("gas").returncode)

    def test_reports_a_build_without_cases_on_cuda(self):
        self.program("bin/ncu", NCU)
        self.assertIn("is this a build with CUDA", self.profile("no such case").stderr)
