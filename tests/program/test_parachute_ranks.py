# ctest-label: no-sanitizer
"""drogue-parachute on several ranks: the results of one rank, restarts on any number of ranks, an orderly end of all ranks."""

import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, os.environ["DROGUE_SOURCE"] + "/tests/support")

import gas_program
import parachute_program
import small_disk
from parachute_program import CANOPY, CORE, DRIFT, GROWING, GUST, PLATE, PROGRAM, VORTICES
from rank_processes import LAUNCHER, RANK_ENVIRONMENT, processes_of

QUIET = ("--quiet", "--backend", "serial")
TOLERANCE = 1e-10
LONG_GUST = GUST.replace("end_time = 0.5", "end_time = 1e4").split("[output]")[0]


@unittest.skipIf(LAUNCHER is None, "there is no mpirun")
class RanksTest(parachute_program.FlowTest):
    def begin(self, ranks, *words, sets=(), environment=()):
        options = [word for value in sets for word in ("--set", value)]
        line = [LAUNCHER, "--oversubscribe", "-n", ranks, PROGRAM, *words, *options]
        process = subprocess.Popen(list(map(str, line)), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   stdin=subprocess.DEVNULL, text=True, env=RANK_ENVIRONMENT | dict(environment))
        self.addCleanup(process.kill)
        return process

    def begin_each(self, *lines, program=(PROGRAM,)):
        """A rank for each command line."""
        words = [LAUNCHER, "--oversubscribe"]
        for line in lines:
            words += [*([":"] if len(words) > 2 else []), "-n", "1", *program, *map(str, line)]
        process = subprocess.Popen(list(map(str, words)), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   stdin=subprocess.DEVNULL, text=True, env=RANK_ENVIRONMENT)
        self.addCleanup(process.kill)
        return process

    def end(self, process):
        """Exit code, the lines of the program on stderr (mpirun adds others after a failure), and stdout."""
        output, errors = process.communicate(timeout=120)
        own = [line for line in errors.splitlines() if line.startswith("drogue-parachute:") or ".toml:" in line]
        return process.returncode, own, output

    def run_on(self, code, ranks, *words, **settings):
        ended = self.end(self.begin(ranks, *words, **settings))
        self.assertEqual((code, 1 if code else 0), (ended[0], len(ended[1])), ended)
        return ended[1][0] if code else ended[2]

    def assert_near(self, one, other, what, tolerance):
        self.assertEqual(len(one), len(other), what)
        bound = tolerance * max(1.0, *map(abs, one))
        self.assertLess(max(abs(a - b) for a, b in zip(one, other)), bound, what)

    def assert_same_runs(self, one, other, tolerance=TOLERANCE):
        """Fields and history agree within the tolerance."""
        files = self.fields(one), self.fields(other)
        self.assertEqual(set(files[0].datasets), set(files[1].datasets))
        for path in files[0].datasets:
            if path.startswith("/steps/"):
                self.assert_near(*(list(file.values(path)) for file in files), path, tolerance)
        rows = self.history(one), self.history(other)
        self.assertEqual(list(rows[0]), list(rows[1]))
        for name in rows[0]:
            self.assert_near(rows[0][name], rows[1][name], name, tolerance)

    def assert_same_files(self, one, other):
        """Fields and history have the same bits."""
        files = self.fields(one), self.fields(other)
        self.assertEqual([], [path for path in files[0].datasets if files[0].datasets[path] != files[1].datasets[path]])
        self.assertEqual(*((self.folder / name / "history.csv").read_text() for name in (one, other)))


