#!/usr/bin/env python3
"""Draws figures 5.2 to 5.5, 5.7, 5.8 and 5.14 of [Shi] from runs of this build, as docs/images/shi-*.png.

    scripts/studies/draw_dissertation.py --bin build/host/bin [--figures 5.5,5.14] [--backend serial] [--work FOLDER]
                                         [--to FOLDER]

Prints the numbers that the engineering notebooks quote. Needs numpy, matplotlib and h5py.
"""

import argparse
import pathlib
import sys

import h5py
import numpy as np
from matplotlib.collections import PolyCollection
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from plot import style  # noqa: E402
from record_springs import CHORD, DRUM, GRIPS, THICKNESS, mean_difference, response, study  # noqa: E402
from recording import assignments, run  # noqa: E402

STRAINS = (0.002, 0.004, 0.006, 0.008, 0.01)
# Numbers of triangles in [Shi] and the vertices that give the nearest strip.
STRIPS = ((1143, 606), (1590, 850), (2468, 1300), (4520, 2330))
MODULUS, POISSON = 0.5e9, 0.14  # Pa
SPEED_TIMES = (0.001, 0.003, 0.005, 0.007)


class Runs:
    """Runs of scenes in folders of `work`."""

    def __init__(self, options):
        self.bin, self.backend, self.work = options.bin, options.backend, options.work

    def scene(self, program, scene, folder, *sets):
        """Folder and result of a run; exits if it failed."""
        result = run(self.bin / program, scene, self.backend, self.work / folder, *assignments(*sets))
        if result["exit_code"] != 0:
            sys.exit(f"{scene}: {result['message']}")
        return self.work / folder, result

    def series(self, scene, folder, lists, *sets):
        """Rows of a study of springs."""
        rows = study(self.bin / "drogue-springs", scene, self.backend, self.work / folder, lists, *sets)
        return rows or sys.exit(f"{scene}: the study failed")


def times_of(end):
    return f"output.times={[round(0.005 * k, 6) for k in range(round(end / 0.005) + 1)]}"


def new_figure(rows, columns, size, title, subtitle):
    """Figure with a heading and an array of axes below it."""
    figure, axes = style.plt.subplots(rows, columns, figsize=size, squeeze=False)
    style.heading(figure, title, subtitle)
    figure.subplots_adjust(left=0.09, right=0.98, top=1 - 0.75 / size[1], bottom=0.45 / size[1], hspace=0.4, wspace=0.28)
    return figure, axes


def draw_convergence(axes, runs, names, measure, unit):
    """Draws a measure and the kinetic energy over time, and their differences from the next mesh."""
    for axis, (name, label) in zip(axes, ((measure, f"{measure} ({unit})"), ("kinetic", "kinetic energy (J)")), strict=True):
        for row, words, colour in zip(runs, names, style.PALETTE, strict=False):
            axis[0].plot(row["series"]["time"], row["series"][name], color=colour, label=words, linewidth=0.8)
        for first, second, words, colour in zip(runs, runs[1:], names, style.PALETTE, strict=False):
            apart = np.abs(np.subtract(first["series"][name], second["series"][name]))
            axis[1].plot(first["series"]["time"], apart, color=colour, label=f"{words} and next", linewidth=0.8)
        axis[0].set_ylabel(label)
        axis[1].set_ylabel("difference from next mesh")
        for a in axis:
            a.set_xlabel("time (s)")
            a.legend(fontsize=7, edgecolor="none")


def chord(runs, to):
    """Figure 5.2: length and kinetic energy of the swinging chord over 2 s, and Cauchy errors."""
    found = [
        runs.series("swing-chord", f"chord-{points}", "masses=equal", "time.end_time=2", times_of(2), "verify={}",
                    "output.history_every=100000", f"mesh.string.vertices={points}", f"material.stiffness={stiffness}")[0]
        for points, stiffness, _ in CHORD[:3]
    ]
    figure, axes = new_figure(2, 2, (7.2, 4.8), "Chord that swings with 1 kg", "figure 5.2 of [Shi]: its stiffnesses, equal masses, 2 s")
    draw_convergence(axes, found, [f"{points} points" for points, *_ in CHORD], "length", "m")
    for first, second in zip(found, found[1:]):
        print("5.2", [f"{mean_difference(first['series']['time'], first['series'][n], second['series'][n]):.3g}" for n in ("length", "kinetic", "elastic")])
    figure.savefig(to / "shi-5-2.png", dpi=110)


