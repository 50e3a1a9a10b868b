"""Drops: [drop] and payload.velocity, against free fall in vacuum and the same flight in a stream."""

import csv
import math

import gas_program
import parachute_program

DROP = "drop={speed=8, angle=90}"
FALLING = ["grid.frame=\"follow\"", "canopy[0].payload={mass=20}", "coupling.gravity=[0,0,-9.81]", "run.end_time=0.1", "output.times=[0.1]",
           "output.history_every=1"]
NAMES = ("canopy_0_payload_x [m]", "canopy_0_payload_y [m]", "canopy_0_payload_z [m]")


class Drop(gas_program.GasTest):
    program = parachute_program.PROGRAM

    def flight(self, text, *words, sets=(), out="out"):
        process = self.start(self.write(text), "--backend", "serial", "--quiet", "--out", out, *words, sets=sets)
        self.assertEqual(0, process.returncode, process.stderr)
        with open(self.folder / out / "history.csv", encoding="utf-8") as file:
            rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        return rows, self.result(out)

    def test_falls_freely_in_vacuum(self):
        angle = math.radians(30)
        sets = ["drop={speed=5, angle=30}"]
        rows, _ = self.flight(parachute_program.CLOTH, sets=sets)
        first, last = rows[0], rows[-1]
        t = last["time [s]"]
        self.assertAlmostEqual(0.4, t)
        fall = (5 * math.cos(angle) * t, 0.0, -5 * math.sin(angle) * t - 0.5 * 9.81 * t**2)
        for name, distance in zip(NAMES, fall, strict=True):
            self.assertAlmostEqual(distance, last[name] - first[name], places=9)
        # In two runs.
        self.flight(parachute_program.CLOTH, sets=[*sets, "run.end_time=0.2"], out="parts")
        parts, _ = self.flight(parachute_program.CLOTH, "--restart", "auto", sets=sets, out="parts")
        for name in NAMES:
            self.assertAlmostEqual(last[name], parts[-1][name], places=9)

    def test_drop_in_still_air_is_the_flight_in_a_stream(self):
        # The velocities of the grid differ, and their round-off with them, which the cloth lets grow to 3e-5 of the force by 0.1 s.
        falling = [*FALLING[:3], "run.end_time=0.03", "output.times=[0.03]", FALLING[5]]
        still, dropped = self.flight(parachute_program.CANOPY, sets=[*falling, "fluid.velocity=[0,0,0]", DROP], out="still")
        _, in_stream = self.flight(parachute_program.CANOPY, sets=[*falling, "fluid.velocity=[0,0,8]"], out="stream")
        _, given = self.flight(parachute_program.CANOPY, sets=[*falling[:1], "canopy[0].payload={mass=20, velocity=[0,0,-8]}", *falling[2:],
                                                               "fluid.velocity=[0,0,0]"], out="given")
        self.assertEqual(-8.0, still[0]["canopy_0_payload_velocity_z [m/s]"])
        self.assertEqual(8.0, still[0]["canopy_0_airspeed [m/s]"])
        for row in still:
            self.assertAlmostEqual(-row["canopy_0_payload_velocity_z [m/s]"], row["canopy_0_rate_of_descent [m/s]"], places=12)
        for name in ("peak_line_force", "peak_line_force_time", "rate_of_descent", "drag_coefficient"):
            for other in (in_stream, given):
                self.assertAlmostEqual(1.0, dropped["canopy_0"][name] / other["canopy_0"][name], places=6, msg=name)

    def test_the_grid_follows_a_start_from_rest(self):
        """Air at rest bounds no step: 16 of the first ones would be a fall out of the domain, with the grid at rest."""
        rows, _ = self.flight(parachute_program.CANOPY, sets=[FALLING[0], "canopy[0].payload={mass=20, guided=true}", FALLING[2], "run.end_time=1.5",
                                                              "output.times=[1.5]", "output.history_every=1", "fluid.velocity=[0,0,0]", "run.max_dt=0.07", "run.cfl=0.5"])
        self.assertGreater(rows[0][NAMES[2]] - rows[-1][NAMES[2]], 4.0)
        for row in rows:
            fall = rows[0][NAMES[2]] - row[NAMES[2]]
            in_grid = row[NAMES[2]] - row["frame_position_z [m]"]
            self.assertAlmostEqual(rows[0][NAMES[2]], in_grid, delta=0.1 + fall / 10)

    def test_states_its_touch_down(self):
        rows, result = self.flight(parachute_program.CANOPY, sets=[*FALLING, "fluid.velocity=[0,0,0]", "drop={speed=8, height=0.5}"])
        path = [rows[0][NAMES[2]] - row[NAMES[2]] for row in rows]
        landed = next(k for k, distance in enumerate(path) if distance >= 0.5)
        time = result["canopy_0"]["touchdown_time"]
        self.assertTrue(rows[landed - 1]["time [s]"] <= time <= rows[landed]["time [s]"], time)
        self.assertAlmostEqual(-rows[landed]["canopy_0_payload_velocity_z [m/s]"], result["canopy_0"]["touchdown_speed"], delta=0.5)
