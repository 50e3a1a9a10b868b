#!/usr/bin/env python3
"""Measures the energy that steps of cloth and strings lose in violent motion, beside their time and their error.

    scripts/studies/measure_energy_loss.py [--program build/host/bin/drogue-springs] [--motion NAME]... [--safeties 0.2,0.4,0.8] [--repeats 3]

Motions, all without damping, whose energy (kinetic, elastic, of gravity and of pressure) is a constant of the motion:

    bag           two flat disks of 0.5 m, joined at the rim, blown up by a constant pressure of 200 Pa, 0.2 s
    swing         a square of 0.5 m that is held along one edge and let go from the horizontal, 1.5 s
    swing-slack   the same cloth, which bears no compression
    whip          a slack string of 1 m that is held at one end, folded in the middle and let go, 0.6 s
    drum          the shipped scene drum-cone, a vibration, 0.02 s

For each integrator and share of the largest stable step (time.safety): steps, evaluations of all forces, time to compute, the
energy lost at the end as the program states it (a share of the largest kinetic energy, or of all that is released), and the root
of the mean square distance of all vertices from a run of Verlet's method in steps of 0.05 of the largest stable step, over the
size of the mesh. The distance is taken early, at the fraction --early of the motion: later motion is chaotic, and no step follows
the reference. Needs numpy and h5py, as in build/venv.
"""

import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

import h5py
import numpy as np

REFERENCE = ("verlet", 0.05)
FORCES_OF_A_STEP = {"rk4": 4, "verlet": 1}
PRESSURE = 200.0  # Pa, in the bag
CLOTH = """[material]
membrane_modulus = 1000.0
area_density = 0.1
"""
SCENES = {
    "bag": (0.2, f'[mesh]\nfile = "bag.obj"\n{CLOTH}tension_only = true\n[[load]]\nfollower_pressure = {PRESSURE}\n'),
    "swing": (1.5, f"[mesh]\nrectangle = {{ width = 0.5, height = 0.5, vertices = 100 }}\n{CLOTH}"
              '[[pin]]\nwhere = "y < 1e-9"\n[[load]]\ngravity = [0.0, 0.0, -9.81]\n'),
    "whip": (0.6, "[mesh]\nstring = { from = [0.0, 0.0, 0.0], to = [0.0, 0.0, -1.0], vertices = 50 }\n"
             "[material]\nline_density = 0.01\naxial_stiffness = 20.0\ntension_only = true\n"
             '[initial]\ndisplacement = { x = "0.05*min(1, -2*z)", z = "max(0, -2*z-1)" }\n'
             '[[pin]]\nwhere = "z > -1e-9"\n[[load]]\ngravity = [0.0, 0.0, -9.81]\n'),
}
SCENES["swing-slack"] = (1.5, SCENES["swing"][1].replace(CLOTH, CLOTH + "tension_only = true\n"))


def write_bag(file, rings=5, radius=0.25):
    """Two disks of rings of triangles, 1 mm apart at the centre, with one rim."""
    def start(k):
        return 1 + 3 * k * (k - 1) if k > 0 else 0

    lines, count = [], start(rings + 1)
    heights = (0.0005, -0.0005)
    number = ([], [])
    for side in range(2):
        for k in range(rings + 1):
            for j in range(max(1, 6 * k)):
                if side == 1 and k == rings:
                    number[1].append(number[0][start(k) + j])
                    continue
                angle, r = 2 * math.pi * j / max(1, 6 * k), k / rings
                height = heights[side] * (1 - r * r)
                lines.append(f"v {radius * r * math.cos(angle):.17g} {radius * r * math.sin(angle):.17g} {height:.17g}")
                number[side].append(len(lines))
    assert len(number[0]) == count
    for side in range(2):
        def vertex(k, j):
            return number[side][start(k) + j % max(1, 6 * k)]

        faces = []
        for k in range(1, rings + 1):
            for sector in range(6):
                for j in range(k):
                    outer, inner = sector * k + j, sector * (k - 1) + j
                    faces.append((vertex(k, outer), vertex(k, outer + 1), vertex(k - 1, inner)))
                    if j < k - 1:
                        faces.append((vertex(k, outer + 1), vertex(k - 1, inner + 1), vertex(k - 1, inner)))
        lines += [f"f {a} {b} {c}" if side == 0 else f"f {a} {c} {b}" for a, b, c in faces]
    file.write_text("\n".join(lines) + "\n")


def run(arguments, folder, motion, integrator, safety, early):
    """Result, and positions at the start, early and at the end."""
    out = folder / f"{motion}-{integrator}-{safety}"
    if motion == "drum":
        end, scene = 0.02, "drum-cone"
        times = [f"time.end_time={end}", "verify={}"]
    else:
        end, text = SCENES[motion]
        scene = folder / f"{motion}.toml"
        scene.write_text(f'app = "springs"\n{text}[time]\nend_time = {end}\n[output]\nfields = ["position"]\ntimes = [0.0]\n')
        times = []
    sets = [f"time.integrator={integrator}", f"time.safety={safety}", "output.history_every=20",
            f"output.times=[0.0,{early * end},{end}]", 'output.fields=["position"]', *times]
    command = [arguments.program, scene, "--out", out, "--quiet", "--overwrite", "--backend", "serial"]
    subprocess.run(command + [word for each in sets for word in ("--set", each)], check=True)
    with h5py.File(out / "fields.h5") as fields:
        positions = [fields[f"steps/{step}/position"][:] for step in sorted(fields["steps"])]
    return json.loads((out / "result.json").read_text()), positions


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="build/host/bin/drogue-springs", type=pathlib.Path)
    parser.add_argument("--motion", action="append", choices=[*SCENES, "drum"])
    parser.add_argument("--safeties", default="0.2,0.4,0.8")
    parser.add_argument("--repeats", default=3, type=int)
    parser.add_argument("--early", default=0.1, type=float)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_bag(folder / "bag.obj")
        print("motion integrator safety steps forces compute_ms energy_lost error")
        for motion in arguments.motion or [*SCENES, "drum"]:
            reference = run(arguments, folder, motion, *REFERENCE, arguments.early)[1]
            size = np.ptp(reference[0], axis=0).max()
            for integrator in ("rk4", "verlet"):
                for safety in map(float, arguments.safeties.split(",")):
                    runs = [run(arguments, folder, motion, integrator, safety, arguments.early) for _ in range(arguments.repeats)]
                    result, positions = runs[0]
                    seconds = statistics.median(each[0]["timing"]["compute_s"] for each in runs)
                    error = math.sqrt(((positions[1] - reference[1]) ** 2).sum(axis=1).mean()) / size
                    forces = FORCES_OF_A_STEP[integrator] * result["steps"]
                    print(motion, integrator, f"{safety:g}", result["steps"], forces, f"{1e3 * seconds:.3g}",
                          f"{result['energy']['lost_share']:.2g}", f"{error:.2g}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
