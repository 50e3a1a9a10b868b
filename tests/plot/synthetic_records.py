"""Synthetic records of drogue-perf that obey known power laws, for the tests of the evidence pages."""

import itertools
import json

H200 = {"gpu": "NVIDIA H200", "cpu": "Intel(R) Xeon(R) Processor", "threads": 16}
EPYC = {"gpu": "", "cpu": "AMD EPYC", "threads": 2}


def record(case, seconds, machine, facts=None, **changes):
    """One record whose interval is 2 % wide each way; `changes` replace its keys, `run` its date."""
    provenance = {
        "version": "0.1.0", "git": "abcdef123456", "compiler": "GNU 12.2.0", "flags": "-O3 -march=x86-64-v3",
        "kokkos": "4.5.1", "driver": "13.0" if machine["gpu"] else "",
        "date": changes.pop("run", "2026-11-22T05:00:00Z"),
    }
    document = {
        "schema": "drogue.perf/1", "case": case, "unit": "s per step", "bound": "synthetic", "samples": [seconds] * 3,
        "median": seconds, "interval": seconds and [0.98 * seconds, 1.02 * seconds], "error": 1e-4, "check": "passed",
        "provenance": provenance | machine, "facts": facts or {},
    }
    return document | changes


# name -> weno, power, error at 100 cells as a factor, cost of a step as a factor
SCHEMES = {
    "js": ("js", 1, 1.0, 1.0), "z": ("z", 1, 0.8, 1.05), "z2": ("z", 2, 0.9, 1.05), "m": ("m", 1, 0.85, 1.3),
    "teno5": ("teno5", 1, 0.7, 1.25), "muscl-hancock": ("muscl-hancock", 1, 2.5, 0.12),
}
USUAL = ("lf-stencil", "ssprk3", "double")
# problem -> error of JS at 100 cells, order of the WENO schemes, order of MUSCL-Hancock
PROBLEMS = {
    "entropy-wave": (3e-4, 5.0, 2.0), "shu-osher": (0.5, 1.6, 1.1), "blast": (0.3, 0.9, 0.8),
    "leblanc": (0.05, 0.95, 0.85), "sod": (0.012, 0.9, 0.85),
}
# s of a step: a latency and s a cell
SPEEDS = {"serial": (0.0, 6e-8), "openmp": (4e-6, 4.5e-9), "cuda": (5e-6, 1.2e-10)}
SECOND_SETTINGS = {"lf-stencil": 1.0, "lf-global": 1.15, "lf-single": 1.3}


def solution(problem, backend, scheme, settings, cells, machine, **changes):
    """Run whose error and time are powers of the mesh, plus a latency on OpenMP and CUDA."""
    weno, power, factor, cost = SCHEMES[scheme]
    splitting, time_scheme, precision = settings if scheme != "muscl-hancock" else ("", "", "double")
    error, order, other_order = PROBLEMS[problem]
    error *= (
        factor
        * SECOND_SETTINGS.get(splitting, 1.0)
        * (cells / 100) ** -(other_order if scheme == "muscl-hancock" else order)
    )
    error += 2e-7 if precision == "split" else 1e-13
    latency, cell = SPEEDS[backend]
    steps = 2 * cells
    stages = {"ssprk3": 1.0, "ssprk43": 0.7}.get(time_scheme, 1.0)
    seconds = steps * stages * (latency + cost * cell * cells * (0.8 if precision == "split" else 1.0))
    facts = {
        "problem": problem, "backend": backend, "weno": weno, "weno_power": power, "splitting": splitting,
        "time_scheme": time_scheme, "precision": precision, "cells": cells, "steps": steps, "status": "ok",
        "message": "",
    }
    label = " ".join([scheme, *(word for word, usual in zip(settings, USUAL) if word != usual)])
    changes = {"error": error, "unit": "s per solution"} | changes
    facts |= changes.pop("facts", {})
    return record(f"gas-solution/{problem}/{backend}/{label}/{cells}", seconds, machine, facts, **changes)


