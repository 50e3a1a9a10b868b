#!/usr/bin/env python3
"""Measures speeds and drag coefficients of canopies in finished runs of drogue-parachute, corrected for blockage.

    scripts/studies/measure_descent.py FOLDER... [--from 5] [--to T] [--period 2.7] [--blockage 1.85] [--limit]

Reads scene.toml and history.csv of each run, whose scene has one canopy, with a payload that is free or held. Down is the
direction of gravity, or against the stream where there is none; it must be along an axis of the grid. U is the velocity of the
payload relative to the fluid far away. With the mean force F of the air on the cloth against "down" and the nominal area S0:

    C_D0 down    2 F / (rho v^2 S0), v the mean speed down: what rates of descent and wind tunnels give
    C by speed   2 F / (rho U^2 S0), U the mean of the speed abs(U)
    lean         angle of the force of the lines on the payload from "up", degrees, by the means of its parts
                 across and "up": slack lines do not count; 0 without lines

In a section of area A normal to "down", a bluff body has the drag of a stream of 1 + K 2 F / (rho U^2 A) times the dynamic
pressure (Maskell 1963). K = --blockage; 1.85 is the value of single parachutes (Macha and Buffington 1990). "in free air"
divides both coefficients by that ratio, and multiplies speeds by its root; F and the glide ratio, mean speed across over
mean speed down, are those of the run.

Means cover whole periods of breathing, --period, from --from s on; errors are those of the jackknife over them (standard
errors), and leave out motions that last longer. --limit fits lines in the size of the cells to the coefficients in free air,
weighted by these errors, and prints their values for cells of no size: the error of the delta function is of first order.
"""

import argparse
import math
import pathlib
import sys
import tomllib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from recording import read_history  # noqa: E402

AXES = "xyz"


def stop(sentence):
    sys.exit(f"measure_descent.py: {sentence}")


def nominal_area(canopy):
    """Area of the flat cloth with its vent and of a skirt, m^2."""
    area = 0.25 * math.pi * canopy["diameter"] ** 2
    if "skirt" in canopy:
        area += 0.5 * math.pi * (canopy["diameter"] + canopy["skirt"]["diameter"]) * canopy["skirt"]["length"]
    return area


class Setting:
    """Fluid, box and canopy of a scene; stops if it is not that of one canopy whose fall is along an axis."""

    def __init__(self, scene, folder):
        if len(scene.get("canopy", [])) != 1 or "fluid" not in scene:
            stop(f"{folder} is no run of one canopy in a fluid.")
        self.stream, self.density = scene["fluid"]["velocity"], scene["fluid"]["density"]
        if any(isinstance(part, str) for part in self.stream):
            stop(f"the stream of {folder} is no constant.")
        gravity = scene.get("coupling", {}).get("gravity", [0.0, 0.0, 0.0])
        down = gravity if any(gravity) else [-part for part in self.stream]
        along = [axis for axis in range(3) if down[axis] != 0.0]
        if len(along) != 1:
            stop(f"{folder} has no gravity or stream along an axis.")
        self.axis = along[0]
        self.sign = math.copysign(1.0, down[self.axis])
        sizes = [high - low for low, high in scene["grid"]["domain"]]
        self.cell = max(size / cells for size, cells in zip(sizes, scene["grid"]["cells"]))
        self.section = math.prod(size for axis, size in enumerate(sizes) if axis != self.axis)
        self.area = nominal_area(scene["canopy"][0])

    def sample(self, row):
        """Speed down, speed across and speed of the payload relative to the fluid, m/s; force against "down", and force of the
        lines across and "up", N."""
        velocity = [row[f"canopy_0_payload_velocity_{name}"] - self.stream[axis] for axis, name in enumerate(AXES)]
        lines = [row[f"canopy_0_line_force_{name}"] for name in AXES]
        return (self.sign * velocity[self.axis], self.across(velocity), math.hypot(*velocity),
                -self.sign * row[f"canopy_0_force_{AXES[self.axis]}"], self.across(lines), -self.sign * lines[self.axis])

    def across(self, vector):
        """Magnitude of the part of a vector normal to "down"."""
        return math.hypot(*(part for axis, part in enumerate(vector) if axis != self.axis))


def block_means(rows, sample, start, end, period):
    """Means of the samples over whole periods from `start` on, by the trapezoidal rule."""
    # Round-off of the times must not take the last period away.
    count = math.floor((end - start) / period + 1e-9)
    integrals = [[0.0] * 6 for _ in range(count)]
    lengths = [0.0] * count
    for before, after in zip(rows, rows[1:]):
        block = math.floor((0.5 * (before["time"] + after["time"]) - start) / period)
        if not 0 <= block < count:
            continue
        dt = after["time"] - before["time"]
        lengths[block] += dt
        for k, (low, high) in enumerate(zip(sample(before), sample(after))):
            integrals[block][k] += 0.5 * dt * (low + high)
    if count < 2 or min(lengths) == 0.0:
        return []
    return [[integral / length for integral in block] for block, length in zip(integrals, lengths)]


