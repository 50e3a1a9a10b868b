"""Checks of columns of history.csv, [[verify.history]], in all programs that run scenes."""

import gas_program
import parachute_program
import springs_program
from parachute_program import statistic

GAS = ["mesh.cells=100", "output={history_every=1}"]


class HistoryChecks(springs_program.SpringsTest):
    def check(self, program, code, scene, *checks, sets=(), words=("--overwrite", "--out", "out")):
        process = gas_program.run(scene, "--backend", "serial", "--quiet", *words, cwd=self.folder, program=program,
                                  sets=["verify={history=[" + ",".join(checks) + "]}", *sets])
        self.assertEqual(code, process.returncode, process.stderr)
        return process.stderr

    def rows(self, column):
        with (self.folder / "out/history.csv").open(encoding="utf-8") as file:
            names, *rows = (line.strip().split(",") for line in file)
        place = [name.split(" [")[0] for name in names].index(column)
        return [float(row[place]) for row in rows]

    def test_statistics_are_those_of_the_rows(self):
        wave = springs_program.DRUM
        for program, scene, column, sets in (
                (gas_program.PROGRAM, "sod", "max_speed", GAS),
                (springs_program.PROGRAM, self.write(wave, "drum.toml"), "kinetic", ["output.history_every=1"]),
                (parachute_program.PROGRAM, self.write(parachute_program.GUST, "gust.toml"), "kinetic_energy", ["output={history_every=1}"])):
            with self.subTest(program.name):
                names = ("max", "min", "last")
                self.check(program, 5, scene, *(statistic(column, name, 1e9, 1e-9) for name in names), sets=sets)
                values = self.rows(column)
                measured = [check["measured"] for check in self.result("out")["checks"]]
                self.assertEqual([max(values), min(values), values[-1]], measured)
                self.check(program, 0, scene, *(statistic(column, name, value, 1e-12) for name, value in zip(names, measured)), sets=sets)
                self.assertEqual([f"{column}_{name}" for name in names], [check["name"] for check in self.result("out")["checks"]])

    def test_rejects_what_cannot_be_measured(self):
        drum = self.write(springs_program.DRUM)
        for program, scene, column, wrong, end in (
                (gas_program.PROGRAM, "sod", "max_speed", "max_sped", "run.end_time = 0.4"),
                (springs_program.PROGRAM, drum, "kinetic", "kinetick", "time.end_time")):
            good = statistic(column, "mean", 1, 1)
            for checks, sets, words in (
                    ([good, statistic(wrong, "mean", 1, 1)], [], f'verify.history[1].column = "{wrong}" is no column'),
                    ([statistic(wrong, "mean", 1, 1)], [], f'did you mean "{column}"?'),
                    ([statistic(column, "mean", 1, 1, from_=0, to=1e3)], [], f"verify.history[0].to = 1000.0 s must lie between from and {end}"),
                    ([statistic(column, "mean", 1, 1, from_=1e3)], [], f"verify.history[0].from = 1000.0 s must be before {end}"),
                    ([good], ["output.history_every=0"], "verify.history[0] needs rows of the history; output.history_every is 0"),
                    ([statistic(column, "median", 1, 1)], [], "verify.history[0].statistic")):
                with self.subTest(words):
                    self.assertIn(words, self.check(program, 3, scene, *checks, sets=sets, words=("--check",)))

    def test_a_run_without_its_former_history_measures_no_mean_of_it(self):
        later = ["run.end_time=0.5", *GAS]
        mean, last = (statistic("energy", name, 1, 1e9) for name in ("mean", "last"))
        self.check(gas_program.PROGRAM, 0, "sod", mean, sets=GAS)
        (self.folder / "out/restart.h5").rename(self.folder / "state.h5")
        restart = ("--restart", "state.h5", "--out")
        self.check(gas_program.PROGRAM, 0, "sod", last, sets=later, words=(*restart, "last"))
        message = self.check(gas_program.PROGRAM, 5, "sod", mean, sets=later, words=(*restart, "mean"))
        self.assertIn("energy_mean could not be measured", message)