def solutions(machine=H200, problems=tuple(PROBLEMS), backends=tuple(SPEEDS), meshes=(100, 200, 400, 800, 1600, 3200)):
    """All schemes with default settings, WENO-Z with all; MUSCL-Hancock on Serial only; TENO5 fails LeBlanc."""
    settings = list(itertools.product(SECOND_SETTINGS, ("ssprk3", "ssprk43"), ("double", "split")))
    found = []
    for problem, backend, cells in itertools.product(problems, backends, meshes):
        for scheme in SCHEMES:
            if scheme == "muscl-hancock" and backend != "serial":
                continue
            changes = {}
            if (problem, scheme) == ("leblanc", "teno5"):
                message = "negative pressure in cell 41 at x = 2.3, step 12, t = 0.01"
                changes = {"facts": {"status": "numerical-failure", "message": message}, "median": None, "error": None}
            found.append(solution(problem, backend, scheme, USUAL, cells, machine, **changes))
        for variant in settings:
            if variant != USUAL:
                found.append(solution(problem, backend, "z", variant, cells, machine))
    return found


def step(case, seconds, machine, cells, **changes):
    """A step with its work: 1300 FLOP and 72 bytes per cell."""
    words = case.split("/")
    facts = {
        "backend": words[0], "cells": cells, "variant": "/".join(words[2:]), "flops": 1300 * cells, "bytes": 72 * cells,
    }
    return record(f"gas-step/{case}", seconds, machine, facts, **changes)


def steps_of_h200():
    """Steps of which some meet their goals and some miss them."""
    large = 1 << 24
    times = {
        "cuda/1024": 4.2e-6, "cuda/8192": 5.2e-6, "cuda/65536": 8.9e-6, "cuda/1048576": 138e-6,
        f"cuda/{large}": 2019e-6,
        f"cuda/{large}/z": 2100e-6, f"cuda/{large}/teno5": 2544e-6, f"cuda/{large}/split": 1400e-6,
        f"cuda/{large}/auto": 2025e-6, f"cuda/{large}/on": 5815e-6, "cuda/8192/graph": 9.6e-6,
    }
    return [step(name, seconds, H200, int(name.split("/")[1])) for name, seconds in times.items()]


def steps_of_core(machine=EPYC):
    """One core at 50 ns per cell and step, eight times as fast as the dense loop; two threads at 0.9 efficiency."""
    one = 50e-9
    times = {
        "dense-loop/8192": 8 * one * 8192, "serial/8192": one * 8192, "serial/1048576": one * (1 << 20),
        "openmp/8192": 0.6 * one * 8192, "openmp/1048576": one * (1 << 20) / 1.8,
    }
    return [step(name, seconds, machine, int(name.split("/")[1])) for name, seconds in times.items()]


def ceilings(backend="cuda", machine=H200, fp64=33e12, memory=4.2e12, cache=5.3e12):
    facts = {"backend": backend}
    work = 1e9
    return [
        record(f"ceiling/fp64/{backend}", work / fp64, machine, facts | {"flops": work}),
        record(f"ceiling/memory/{backend}", work / memory, machine, facts | {"bytes": work}),
        record(f"ceiling/cache/{backend}", work / cache, machine, facts | {"bytes": work}),
    ]


def more_ceilings(machine=H200):
    """Ceilings of CUDA beside the first three: twice the rate of FP64, and 2 us per launch, 0.5 us per kernel of a graph."""
    facts, work = {"backend": "cuda"}, 1e9
    return [
        record("ceiling/fp32/cuda", work / 66e12, machine, facts | {"flops": work}),
        record("ceiling/issue/cuda", work / 33e12, machine, facts | {"instructions": work}),
        record("ceiling/launch/cuda", 2e-6, machine, facts),
        record("ceiling/graph-node/cuda", 0.5e-6, machine, facts),
    ]