def measures(means, setting, blockage):
    """Speeds, glide ratio, coefficients and lean by mean speeds, m/s, and mean forces, N."""
    down, across, speed, force, lines_across, lines_up = means
    unit = 2.0 * force / (setting.density * setting.area)
    ratio = 1.0 + blockage * unit * setting.area / (speed**2 * setting.section)
    return {"down": down, "across": across, "glide": across / down,
            "lean": math.degrees(math.atan2(lines_across, lines_up)) if lines_across or lines_up else 0.0,
            "drag": unit / down**2, "drag_by_speed": unit / speed**2, "ratio": ratio, "free_down": down * math.sqrt(ratio),
            "free_drag": unit / down**2 / ratio, "free_drag_by_speed": unit / speed**2 / ratio}


def with_errors(blocks, measure):
    """Each measure of the mean of the blocks with its standard error by the jackknife."""
    count = len(blocks)
    sums = [sum(column) for column in zip(*blocks)]
    whole = measure([total / count for total in sums])
    left_out = [measure([(total - part) / (count - 1) for total, part in zip(sums, block)]) for block in blocks]
    errors = {}
    for name in whole:
        mean = sum(one[name] for one in left_out) / count
        errors[name] = math.sqrt((count - 1) / count * sum((one[name] - mean) ** 2 for one in left_out))
    return {name: (value, errors[name]) for name, value in whole.items()}


def limit(cells, values):
    """Value and standard error at cell size zero of the line through (value, error) pairs, weighted by the errors."""
    weights = [1.0 / error**2 for _, error in values]
    s, sx, sxx = (sum(w * h**power for w, h in zip(weights, cells)) for power in range(3))
    sy = sum(w * value for w, (value, _) in zip(weights, values))
    sxy = sum(w * h * value for w, h, (value, _) in zip(weights, cells, values))
    determinant = s * sxx - sx**2
    return (sxx * sy - sx * sxy) / determinant, math.sqrt(sxx / determinant)


def measure_run(folder, options):
    """Setting, number of blocks, and measures with errors of the run in a folder."""
    if not (folder / "history.csv").is_file() or not (folder / "scene.toml").is_file():
        stop(f"{folder} holds no history.csv with its scene.toml.")
    setting = Setting(tomllib.loads((folder / "scene.toml").read_text(encoding="utf-8")), folder)
    rows = read_history(folder)
    end = min(options.end, rows[-1]["time"]) if rows else 0.0
    blocks = block_means(rows, setting.sample, options.start, end, options.period)
    if not blocks:
        stop(f"{folder} has rows for less than two periods of {options.period:g} s from {options.start:g} s on.")
    return setting, len(blocks), with_errors(blocks, lambda means: measures(means, setting, options.blockage))


COLUMNS = (("m/s down", "down", 2), ("m/s across", "across", 2), ("glide ratio", "glide", 2), ("lean, degrees", "lean", 1),
           ("C_D0 down", "drag", 3), ("C by speed", "drag_by_speed", 3), ("dynamic pressure", "ratio", 3),
           ("in free air: m/s down", "free_down", 2), ("C_D0 down", "free_drag", 3), ("C by speed", "free_drag_by_speed", 3))


def main(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--from", dest="start", type=float, default=5.0, help="s")
    parser.add_argument("--to", dest="end", type=float, default=math.inf, help="s")
    parser.add_argument("--period", type=float, default=2.7, help="of breathing, s")
    parser.add_argument("--blockage", type=float, default=1.85, help="factor K")
    parser.add_argument("--limit", action="store_true")
    options = parser.parse_args(words)
    if not options.period > 0.0:
        stop("--period must be positive.")
    runs = [measure_run(folder, options) for folder in options.folders]
    print("| run | cells, m | section, m^2 | periods |", *(f"{title} |" for title, _, _ in COLUMNS))
    print("|---|---|---|---|" + "---|" * len(COLUMNS))
    for folder, (setting, count, found) in zip(options.folders, runs):
        numbers = (f"{found[name][0]:.{digits}f} ± {found[name][1]:.{digits}f} |" for _, name, digits in COLUMNS)
        print(f"| {folder.name} | {setting.cell:.3g} | {setting.section:.0f} | {count} |", *numbers)
    if options.limit:
        cells = [setting.cell for setting, _, _ in runs]
        if len(set(cells)) < 2 or any(found["free_drag"][1] == 0.0 for _, _, found in runs):
            stop("--limit needs runs with cells of two sizes, and errors.")
        for title, name in (("C_D0 down", "free_drag"), ("C by speed", "free_drag_by_speed")):
            value, error = limit(cells, [found[name] for _, _, found in runs])
            print(f"{title} in free air for cells of no size: {value:.3f} ± {error:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