class Results(RanksTest):
    def test_fields_and_history_are_those_of_one_rank(self):
        scene = self.write(GUST)
        for ranks in (1, 2, 4):
            self.run_on(0, ranks, scene, *QUIET, "--out", ranks)
            reported = self.result(str(ranks))
            self.assertEqual((ranks, "ok", 0.5), (reported["ranks"], reported["status"], reported["time"]))
        self.assertEqual("plain", self.result("4")["driver"])
        self.assertEqual([None, {"transport": "mpi"}], [self.result(ranks).get("messages") for ranks in ("1", "4")])
        for ranks in (2, 4):
            self.assert_same_runs("1", str(ranks))

    def test_messages_through_a_staging_buffer_are_the_same(self):
        scene = self.write(GUST)
        for transport in ("mpi", "host-staging"):
            self.run_on(0, 2, scene, *QUIET, "--out", transport, environment={"DROGUE_TRANSPORT": transport})
            self.assertEqual({"transport": transport}, self.result(transport)["messages"])
        self.assert_same_files("mpi", "host-staging")

    def test_stretched_grids_are_divided_too(self):
        for ranks in (1, 4):
            self.run_on(0, ranks, self.write(GROWING), *QUIET, "--out", ranks)
        self.assert_same_runs("1", "4")

    def test_verifies_against_the_exact_solution(self):
        output = self.run_on(0, 4, self.write(VORTICES), "--backend", "serial", "--out", "out")
        self.assertEqual(1, output.count("l2_velocity"), output)
        one = self.run_on(0, 1, self.write(VORTICES), "--backend", "serial", "--out", "one")
        self.assertIn("passed", one)
        errors = [self.result(name)["errors"] for name in ("one", "out")]
        for name, value in errors[0].items():
            self.assertAlmostEqual(value, errors[1][name], delta=TOLERANCE, msg=name)

    def test_implicit_diffusion_is_that_of_one_rank(self):
        sets = ["flow.diffusion=crank-nicolson", "flow.time=ab2", "fluid.viscosity=0.1"]
        for ranks in (1, 4):
            self.run_on(0, ranks, self.write(GUST), *QUIET, "--out", ranks, sets=sets)
        self.assert_same_runs("1", "4")

    def test_ranks_may_differ_after_a_restart(self):
        """The state after steps on two ranks, continued on two, four and one; on two bit for bit."""
        scene = self.write(GUST)
        self.run_on(0, 2, scene, *QUIET, "--out", "whole", sets=["output.restart_every=4"])
        self.run_on(4, 2, scene, *QUIET, "--out", "part", sets=["output.restart_every=4", "run.max_steps=6"])
        for ranks in (2, 4, 1):
            name = f"on{ranks}"
            shutil.copytree(self.folder / "part", self.folder / name)
            self.run_on(0, ranks, scene, *QUIET, "--out", name, "--restart", "auto", sets=["output.restart_every=4"])
            self.assert_same_runs("whole", name)
        self.assert_same_files("whole", "on2")