def counted_steps(machine=H200):
    """Steps of gas in a graph and in a persistent kernel, and of springs and flow, bound by different ceilings."""
    found = []
    for case, seconds, facts in (
        # 1.32e9 FLOP at 33e12 FLOP/s are 40 us, 0.66e9 instructions 20 us.
        ("gas-step/cuda/1048576", 50e-6, {"flops": 1.32e9, "instructions": 0.66e9, "bytes": 42e6, "launches": 2,
                                          "driver": "graph"}),
        ("gas-step/cuda/1024", 4e-6, {"flops": 1.32e6, "instructions": 0.66e6, "bytes": 42e3, "driver": "persistent"}),
        ("gas-step/cuda/2048", 1.25e-6, {"flops": 2.64e6, "bytes": 84e3, "launches": 2, "driver": "graph"}),
        # 420 bytes a vertex at 4.2 TB/s are 100 us, and 10 000 vertices stay in the cache.
        ("springs-step/cuda/1000000", 125e-6, {"bytes": 420e6, "launches": 2, "driver": "graph"}),
        ("springs-step/cuda/10000", 0.9e-6, {"bytes": 4.2e6, "launches": 1, "driver": "plain"}),
    ):
        _, backend, cells = case.split("/")
        found.append(record(case, seconds, machine, {"backend": backend, "cells": int(cells), "variant": "", **facts}))
    return found


def counted_batches(machine=H200):
    """Batches of options and tridiagonal systems, the first bound by FP64 at 80 % and the second by memory."""
    facts = {"backend": "cuda", "cells": 4096}
    return [
        record("options/cuda/4096/128x32", 400e-6, machine, facts | {"variant": "128x32", "flops": 320e-6 * 33e12, "bytes": 1e5}),
        record("options/cuda/4096/256x64", 1e-3, machine, facts | {"variant": "256x64"}),
        record("tridiagonal/cuda/4096/scan/128", 10e-6, machine,
               facts | {"variant": "scan/128", "flops": 33e6, "bytes": 8e-6 * 4.2e12}),
    ]


def scaling(machine=EPYC):
    """Strong scaling over threads at 80 %, and weak scaling over ranks at 50 %, with a fifth of the time for messages."""
    threads = [
        record(f"scaling/gas-step/openmp/8192/{count}", 1e-3 / (1.6 if count == 2 else 1.0), machine,
               {"backend": "openmp", "cells": 8192, "variant": "", "threads": count})
        for count in (1, 2)
    ]
    ranks = [
        record(f"scaling/flow-step/serial/64x64x{64 * count}/ranks/{count}/weak", 1e-2 * count, machine,
               {"backend": "serial", "cells": count << 18, "ranks": count, "threads": 1, "scaling": "weak",
                **({"messages_s": 4e-3, "model_s": 3e-3} if count > 1 else {})})
        for count in (1, 2)
    ]
    return threads + ranks


def abstraction(machine=H200):
    """Kernels of gas and springs in Kokkos, 2 and 8 % slower than in CUDA at a million cells, and a small one."""
    found = []
    for kernel, cells, launches, ratio in (
        ("gas-step", 1 << 20, "graph", 1.02), ("gas-step", 1024, "plain", 1.3), ("springs-step", 1 << 20, "graph", 1.08),
    ):
        for version, factor in (("kokkos", ratio), ("hand-written", 1.0)):
            facts = {"backend": "cuda", "cells": cells, "version": version, "launches": launches, "block": 128, "steps": 64}
            if version == "kokkos":
                facts |= {"ratio": ratio, "ratio_low": ratio - 0.01, "ratio_high": ratio + 0.01}
            case = f"abstraction/cuda/{kernel}/{cells}/{launches}/{version}"
            found.append(record(case, 1e-4 * factor, machine, facts, error=1e-15))
    return found


def transfers(machine=H200):
    """Copies take a third (pageable) or a twentieth (pinned) of the times of [Shi], similar to its Table 5.5."""
    found = []
    for index, cells in enumerate(range(1024, 8193, 1024)):
        thesis = {"h2d_us": 336 + 25 * index, "compute_us": 118 + 35 * index, "d2h_us": 272 + 15 * index}
        thesis["total_us"] = sum(thesis.values())
        for memory, share in (("pageable", 1 / 3), ("pinned", 1 / 20)):
            facts = {
                "backend": "cuda", "memory": memory, "cells": cells, "h2d_s": 1e-6 * thesis["h2d_us"] * share,
                "compute_s": 40e-6, "d2h_s": 1e-6 * thesis["d2h_us"] * share, "thesis": thesis,
            }
            seconds = facts["h2d_s"] + facts["compute_s"] + facts["d2h_s"]
            found.append(record(f"gas-transfers/cuda/{memory}/{cells}", seconds, machine, facts))
            ours = facts | {"method": "ours", "h2d_s": 1e-6, "compute_s": 5e-6, "d2h_s": 1e-6}
            found.append(record(f"gas-transfers/cuda/{memory}/{cells}/ours", 7e-6, machine, ours))
    return found


