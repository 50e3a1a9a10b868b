"""Tables of README.md between their marks.

A table names its records by case. Of several records of a case the latest one counts; one that failed its check stops the
script.
"""

import statistics
import sys

from plot.evidence.perf_record import read_file

from . import benchmark
from .forms import EVIDENCE, MARK, error_of, table, time_of, wrapped


class Records:
    """Latest record of every case in the files of a pattern, and those that were used, in the order of their use."""

    def __init__(self, evidence, files):
        self._evidence, self._found, self.used = evidence, {}, []
        for file in sorted(evidence.glob(f"{files}.jsonl")):
            for record in read_file(file):
                old = self._found.get(record.case)
                if not old or record.run_id[0] >= old.run_id[0]:
                    self._found[record.case] = record

    def cases(self):
        return list(self._found)

    def __call__(self, case):
        """The record of a case; stops the script if there is none or it failed its check."""
        if case not in self._found:
            sys.exit(f"{self._evidence} holds no record of {case}: run scripts/bench.sh and scripts/publish_records.py")
        record = self._found[case]
        if record.check != "passed" or not record.samples:
            sys.exit(f"{record.place}: {case} failed its check or has no samples")
        self.used.append(record)
        return record

    def source(self, command):
        """Machine, date and commit of the records in use, their files, and the command that made them."""
        first = self.used[0]
        backend, here = first.facts["backend"], first.provenance
        on_gpu = backend == "cuda"
        machines = sorted({record.machine.gpu if on_gpu else record.machine.cpu for record in self.used})
        if len(machines) > 1:
            sys.exit(f"records of {' and '.join(machines)} in one table, for {command}: record all of its cases on one of them")
        name = first.device(on_gpu)
        dates = sorted({record.run_id[0][:10] for record in self.used})
        files = sorted({record.file for record in self.used})
        links = ", ".join(f"[records](docs/evidence/{file.relative_to(self._evidence).as_posix()})" for file in files)
        machine = f"One {name}, CUDA {here['driver']}" if on_gpu else f"{here['threads']} of the cores of an {name}"
        if backend == "serial":
            machine = f"One core of an {name}"
        return f"{machine}, {' and '.join(dates)} ({links}): `{command}`."


def gas_table(evidence):
    records, schemes = Records(evidence, "gas-*"), {"js": "JS", "z": "Z", "teno5": "TENO5"}
    rows, ratios = [], []
    for cells in (200, 400, 800, 1600):
        own = [records(f"gas-solution/shu-osher/cuda/{scheme}/{cells}") for scheme in schemes]
        rows.append([str(cells), *(error_of(record, 3) for record in own), *(time_of(record, 1e3) for record in own)])
        times = [statistics.median(record.samples) for record in own]
        ratios.append(max(times) / min(times) - 1)
    command = "drogue-perf work-precision --app gas --filter '^shu-osher$' --backend cuda"
    return [
        records.source(command), "",
        *table(["cells", *(f"{name}: error" for name in schemes.values()), *(f"{name}, ms" for name in schemes.values())], rows), "",
        f"The schemes cost nearly the same here (within {100 * max(ratios):.0f} %): at these meshes a step is latency, so the "
        "error decides.",
    ]


def springs_table(evidence):
    gpu, host = Records(evidence, "springs-*"), Records(evidence, "springs-*")
    rows = []
    for vertices in (61, 217, 817, 3169, 12481):
        row = [str(vertices)]
        for integrator in ("", " verlet"):
            own, other = (records(f"springs-solution/drum/{backend}/biquadratic{integrator}/{vertices}")
                          for records, backend in ((gpu, "cuda"), (host, "serial")))
            row += [error_of(own), time_of(own, 1e3), time_of(other, 1e3)]
        rows.append(row)
    command = "drogue-perf work-precision --app springs --filter '^drum$' --backend"
    heading = ["vertices", "Runge-Kutta: error", "GPU, ms", "core, ms", "Verlet: error", "GPU, ms", "core, ms"]
    return [gpu.source(f"{command} cuda"), host.source(f"{command} serial"), "", *table(heading, rows)]


def options_table(evidence):
    gpu, host = Records(evidence, "alone/options-*"), Records(evidence, "options-*")
    rows = []
    for count, words in ((1, "1"), (256, "256"), (4096, "4096"), (1_000_000, "1 M")):
        case = f"options/{{}}/{count}/128x32"
        own, other = ([records(case.format(backend))] if case.format(backend) in records.cases() else []
                      for records, backend in ((gpu, "cuda"), (host, "serial")))
        rows.append([words, *(time_of(found[0], 1e3) if found else "" for found in (own, other)),
                     error_of((own + other)[0])])
    heading = ["options", "GPU, ms", "core, ms", "error"]
    return [
        gpu.source("drogue-perf run --filter '^options/cuda/N/'"), "This is run for each number N of options alone.",
        host.source("drogue-perf run --filter '^options/serial'"), "", *table(heading, rows),
    ]


def flow_table(evidence):
    records, rows = Records(evidence, "flow*"), []
    for grid in ("64x64x64", "60x60x120", "128x128x128", "256x256x256"):
        row = [grid]
        for sides in ("periodic", "tunnel"):
            case = f"flow-step/cuda/{grid}/{sides}"
            if case not in records.cases():
                row += [""] * 3
                continue
            record = records(case)
            row += [time_of(record, 1e3), time_of(record, 1e9 / record.facts["cells"]), error_of(record)]
        rows.append(row)
    heading = ["cells", "periodic, ms per step", "ns per cell", "error", "inflow and outflow, ms per step", "ns per cell", "error"]
    return [records.source("drogue-perf run --filter '^flow-step/cuda'"), "", *table(heading, rows)]


def canopy_table(evidence):
    solutions, flights, rows = Records(evidence, "parachute-solution-*"), Records(evidence, "flight-*"), []
    for cells in (15, 30, 45, 60):
        own = [solutions(f"parachute-solution/porous-drag/cuda/cbs43{inset} ab2 0.25 edge 0.7/{cells}") for inset in ("", " inset 0.55")]
        rows.append([str(cells), *(text for record in own for text in (error_of(record, 3), time_of(record, 1e3)))])
    # A sample is the time of a millisecond of flight.
    small, contact, large = (time_of(flights(f"parachute-flight/cuda/{case}"), 1e3)
                             for case in ("60x60x120/c9", "60x60x120/c9-contact", "120x120x240/c9"))
    return [
        solutions.source("drogue-perf work-precision --app parachute --backend cuda"), "",
        *table(["cells across", "error", "ms", "with an inset: error", "ms"], rows), "",
        f"A second of flight of a C-9 in its stream takes {small} s on 60x60x120 cells, {contact} s with contact, and {large} s on "
        "120x120x240. " + flights.source("drogue-perf run --filter '^parachute-flight/cuda'"),
    ]


TABLES = {"merit": benchmark.summary, "gas": gas_table, "springs": springs_table, "options": options_table, "flow": flow_table, "canopy": canopy_table}


def renewed(text, evidence=EVIDENCE):
    """The text of a page with all its tables from the records of `evidence`."""
    marks = MARK.findall(text)
    if sorted(name for _, name, _ in marks) != sorted(TABLES):
        sys.exit(f"README.md has marks for {[name for _, name, _ in marks]}, and tables are {list(TABLES)}")
    return MARK.sub(lambda found: found[1] + wrapped(TABLES[found[2]](evidence)) + found[3], text)