class Sheets(RanksTest):
    """50 steps, in which the canopy does not buckle: then round-off would grow."""

    SETS = ("run.dt=0.0002", "run.end_time=0.01", "output.times=[0.004, 0.01]", "output.history_every=5")
    # A porous plate, one that turns the flow aside, and a cylinder that moves.
    BODIES = PLATE.replace("[run]", '[[body]]\nkind = "cylinder"\naxis = "z"\ncentre = [0.9, 0.25, 0.3]\nradius = 0.08\n'
                           'length = 0.6\nedge_length = 0.05\nmotion = { y = "0.02*sin(40*t)" }\n[run]')

    def compare(self, text, tolerance, sets=SETS, several=(2, 4)):
        scene = self.write(text)
        for ranks in (1, *several):
            self.run_on(0, ranks, scene, *QUIET, "--out", ranks, sets=sets)
            self.assertEqual(ranks, self.result(str(ranks))["ranks"])
        for ranks in several:
            self.assert_same_runs("1", str(ranks), tolerance)

    def test_bodies_feel_the_forces_of_one_rank(self):
        self.compare(self.BODIES, 1e-9)
        rows = self.history("4")
        self.assertEqual(50, rows["step"][-1])
        for name in ("body_0_force_x", "body_1_force_y", "body_2_force_y"):
            self.assertGreater(abs(rows[name][-1]), 1e-4, name)

    def test_canopies_open_as_on_one_rank(self):
        self.compare(CANOPY, 1e-8)
        rows = self.history("4")
        self.assertEqual(50, rows["step"][-1])
        self.assertGreater(max(map(abs, rows["canopy_0_force_z"])), 1)
        self.assertGreater(max(rows["cloth_elastic_energy"]), 0)
        self.assertLess(max(rows["force_balance"]), 1e-14)

    def test_canopies_open_in_a_core_as_on_one_rank(self):
        self.compare(CORE, 1e-8, several=(4,))
        self.assertGreater(max(map(abs, self.history("4")["canopy_0_force_z"])), 1)
        self.assertLess(max(self.history("4")["force_balance"]), 1e-14)

    def test_grid_follows_a_payload_as_on_one_rank(self):
        free = CANOPY.replace("fixed = true", "fixed = false").replace("cells", 'frame = "follow"\ncells')
        self.compare(free, 1e-8, (*self.SETS, "coupling.gravity=[0, 0, -9.81]"), several=(4,))
        self.assertGreater(abs(self.history("4")["frame_velocity_z"][-1]), 1e-3)

    def test_reefing_lines_are_cut_in_contact_as_on_one_rank(self):
        reefed = CANOPY.replace("vent = 0.3", 'vent = 0.3\nshape = "partly-closed"\nclosure = 0.4\n'
                                "reefing = { length = 2.5, stiffness = 2000, cut = 0.005 }")
        # Thicker than the distance of neighbouring pleats at the vent.
        contact = ("coupling.contact=true", "coupling.thickness=0.04", "verify.intersections=0")
        self.compare(reefed, 1e-8, (*self.SETS, *contact), several=(2,))
        self.assertIn(0.005, self.history("2")["time"])
        without = [*self.SETS, "coupling.contact=true", "coupling.thickness=0.001"]
        self.run_on(0, 2, self.write(reefed), *QUIET, "--out", "thin", sets=without)
        self.assertNotEqual(self.history("thin")["cloth_kinetic_energy"], self.history("2")["cloth_kinetic_energy"])

    def test_ranks_may_differ_after_a_restart(self):
        for name, text in (("bodies", PLATE), ("canopy", CANOPY + "[coupling]\nleak_filter = 0.5\nedge_inset = 0.55\n")):
            with self.subTest(name):
                scene = self.write(text)
                sets = [*self.SETS, "output.restart_every=10"]
                self.run_on(0, 2, scene, *QUIET, "--overwrite", "--out", "whole", sets=sets)
                self.run_on(4, 2, scene, *QUIET, "--overwrite", "--out", "part", sets=[*sets, "run.max_steps=25"])
                for ranks in (2, 4, 1):
                    out = f"{name}-on{ranks}"
                    shutil.copytree(self.folder / "part", self.folder / out)
                    self.run_on(0, ranks, scene, *QUIET, "--out", out, "--restart", "auto", sets=sets)
                    self.assert_same_runs("whole", out, 1e-8)
                self.assert_same_files("whole", f"{name}-on2")