def blocks(machine=H200):
    found = []
    meshes = {"seed": range(1024, 8193, 1024), "step": [1 << power for power in range(10, 21, 2)]}
    for form, cells_of in meshes.items():
        for block, cells in itertools.product((32, 64, 128, 256, 512), cells_of):
            seconds = 5e-6 + cells * 1e-9 * (1 + abs(block - 128) / 300)
            facts = {"backend": "cuda", "form": form, "block": block, "cells": cells}
            found.append(record(f"gas-block/cuda/{form}/{block}/{cells}", seconds, machine, facts))
    return found


def flow_blocks(machine=H200):
    found = []
    for kind, form, cells in (("flow", "momentum", 262144), ("parachute", "contact", 432000)):
        for block in (32, 128, 512):
            facts = {"backend": "cuda", "form": form, "block": block, "cells": cells, "occupancy": 0.25}
            found.append(record(f"{kind}-block/cuda/{form}/{block}/{cells}", 1e-4 + 1e-7 * block, machine, facts))
    return found


def springs_solutions(machine=EPYC):
    """Errors n^-1 of n vertices with masses by area, n^-0.5 with equal masses; for strings the squares of these."""
    found = []
    for mass, integrator, doubling in itertools.product(("area", "equal"), ("rk4", "verlet"), range(7)):
        label = " ".join(word for word in (mass, integrator) if word not in ("area", "rk4"))
        share = 1.0 if integrator == "rk4" else 0.4
        for problem, model, n, order in (
            ("drum", "biquadratic", 60 << doubling, 1.0), ("catenary", "string", 8 << doubling, 2.0),
        ):
            error = n**-order if mass == "area" else n ** (-0.5 * order)
            facts = {
                "problem": problem, "backend": "serial", "model": model, "mass": mass, "integrator": integrator,
                "cells": n, "steps": 100, "status": "ok", "message": "",
            }
            case = f"springs-solution/{problem}/serial/{model} {label}/{n}".replace(" /", "/")
            found.append(record(case, share * 1e-6 * n**1.5, machine, facts, error=error))
    return sorted(found, key=lambda line: line["facts"]["problem"], reverse=True)


def springs_steps(machine=H200):
    """Steps with and without contact."""
    times = {
        "springs-step/cuda/2640": 4.07e-6, "springs-step/cuda/1000000": 350e-6,
        "springs-step/cuda/1000000/quadratic": 434e-6, "springs-step/scatter-loop/2640": 285e-6,
        "springs-contact/cuda/15625": 290e-6, "springs-contact/cuda/246000": 9e-3,
    }
    return [record(case, seconds, machine) for case, seconds in times.items()]


def ladder(name="weno", machine=EPYC, backend="serial"):
    """Three rungs, each twice as fast as the one before, predicted at half of their time."""
    found = []
    for place, rung in enumerate(("naive port", "resident", "fused stages")):
        seconds = 8e-3 / 2**place
        facts = {
            "ladder": name, "rung": rung, "backend": backend, "cells": 8192, "predicted_s": 0.5 * seconds,
            "predicted_bound": "arithmetic", "flops": 1e6, "bytes": 1e6,
        }
        found.append(record(f"ladder/{name}/{backend}/8192/{rung}", seconds, machine, facts))
    return found


def untimed(case, machine, facts, **changes):
    """A computed record, which has no samples."""
    return record(case, None, machine, facts, **({"samples": [], "interval": None, "error": 0.0} | changes))


