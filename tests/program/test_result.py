"""Contents of result.json, history.csv, fields.h5 and fields.xdmf after successful and failed runs."""

import math
import xml.etree.ElementTree

import gas_program

COARSE = ["mesh.cells=50", "verify.l1_density=1.0"]
KEYS = ["schema", "program", "version", "git", "scene", "backend", "device", "driver", "precision", "ranks", "threads",
        "status", "exit_code", "message", "steps", "time", "dt_min", "dt_max", "errors", "checks", "limiter", "timing",
        "ledger", "peak_bytes", "provenance"]
PARTS = {
    "limiter": ["touches", "cells"],
    "timing": ["wall_s", "setup_s", "compute_s", "h2d_s", "d2h_s", "io_s", "bound_s", "verify_s"],
    "ledger": ["kernel_launches", "fences", "device_allocations_after_warmup", "h2d_bytes", "d2h_bytes"],
    "peak_bytes": ["host", "device"],
    "provenance": ["compiler", "flags", "kokkos", "cpu", "gpu", "driver", "date"],
}
NORMS = {f"{norm}_{quantity}" for norm in ("l1", "l2", "linf") for quantity in ("density", "velocity", "pressure")}
HISTORY = ["time [s]", "step", "dt [s]", "mass [kg/m^2]", "momentum [kg/(m s)]", "energy [J/m^2]",
           "mass_outflow [kg/m^2]", "momentum_outflow [kg/(m s)]", "energy_outflow [J/m^2]", "max_speed [m/s]",
           "limiter_touches", "redone_steps"]