def drum(runs, to):
    """Figures 5.3 and 5.4: sections of the drum at 1 and 2 s, and its area over time."""
    figure, axes = new_figure(3, 2, (7.2, 7.0), "Drum that starts as a cone", "figures 5.3 and 5.4 of [Shi]: sections y = 0, area and energy over 2 s; biquadratic membrane, equal masses")
    found = []
    for (points, _), colour in zip(DRUM[:3], style.PALETTE, strict=False):
        sets = (f"mesh.disk.vertices={points}", 'material.mass="equal"', "time.end_time=2", "verify={}", "output.history_every=100")
        folder, _ = runs.scene("drogue-springs", "drum-cone", f"drum-{points}", *sets, "output.times=[1.0,2.0]")
        with h5py.File(folder / "fields.h5") as h5:
            rest, steps = h5["mesh/vertices"][...], h5["steps"]
            on = np.flatnonzero(np.abs(rest[:, 1]) < 1e-9)
            on = on[np.argsort(rest[on, 0])]
            for axis, step, time in zip(axes[0], sorted(steps)[-2:], (1, 2), strict=True):
                x = steps[step]["position"][...][on]
                axis.plot(x[:, 0], x[:, 2], color=colour, label=f"{len(rest)} points")
                axis.set(xlabel="x (m)", ylabel="z (m)", title=f"t = {time} s")
                axis.legend(fontsize=7, frameon=False)
        found += runs.series("drum-cone", f"drum-series-{points}", "masses=equal", "time.end_time=2", times_of(2), "verify={}",
                             "output.history_every=100000", f"mesh.disk.vertices={points}")
    draw_convergence(axes[1:], found, [f"{row['vertices']} points" for row in found], "area", "m$^2$")
    figure.savefig(to / "shi-5-3.png", dpi=80)


def strip(runs, to):
    """Figure 5.5: apparent modulus and Poisson's ratio of the clamped strip against its strain on four meshes."""
    figure, axes = new_figure(1, 2, (7.2, 3.2), "Strip of 0.5 GPa and Poisson's ratio 0.14", "figure 5.5 of [Shi]: clamped grips, without the node of a corner and the largest contraction, and corrected")
    membrane = MODULUS * THICKNESS
    for (triangles, vertices), colour in zip(STRIPS, style.PALETTE, strict=False):
        rows = []
        for strain in STRAINS:
            sets = (f"material.poisson={POISSON}", f"material.membrane_modulus={membrane!r}",
                    f"material.area_density={1e-4 * membrane!r}", f"mesh.strip.vertices={vertices}",
                    GRIPS.replace("1e-6", f"{0.1 * strain!r}"), f'initial.displacement.x="{strain!r}*x"', "verify={equilibrium=1e-4}")
            folder, _ = runs.scene("drogue-springs", "strip", "strip", *sets)
            rows.append(response(folder / "fields.h5", membrane, POISSON))
        with h5py.File(folder / "fields.h5") as h5:
            count = len(h5["mesh/triangles"])
        for axis, printed, correct, scale in ((axes[0, 0], "modulus_without_a_corner", "modulus", MODULUS / 1e9), (axes[0, 1], "largest_poisson", "poisson", 1.0)):
            axis.plot(STRAINS, [scale * row[correct] for row in rows], "-o", markersize=3, color=colour, label=f"{count} triangles ({triangles})")
            axis.plot(STRAINS, [scale * row[printed] for row in rows], "--", color=colour)
            print("5.5", count, correct, [f"{scale * row[correct]:.5g}" for row in rows], printed, [f"{scale * row[printed]:.5g}" for row in rows])
    axes[0, 0].set(xlabel="strain", ylabel="apparent Young's modulus (GPa)")
    axes[0, 1].set(xlabel="strain", ylabel="apparent Poisson's ratio")
    axes[0, 1].legend(fontsize=7, frameon=False, loc="center")
    figure.savefig(to / "shi-5-5.png", dpi=110)


def draw_stress(axis, folder, step, limit):
    """Draws the von Mises stress of the triangles at an output, and returns the collection."""
    with h5py.File(folder / "fields.h5") as h5:
        name = sorted(h5["steps"])[step]
        x, value = h5["steps"][name]["position"][...], h5["steps"][name]["von_mises"][...]
        triangles = h5["mesh/triangles"][...]
    drawn = PolyCollection(x[triangles][:, :, :2], array=value, cmap="viridis", edgecolors="face", linewidths=0.6)
    drawn.set_clim(0.0, limit or np.quantile(value, 0.995))
    axis.add_collection(drawn)
    axis.autoscale_view()
    axis.set_aspect("equal")
    axis.grid(visible=False)
    return drawn