def occupancy(machine=EPYC):
    """Rows of [Shi], of a gas kernel on two architectures, and two profiled kernels, of which one contradicts the model."""

    def facts(architecture, block, registers, blocks, **more):
        limits = {f"blocks_by_{name}": 8 * blocks for name in ("shared_memory", "threads", "limit")}
        return {"architecture": architecture, "block": block, "registers": registers, "shared_bytes": 0, "blocks": blocks,
                "blocks_by_registers": blocks, **limits, "threads_sm": block * blocks, "occupancy": block * blocks / 2048} | more

    printed = {"shared_bytes": 0, "blocks_by_registers": 8, "blocks_by_shared_memory": 64, "blocks_by_limit": 64, "blocks": 8,
               "threads_sm": 512, "threads_device": 7168, "occupancy_percent": 25.0}
    shi = facts("sm_20", 64, 63, 8, threads_device=7168, thesis=printed)
    found = [untimed("occupancy/sm_20/64", machine, shi), untimed("occupancy/sm_20/544", machine, facts("sm_20", 544, 63, 0, thesis=printed))]
    for architecture, suffix, blocks in (("sm_90", "", 4), ("sm_86", "/gas-step", 2)):
        own = facts(architecture, 128, 128, blocks, slots=384, least_blocks=4)
        found.append(untimed(f"occupancy/{architecture}/128/large-mesh{suffix}", machine, own))
    for kernel, achieved, check in (("StepFunctor", 3, "passed"), ("FluxFunctor", 4, "failed")):
        own = facts("sm_90", 128, 168, 3, kernel=f"drogue::gas::{kernel}", launches=5, limited_by="registers",
                    achieved={"blocks": achieved, "mean_blocks": 2.875})
        found.append(untimed(f"occupancy/sm_90/gas::{kernel}/128/168/0", machine, own, check=check, error=achieved - 3.0))
    return found


def hardware(machine=H200):
    """The machine of [Shi], and one with a GPU and an unknown L3 cache."""
    host = {"cpu": machine["cpu"], "cores": 16, "clock_hz": 2.1e9, "memory_bytes": 64 << 30, "l1_bytes": 768 << 10,
            "l2_bytes": 32 << 20, "l3_bytes": None, "os": "Linux 1", "kernel": "6.1"}
    device = {"gpu": machine["gpu"], "multiprocessors": 132, "clock_hz": 1.98e9, "memory_bytes": 141 << 30, "constant_bytes": 1 << 16,
              "shared_bytes": 228 << 10, "l2_bytes": 60 << 20, "registers": 65536}
    thesis = {"cpu": "two Xeon E5-2687W", "caches": "L3 2 x 20 MB", "gpu": "two Quadro 6000"}
    return [untimed("machine", machine, {"host": host, "device": device if machine["gpu"] else None, "thesis": thesis})]


def springs_transfers(machine=H200):
    thesis = {"cpu_us": 223565, "h2d_us": 171, "compute_us": 41328, "d2h_us": 644, "total_us": 42143}
    found = []
    for steps in (1, 10, 100):
        facts = {
            "backend": "cuda", "cells": 2641, "substeps": steps, "h2d_s": 3e-5, "compute_s": 5e-6 * steps,
            "d2h_s": 2e-5, "thesis": thesis,
        }
        found.append(record(f"springs-transfers/cuda/2641/{steps}", 5e-5 + 5e-6 * steps, machine, facts))
        pinned = facts | {"memory": "pinned", "h2d_s": 1e-5}
        found.append(record(f"springs-transfers/cuda/2641/{steps}/pinned", 3e-5 + 5e-6 * steps, machine, pinned))
    return found


def parachute_transfers(machine=H200):
    """Copies of 1 ms around one and twenty steps of 1 ms."""
    found = []
    for steps in (1, 20):
        facts = {
            "backend": "cuda", "memory": "pinned", "cells": 432000, "grid": "60x60x120", "substeps": steps,
            "h2d_s": 5e-4 / steps, "compute_s": 1e-3, "d2h_s": 5e-4 / steps,
        }
        found.append(record(f"parachute-transfers/cuda/pinned/60x60x120/{steps}", 1e-3 + 1e-3 / steps, machine, facts))
    return found