class Result(gas_program.GasTest):
    def ended(self, code, status, *words, sets=COARSE, directory="out/sod", **settings):
        """Runs sod and returns result.json; expects every field, the exit code and its status."""
        run = self.expect(code, "sod", "--backend", "serial", *words, sets=sets, **settings)
        reported = self.result(directory)
        self.assertLessEqual(set(KEYS), set(reported))
        for part, keys in PARTS.items():
            self.assertLessEqual(set(keys), set(reported[part]), part)
        self.assertEqual(("drogue.result/1", "drogue-gas", "sod", status, code),
                         tuple(reported[key] for key in ("schema", "program", "scene", "status", "exit_code")))
        self.assertIn(reported["message"], run.stderr)
        self.assertEqual(code == 0, reported["message"] == "")
        self.assertRegex(reported["provenance"]["date"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertGreater(reported["peak_bytes"]["host"], 1 << 20)
        self.assertEqual(1, reported["ranks"])
        return reported

    def test_successful_run_holds_every_field(self):
        reported = self.ended(0, "ok")
        self.assertEqual(("serial", "double", 1, 0.4), tuple(reported[key] for key in
                                                             ("backend", "precision", "threads", "time")))
        self.assertEqual(NORMS, set(reported["errors"]))
        self.assertEqual({"l1_density", "conservation"}, {check["name"] for check in reported["checks"]})
        for check in reported["checks"]:
            self.assertEqual({"name", "value", "tolerance", "passed"}, set(check))
        self.assertTrue(0.0 < reported["dt_min"] <= reported["dt_max"] < 0.4)
        self.assertEqual({"touches": 0, "cells": 0, "redone_steps": 0}, reported["limiter"])
        self.assertEqual({"space": 5, "time": 3}, reported["order"])
        self.assertTrue(0.0 < reported["timing"]["compute_s"] < reported["timing"]["wall_s"])
        # Three stages and the end of a step.
        self.assertGreaterEqual(reported["ledger"]["kernel_launches"], 2 * reported["steps"])
        self.assertEqual(0, reported["ledger"]["device_allocations_after_warmup"])
        for key in ("compiler", "kokkos", "cpu"):
            self.assertTrue(reported["provenance"][key], key)
        # 50 cells of at most 80 bytes, and 64 MB.
        self.assertTrue(50 * 24 < reported["peak_bytes"]["device"] < 64 << 20, reported["peak_bytes"])

    def test_without_verify_there_are_no_checks(self):
        scene = self.folder / "sod.toml"
        text = (gas_program.SOURCE / "miniapps/gas/scenes/sod.toml").read_text(encoding="utf-8")
        scene.write_text(text[:text.index("[verify]")], encoding="utf-8")
        without = self.expect(0, scene, "--backend", "serial")
        reported = self.result("out/sod")
        self.assertEqual(([], {}), (reported["checks"], reported["errors"]))
        self.assertEqual(1, without.stdout.count("nothing verified"))
        self.assertNotIn("nothing verified", self.expect(0, "sod", "--backend", "serial", "--out", "verified", sets=COARSE).stdout)
        self.assertEqual("", self.expect(0, scene, "--backend", "serial", "--overwrite", "--quiet").stdout)

    def test_errors_without_bounds_are_printed(self):
        scene = (gas_program.SOURCE / "miniapps/gas/scenes/sod.toml").read_text(encoding="utf-8")
        scene = self.write(scene[:scene.index("[verify]")] + '[verify]\nexact = "riemann"\n')
        text = self.expect(0, scene, "--backend", "serial", "--out", "unbounded", sets=["mesh.cells=50"]).stdout
        errors = self.result("unbounded")["errors"]
        self.assertIn("l1_density", errors)
        self.assertRegex(text, "\n".join(rf"  {name} +{errors[name]:.4g}" for name in sorted(errors))
                         + r"\n  nothing verified: the scene has no bound of these errors in \[verify\]\n")

    def test_failures_state_code_and_status(self):
        self.ended(3, "invalid", sets=["mesh.cells=7"])
        reported = self.ended(4, "numerical-failure", "--overwrite", sets=[*COARSE, "run.max_steps=5"])
        self.assertEqual(5, reported["steps"])
        self.assertIn("max_steps = 5", reported["message"])
        reported = self.ended(5, "verification-failed", "--overwrite", sets=["mesh.cells=50", "verify.l1_density=1e-9"])
        self.assertEqual([False, True], [check["passed"] for check in reported["checks"]])
        (self.folder / "out/sod/restart.h5").write_bytes(b"no restart file")
        self.expect(6, "sod", "--backend", "serial", "--restart", "auto", sets=["mesh.cells=50", "verify.l1_density=1e-9"])
        self.assertEqual(reported, self.result("out/sod"))
        (self.folder / "out/sod/result.json").unlink()
        self.ended(6, "io-error", "--restart", "auto", sets=["mesh.cells=50", "verify.l1_density=1e-9"])

    def test_records_split_precision(self):
        self.assertEqual("split", self.ended(0, "ok", sets=[*COARSE, 'scheme.precision="split"'])["precision"])

    @gas_program.needs_openmp
    def test_openmp_records_its_threads(self):
        self.expect(0, "sod", "--backend", "openmp", sets=COARSE, environment={"OMP_NUM_THREADS": "2"})
        reported = self.result("out/sod")
        self.assertEqual(("openmp", 2, "plain"), (reported["backend"], reported["threads"], reported["driver"]))

    def test_steps_need_no_fence_and_no_copy(self):
        """Twice the steps add kernel launches to the counters and nothing else."""
        reported = [self.ended(0, "ok", "--overwrite", sets=[f"mesh.cells={cells}", "verify.l1_density=1.0",
                                                         gas_program.NO_FIELDS, "output.history_every=0"])["ledger"]
                for cells in (50, 100)]
        self.assertGreater(reported[1]["kernel_launches"], 1.5 * reported[0]["kernel_launches"])
        self.assertEqual(reported[0]["fences"], reported[1]["fences"])

    def test_baseline_times_its_copies(self):
        reported = self.ended(0, "ok", "--seed-mode")
        for key in ("h2d_s", "compute_s", "d2h_s"):
            self.assertGreater(reported["timing"][key], 0.0, key)


class Files(gas_program.GasTest):
    def rows(self, directory="out/sod"):
        lines = (self.folder / directory / "history.csv").read_text().splitlines()
        self.assertEqual(HISTORY, lines[0].split(","))
        return [[float(word) for word in line.split(",")] for line in lines[1:]]

    def test_history_lists_rows_with_units(self):
        self.expect(0, "sod", "--backend", "serial", sets=[*COARSE, "output.history_every=1"])
        rows = self.rows()
        reported = self.result("out/sod")
        self.assertEqual([float(step) for step in range(reported["steps"] + 1)], [row[1] for row in rows])
        self.assertEqual((0.0, 0.4), (rows[0][0], rows[-1][0]))
        for before, row in zip(rows, rows[1:]):
            self.assertAlmostEqual(before[0] + row[2], row[0], places=14)
        self.assertEqual(reported["dt_max"], max(row[2] for row in rows))
        for row in rows:
            for total, start, left in zip(row[3:6], rows[0][3:6], row[6:9]):
                self.assertAlmostEqual(start, total + left, places=13)
            self.assertTrue(0.0 < row[9] < 10.0)

    def test_history_is_sparse_by_default(self):
        self.expect(0, "sod", "--backend", "serial", sets=[*COARSE, "output.history_every=10"])
        steps = [row[1] for row in self.rows()]
        self.assertEqual([0.0, 10.0, 20.0], steps[:3])
        self.assertEqual(self.result("out/sod")["steps"], steps[-1])

    def test_fields_hold_the_documented_layout(self):
        times = [0.0, 0.1, 0.25, 0.4]
        self.expect(0, "sod", "--backend", "serial", sets=[*COARSE, f"output.times={times}"])
        file = gas_program.fields(self.folder / "out/sod")
        groups = file.children("/steps")
        self.assertEqual(["000000", "000001", "000002", "000003"], groups)
        self.assertEqual(times, [file.attributes[f"/steps/{group}"]["time"] for group in groups])
        units = {"rho": "kg/m^3", "u": "m/s", "p": "Pa"}
        for path in ["/mesh/x", *(f"/steps/{group}/{field}" for group in groups for field in units)]:
            reported = file.attributes[path]
            self.assertEqual({"units", "centering", "description"}, set(reported), path)
            self.assertEqual(units.get(path.split("/")[-1], "m"), reported["units"])
            self.assertEqual("cell", reported["centering"])
            self.assertEqual(50, len(file.values(path)))
        centres = file.values("/mesh/x")
        for i, x in enumerate(centres):
            self.assertAlmostEqual(-1.0 + (i + 0.5) * 0.04, x, places=14)
        self.assertEqual([1.0] * 25 + [0.125] * 25, list(file.values("/steps/000000/rho")))
        self.assertTrue(all(math.isfinite(value) for path in file.datasets for value in file.values(path)))

    def test_writes_only_requested_fields(self):
        self.expect(0, "sod", "--backend", "serial", sets=[*COARSE, 'output.fields=["p"]', "output.times=[0.4]"])
        file = gas_program.fields(self.folder / "out/sod")
        self.assertEqual({"/mesh/x", "/steps/000000/p"}, set(file.datasets))

    def test_xdmf_names_every_output(self):
        self.expect(0, "sod", "--backend", "serial", sets=[*COARSE, "output.times=[0.0, 0.1, 0.4]"])
        folder = self.folder / "out/sod"
        root = xml.etree.ElementTree.parse(folder / "fields.xdmf").getroot()
        self.assertEqual("Xdmf", root.tag)
        self.assertEqual([0.0, 0.1, 0.4], [float(time.get("Value")) for time in root.iter("Time")])
        datasets = gas_program.fields(folder).datasets
        named = set()
        for item in root.iter("DataItem"):
            if item.get("Format") == "HDF":
                file, path = item.text.strip().split(":")
                self.assertEqual("fields.h5", file)
                self.assertEqual(8 * math.prod(map(int, item.get("Dimensions").split())), len(datasets[path]))
                self.assertEqual(("Float", "8"), (item.get("NumberType") or item.get("DataType"), item.get("Precision")))
                named.add(path)
        self.assertEqual(set(datasets), named)

    def test_block_size_changes_rounding_only(self):
        finals = []
        for block in ("32", "64", "256", "512"):
            self.expect(0, "sod", "--backend", gas_program.threaded(), "--overwrite",
                        sets=["output.times=[0.4]", f"tuning.stage.block={block}"])
            finals.append(gas_program.final_values(self.folder / "out/sod")[1])
        for values in finals[1:]:
            self.assertLess(max(abs(a - b) for a, b in zip(finals[0], values)), 1e-13)