def pulled(runs, to):
    """Figure 5.7: von Mises stress of a rectangle and a triangle pulled at their corners."""
    figure, axes = new_figure(1, 2, (7.2, 3.0), "Sheets pulled at their corners", "figure 5.7 of [Shi]: von Mises stress (N/m); 5461 and 1128 points, 13 g")
    for axis, name in zip(axes[0], ("pulled-rectangle", "pulled-triangle"), strict=True):
        folder, _ = runs.scene("drogue-springs", name, name)
        figure.colorbar(draw_stress(axis, folder, -1, None), ax=axis, shrink=0.8)
        axis.set(xlabel="x (m)", ylabel="y (m)")
    figure.savefig(to / "shi-5-7.png", dpi=110)


def wave(runs, to):
    """Figure 5.8: a stress wave along a sheet, wide (no motion across it) and narrow (free sides)."""
    figure, axes = new_figure(len(SPEED_TIMES), 2, (7.2, 3.6), "Stress waves along a sheet", "figure 5.8 of [Shi]: von Mises stress (N/m), sides held along y (left), a narrow strip with free sides (right)")
    narrow = ("mesh.rectangle={width=1.0,height=0.02,vertices=4000}", 'pin=[{where="x > 1-1e-9",axes="x"},{where="1",axes="z"}]',
              "output.probes=[{at=[0.3,0.01,0.0]},{at=[0.8,0.01,0.0]}]",
              "verify={front_speed={value=100.0,tolerance=4e-3}}")
    for column, (name, sets) in enumerate((("wide", ()), ("narrow", narrow))):
        folder, result = runs.scene("drogue-springs", "stress-wave", f"wave-{name}", 'output.fields=["position","von_mises"]',
                                    f"output.times={list(SPEED_TIMES)}", *sets)
        print("5.8", name, "error of the front's speed", f"{result['errors']['front_speed']:.3g}")
        for row, time in enumerate(SPEED_TIMES):
            axis = axes[row, column]
            drawn = draw_stress(axis, folder, row, 1.3)
            axis.set_aspect("auto")
            axis.set(xlim=(0, 1), yticks=[], ylabel=f"{1e3 * time:g} ms")
            axis.tick_params(labelbottom=row == len(SPEED_TIMES) - 1)
        axes[-1, column].set_xlabel("x (m)")
    figure.subplots_adjust(right=0.89, wspace=0.12, hspace=0.2)
    figure.colorbar(drawn, cax=figure.add_axes((0.91, 0.13, 0.015, 0.66)))
    figure.savefig(to / "shi-5-8.png", dpi=110)


def sod(runs, to):
    """Figure 5.14: density of Sod's problem on 400 and 3200 cells against the exact solution."""
    figure, axes = new_figure(1, 2, (7.2, 3.0), "Sod's shock tube", "figure 5.14 of [Shi]: density at t = 0.4 on 400 and 3200 cells")
    for axis, cells in zip(axes[0], (400, 3200), strict=True):
        folder, result = runs.scene("drogue-gas", "sod", f"sod-{cells}", f"mesh.cells={cells}", "output.times=[0.4]")
        with h5py.File(folder / "fields.h5") as h5:
            x, rho = h5["mesh/x"][...], h5["steps"][sorted(h5["steps"])[-1]]["rho"][...]
        axis.plot(x, rho, color=style.RUN_COLOUR, linewidth=0.9)
        axis.set(xlabel="x", ylabel="density", title=f"{cells} cells, L1 error {result['errors']['l1_density']:.2e}")
        print("5.14", cells, f"{result['errors']['l1_density']:.3g}")
    figure.savefig(to / "shi-5-14.png", dpi=110)


FIGURES = {"5.2": chord, "5.3": drum, "5.5": strip, "5.7": pulled, "5.8": wave, "5.14": sod}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--bin", type=pathlib.Path, required=True, help="folder of drogue-springs and drogue-gas")
    parser.add_argument("--figures", default=",".join(FIGURES), help="numbers; 5.3 includes 5.4")
    parser.add_argument("--backend", default="serial")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("out/dissertation"))
    parser.add_argument("--to", type=pathlib.Path, default=pathlib.Path(__file__).parents[2] / "docs/images")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    for name in options.figures.split(","):
        FIGURES.get(name, lambda *_: sys.exit(f"no figure {name}: {', '.join(FIGURES)}"))(Runs(options), options.to)


if __name__ == "__main__":
    main()