def options_solutions(machine=EPYC, backend="serial"):
    """Solutions of the three methods of options.

    Finite differences with n intervals have the error n^-2, four times that on one grid, ten times with split
    exercise. The scheme of [Shi] is of first order. Cosine series have one point and no settings.
    """
    found = []

    def add(method, n, seconds, error, **settings):
        facts = {"problem": "thesis", "backend": backend, "method": method, "cells": n, "steps": n, "status": "ok",
                 "message": "", "exercise": "", "grids": ""} | settings
        label = " ".join([method, *settings.values()])
        case = f"options-solution/thesis/{backend}/{label}/{n}"
        found.append(record(case, seconds, machine, facts, error=error, unit="s per option"))

    for n, step in itertools.product((64, 128, 256), (4, 2)):
        for (exercise, factor), (grids, other) in itertools.product(
            (("exact", 1.0), ("split", 10.0)), (("two", 1.0), ("one", 4.0))
        ):
            settings = {"exercise": exercise, "grids": grids, "intervals_a_step": str(step)}
            add("pide", n, 1e-9 * n**2 / step, factor * other * n**-2.0, **settings)
    for n in (64, 128, 256):
        add("seed", n, 1e-8 * n**2, 0.1 / n)
    add("cos", 32, 0.04, 3e-6)
    return found


def options_batches(machine=H200):
    """A batch that meets its goal, one that misses it, and tridiagonal systems by two solvers."""
    times = {
        "options/cuda/4096/128x32": 3e-4, "options/cuda/1/128x32": 2e-4, "tridiagonal/cuda/4096/pttrf/128": 4e-5,
        "tridiagonal/cuda/4096/scan/128": 1e-5,
    }
    return [record(case, seconds, machine) for case, seconds in times.items()]


def surfaces(machine=H200):
    """Surfaces that share solves, one whose strikes do not, and Bermudan puts by cosine series."""
    facts = {"backend": "cuda", "cells": 264, "variant": "surface 1x33x8"}
    return [
        record("options-surface/cuda/surface/1x33x8", 2e-4, machine, facts),
        record("options-surface/cuda/apart/1x33x8", 1.2e-4, machine, facts | {"variant": "apart 1x33x8"}),
        record("options-cos/cuda/256", 0.128, machine, {"backend": "cuda", "cells": 256, "variant": "cos"}),
    ]


def options_transfers(machine=H200):
    """One option on two meshes and one batch, by both methods."""
    found = []
    for options, mesh, method in itertools.product((1, 32), (128, 256), ("seed", "pide")):
        if options == 32 and mesh == 256:
            continue
        thesis = {"h2d_us": 2902, "compute_us": 3892648, "d2h_us": 96, "total_us": 3895646}
        if options == 32:
            thesis["cpu_us"] = 35361760
        seconds = 1e-3 if method == "seed" else 2e-4
        facts = {
            "backend": "cuda", "method": method, "cells": options, "mesh": mesh, "h2d_s": 0.1 * seconds,
            "compute_s": 0.8 * seconds, "d2h_s": 0.1 * seconds, "thesis": thesis,
        }
        for memory, factor in (("pageable", 1.0), ("pinned", 0.9)):
            own = facts | {"memory": memory, "h2d_s": factor * facts["h2d_s"]}
            case = f"options-transfers/cuda/{method}/{options}/{mesh}/{memory}"
            found.append(record(case, seconds * (0.9 + 0.1 * factor), machine, own))
    return found