class Failures(RanksTest):
    def test_prints_errors_of_all_ranks_once(self):
        self.assertEqual(1, self.run_on(0, 2, "--help").count("--study LISTS"))
        self.assertIn("cavitty", self.run_on(2, 2, "cavitty"))
        self.assertIn(".toml:2", self.run_on(3, 2, self.write('app = "parachute"\nwrong = 1\n'), *QUIET))
        self.assertIn("one rank", self.run_on(2, 2, self.write(VORTICES), *QUIET, "--study", "meshes=8:16"))

    def test_reports_what_one_rank_alone_cannot_read(self):
        """Each rank reads the scene, as on hosts with disks of their own."""
        scene, broken = self.write(VORTICES), self.folder / "broken.toml"
        broken.write_text('app = "parachute"\nwrong = 1\n')
        other = self.folder / "other.toml"
        other.write_text(scene.read_text().replace("end_time = ", "end_time = 1"))
        for code, file, words in ((2, "absent.toml", "absent.toml"), (3, broken, ".toml:2"), (6, other, "is not the one of rank 0")):
            with self.subTest(words):
                options = (*QUIET, "--out", "out")
                ended = self.end(self.begin_each((scene, *options), (file, *options)))
                self.assertEqual((code, 1), (ended[0], len(ended[1])), ended)
                self.assertIn(words, ended[1][0])
                self.assertIn("(on rank 1)", ended[1][0])
                self.assertFalse((self.folder / "out" / "history.csv").exists())

    def test_ends_all_ranks_if_one_lacks_memory(self):
        """Rank 1 fails while the others communicate with it; rank 0, if it fails, describes the end of the run."""
        large = VORTICES.split("[verify]")[0].replace("cells = [16, 16, 1]", "cells = [192, 192, 96]").replace(
            'y = "periodic" }', 'y = "periodic", z = "periodic" }').replace('"sin(x)*cos(y)", "-cos(x)*sin(y)"', "1, 0")
        scene = self.write(large)
        limit = ("sh", "-c", 'ulimit -v 380000; exec "$0" "$@"')
        words = (PROGRAM, scene, *QUIET, "--out", "out", "--overwrite")
        for rank, lines in enumerate((((*limit, *words), words), (words, (*limit, *words)))):
            with self.subTest(rank):
                process = self.begin_each(*lines, program=())
                errors = process.communicate(timeout=120)[1]
                self.assertEqual(6, process.returncode, errors)
                self.assertIn("out of memory", errors)
                if rank == 0:
                    self.assertIn("out of memory", self.result("out")["message"])

    def test_reports_the_rank_without_a_device(self):
        words = (PROGRAM, self.write(VORTICES), "--quiet", "--out", "out", "--backend")
        without = ("env", "CUDA_VISIBLE_DEVICES=", *words, "cuda")
        for rank, lines in enumerate(((without, (*words, "serial")), ((*words, "serial"), without))):
            with self.subTest(rank):
                ended = self.end(self.begin_each(*lines, program=()))
                self.assertEqual((77, 1), (ended[0], len(ended[1])), ended)
                self.assertIn("the backend 'cuda'", ended[1][0])
                self.assertEqual(rank == 1, ended[1][0].endswith("(on rank 1)"))

    def test_ends_all_ranks_if_one_alone_cannot_write(self):
        """The system refuses rank 1 the second output, which rank 0 has made room for. Its limit leaves room for the memory that
        ranks of a host share."""
        limited = ("sh", "-c", 'trap "" XFSZ; ulimit -f 9000; exec "$0" "$@"')
        words = (PROGRAM, self.write(GUST), *QUIET, "--out", "out")
        for value in ("grid.cells=[64, 48, 48]", "output.times=[0.01, 0.02]", "run.end_time=0.02", 'output.fields=["velocity"]'):
            words += ("--set", value)
        ended = self.end(self.begin_each(words, (*limited, *words), program=()))
        self.assertEqual((6, 1), (ended[0], len(ended[1])), ended)
        self.assertRegex(ended[1][0], "fields.h5.*: No space left on device")
        self.assertEqual("io-error", self.result("out")["status"])

    def test_refuses_a_run_directory_on_all_ranks(self):
        scene = self.write(VORTICES)
        (self.folder / "file").write_text("")
        self.assertIn("cannot create the run directory", self.run_on(6, 2, scene, *QUIET, "--out", "file/out"))
        self.run_on(0, 2, scene, *QUIET, "--out", "out")
        before = (self.folder / "out" / "result.json").read_text()
        self.assertIn("already holds a run", self.run_on(2, 2, scene, *QUIET, "--out", "out"))
        self.assertIn("does not exist", self.run_on(2, 2, scene, *QUIET, "--out", "new", "--restart", "absent.h5"))
        self.assertEqual(before, (self.folder / "out" / "result.json").read_text())

    def test_reports_a_damaged_restart_file_once(self):
        scene = self.write(VORTICES)
        self.run_on(0, 2, scene, *QUIET, "--out", "out", sets=["output.restart_every=1"])
        with open(self.folder / "out" / "restart.h5", "r+b") as file:
            file.seek(-1, os.SEEK_END)
            byte = file.read(1)
            file.seek(-1, os.SEEK_END)
            file.write(bytes([byte[0] ^ 1]))
        self.assertIn("it is damaged", self.run_on(6, 2, scene, *QUIET, "--out", "out", "--restart", "auto"))

    def test_reports_a_failed_check_once(self):
        sentence = self.run_on(5, 2, self.write(VORTICES), *QUIET, "--out", "out", sets=["verify.l2_velocity=1e-30"])
        self.assertIn("l2_velocity", sentence)
        self.assertEqual("verification-failed", self.result("out")["status"])

    def test_refuses_more_ranks_than_the_grid_has_room_for(self):
        sentence = self.run_on(2, 4, self.write(VORTICES), *QUIET, "--out", "out", sets=["grid.cells=[16, 8, 1]"])
        self.assertIn("4 ranks cannot share 8 x 1 cells", sentence)

    def test_refuses_a_transport_that_the_ranks_lack(self):
        sentence = self.run_on(2, 2, self.write(VORTICES), *QUIET, "--out", "out", environment={"DROGUE_TRANSPORT": "nccl"})
        self.assertIn("DROGUE_TRANSPORT: these ranks can exchange messages by host-staging, mpi", sentence)

    def test_reports_a_canopy_that_leaves_the_domain_once(self):
        free = CANOPY.replace("fixed = true", "fixed = false").replace("-2.6, 3.4", "-2.6, 1.4").replace("20, 30", "20, 20")
        sentence = self.run_on(4, 4, self.write(free), *QUIET, "--out", "out", sets=["run.end_time=5", "output.times=[5]"])
        self.assertRegex(sentence, r"canopy\[0\] leaves the domain: its (cloth|payload) at .* side z_high after step \d+, t = ")
        self.assertEqual("numerical-failure", self.result("out")["status"])
        self.assertEqual(sentence, self.run_on(4, 4, self.write(free), *QUIET, "--out", "out", "--restart", "auto",
                                               sets=["run.end_time=5", "output.times=[5]"]))

    def test_reports_a_sheet_that_meets_an_image_once(self):
        scene = self.write(DRIFT)
        sentences = [self.run_on(4, ranks, scene, *QUIET, "--out", f"on{ranks}") for ranks in (1, 2)]
        words = [sentence.split(" m after ") for sentence in sentences]
        self.assertIn("canopy[0] meets the image of body[0] beyond the periodic sides at ", words[0][0])
        self.assertEqual(words[0][1], words[1][1])

    def test_reports_a_full_disk_once(self):
        """The disk fills in the first output, in a restart file and in a later output."""
        scene = self.write(GUST)
        sets = ["grid.cells=[32, 24, 16]", "output.times=[0.1, 0.5]", "output.restart_every=12", 'output.fields=["velocity"]']
        full_files = []
        for size in ("64k", "800k", "1200k"):
            with self.subTest(size), small_disk.mounted(self.folder / "disk", f"size={size}") as disk:
                sentence = self.run_on(6, 2, scene, *QUIET, "--out", disk / "run", sets=sets)
                self.assertIn("No space left", sentence)
                self.assertEqual("io-error", self.result("disk/run")["status"])
                self.assertEqual([], [path.name for path in (disk / "run").iterdir() if path.name.startswith(".")])
                for name in ("fields.h5", "restart.h5"):
                    if (disk / "run" / name).exists():
                        gas_program.fields(disk / "run", name)  # raises if it cannot be read
                full_files.append("restart.h5" if "restart.h5" in sentence else "fields.h5")
        self.assertEqual(["fields.h5", "restart.h5", "fields.h5"], full_files)

    def test_reports_a_numerical_failure_once(self):
        sentence = self.run_on(4, 4, self.write(LONG_GUST), *QUIET, "--out", "out", sets=["run.dt=10"])
        self.assertRegex(sentence, r"run.dt = 10 s exceeds the largest stable time step, 0\.\d+ s, at step 1")
        self.assertEqual("numerical-failure", self.result("out")["status"])

    def test_interrupts_all_ranks_if_one_is_terminated(self):
        for victim in (0, 1):
            with self.subTest(victim):
                self.interrupt(victim)

    def test_a_killed_rank_ends_all_and_leaves_a_restart_file(self):
        for victim in (0, 1):
            with self.subTest(victim):
                process, scene = self.begin_long_run(f"killed{victim}")
                ranks = processes_of(process)
                os.kill(ranks[victim], signal.SIGKILL)
                self.assertNotEqual(0, self.end(process)[0])
                self.assert_ends(ranks[1 - victim])
                step = 1 + gas_program.fields(self.folder / f"killed{victim}", "restart.h5").attributes["/"]["step"]
                self.run_on(4, 1, scene, *QUIET, "--out", f"killed{victim}", "--restart", "auto",
                            sets=["output.restart_every=5", f"run.max_steps={step}"])

    def assert_ends(self, process):
        """A process ends within seconds; without a parent that waits for it, it stays as a zombie."""
        stat = pathlib.Path(f"/proc/{process}/stat")
        for _ in range(100):
            try:
                if stat.read_text().rsplit(")", 1)[1].split()[0] == "Z":
                    return
            except (OSError, ValueError, IndexError):
                return
            time.sleep(0.05)
        self.fail(f"process {process} goes on")

    def test_ranks_that_wait_leave_their_core_to_others(self):
        """Open MPI lists its parameters that the environment sets."""
        for given, expected in (({}, "true"), ({"OMPI_MCA_mpi_yield_when_idle": "0"}, "false")):
            environment = {**RANK_ENVIRONMENT, "OMPI_MCA_mpi_show_mca_params": "enviro"}
            environment.pop("OMPI_MCA_mpi_yield_when_idle", None)
            line = [LAUNCHER, "--oversubscribe", "-n", "2", PROGRAM, self.write(VORTICES), *QUIET, "--overwrite", "--out", "out"]
            run = subprocess.run(list(map(str, line)), cwd=self.folder, capture_output=True, text=True, check=True, timeout=120,
                                 stdin=subprocess.DEVNULL, env={**environment, **given})
            if "mpi_show_mca_params" not in run.stderr:
                self.skipTest("this MPI does not list its parameters")
            self.assertIn(f"mpi_yield_when_idle={expected} (environment)", run.stderr)

    def test_mpirun_passes_the_notice_of_a_batch_system_on(self):
        """Slurm's --signal=USR1@60 reaches mpirun, which forwards it to all ranks."""
        self.interrupt(None)

    def begin_long_run(self, out):
        """A run on two ranks that has written a restart file, and its scene."""
        scene = self.write(LONG_GUST)
        process = self.begin(2, scene, *QUIET, "--out", out, sets=["output.restart_every=5"])
        for _ in range(400):
            time.sleep(0.05)
            if (self.folder / out / "restart.h5").exists():
                break
        return process, scene

    def interrupt(self, victim):
        out = f"out{victim}"
        process, _ = self.begin_long_run(out)
        if victim is None:
            process.send_signal(signal.SIGUSR1)
        else:
            os.kill(processes_of(process)[victim], signal.SIGTERM)
        message = "drogue-parachute: interrupted by a signal; restart.h5 is written, continue with --restart auto"
        self.assertEqual((130, [message]), self.end(process)[:2])
        self.assertEqual("interrupted", self.result(out)["status"])


if __name__ == "__main__":
    unittest.main()