def flow_solutions(machine=H200, backend="cuda"):
    """Errors 10 n^-2 of n cells per axis for AB2, a tenth of it for RK3 in twice the time; central ones are 4 times as
    large. Matrix products cost twice as much, implicit diffusion three times."""
    found = []
    for problem, (advection, factor), n in itertools.product(
        ("drifting-vortices", "resting-vortices"), (("weno-z", 1.0), ("central", 4.0)), (32, 64, 128)
    ):
        for time, pressure, diffusion in itertools.product(
            ("ab2", "rk3"), ("fft", "diagonalization"), ("explicit", "crank-nicolson")
        ):
            if time == "rk3" and diffusion == "crank-nicolson":
                continue
            cost = (2.0 if time == "rk3" else 1.0) * (2.0 if pressure != "fft" else 1.0)
            cost *= 3.0 if diffusion != "explicit" else 1.0
            facts = {
                "problem": problem, "backend": backend, "advection": advection, "time_scheme": time,
                "pressure": pressure, "diffusion": diffusion, "cells": n, "steps": n, "status": "ok", "message": "",
            }
            label = f"{advection} {time} {pressure} {diffusion}"
            error = factor * 10.0 * n**-2.0 * (0.1 if time == "rk3" else 1.0)
            found.append(
                record(f"flow-solution/{problem}/{backend}/{label}/{n}", cost * 1e-9 * n**4, machine, facts, error=error)
            )
    return found


def cavity_solutions(machine=H200):
    """Errors 10 n^-2 on CUDA, which has no transforms between walls; AB2 and RK3 of WENO-Z."""
    found = []
    for time, n in itertools.product(("ab2", "rk3"), (16, 32, 64)):
        facts = {
            "problem": "cavity", "backend": "cuda", "advection": "weno-z", "time_scheme": time,
            "pressure": "diagonalization", "diffusion": "explicit", "cells": n, "steps": n, "status": "ok", "message": "",
        }
        seconds = (3e-7 if time == "rk3" else 1e-7) * n**4
        case = f"flow-solution/cavity/cuda/weno-z {time} diagonalization/{n}"
        found.append(record(case, seconds, machine, facts, error=10.0 * n**-2.0))
    return found


def flow_steps(machine=H200):
    """Steps of 0.16 ns per cell that move 296 bytes, and small ones that miss their goal."""
    found = []
    for grid, cells, variant, seconds in (
        ("256x256x256", 1 << 24, "periodic", 0.16e-9 * (1 << 24)),
        ("60x60x120", 432000, "tunnel", 240e-6),
    ):
        facts = {"backend": "cuda", "cells": cells, "variant": variant, "bytes": 296 * cells}
        found.append(record(f"flow-step/cuda/{grid}/{variant}", seconds, machine, facts))
    return found


def flights(machine=H200):
    """An opening parachute at 0.6 s per second of flight."""
    facts = {"backend": "cuda", "cells": 432000, "variant": "c9"}
    return [record("parachute-flight/cuda/60x60x120/c9", 0.6e-3, machine, facts)]


def openings(machine=H200):
    """Parachutes with errors of 2 / n on n cells across; fine cloth costs twice as much, an inset nothing."""
    found = []
    problems, schemes = ("opening-impulse", "opening-time", "porous-drag"), ("cbs43", "cbs43 inset 0.55")
    for problem, kernel, edge, n in itertools.product(problems, schemes, ("0.7", "0.35"), (15, 30, 60)):
        facts = {
            "problem": problem, "backend": "cuda", "kernel": kernel, "time": "ab2 0.25", "edge": edge, "cells": n,
            "steps": n, "status": "ok", "message": "",
        }
        case = f"parachute-solution/{problem}/cuda/{kernel} ab2 0.25 edge {edge}/{n}"
        seconds = 1e-5 * n**3 * (2.0 if edge == "0.35" else 1.0)
        found.append(record(case, seconds, machine, facts, error=2.0 / n))
    return found


def flow_solvers(machine=H200):
    """A direct and an iterative pressure solver, and the memory of a solver."""
    cells = 64**3
    facts = {"backend": "cuda", "cells": cells}
    return [
        record("flow-pressure/cuda/64x64x64/fft/periodic", 2e-5, machine, facts | {"variant": "fft/periodic"}),
        record("flow-pressure/cuda/64x64x64/hypre-pfmg/walls/1e-6", 0.25, machine,
               facts | {"variant": "hypre-pfmg/walls/1e-6", "tolerance": 1e-6, "iterations": 9}),
        record("flow-memory/cuda/64x64x64/periodic", None, machine,
               facts | {"variant": "periodic", "array_bytes": 124 * cells, "driver_bytes": 140 * cells},
               samples=[], interval=None),
    ]


def write(file, records):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("".join(json.dumps(line) + "\n" for line in records))
    return file
