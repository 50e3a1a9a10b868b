"""docs/transfers.md and transfers-tables.md: transfers as recorded in docs/evidence/*-transfers-MACHINE.jsonl."""

import statistics

from .forms import EVIDENCE, error_of, passed, table, wrapped

HEAD = """# Transfers: tables 5.5 to 5.8 of [Shi]

What copies between host and device cost, beside the times of [Shi] on its Quadro 6000. `scripts/publish_records.py
--tables` writes this page and [all rows](transfers-tables.md) from the records that `drogue-perf table transfers --app A
--out FILE` wrote. [Shi] is the dissertation that the [README](../README.md#source) cites.

A sample is a copy to the device (H2D), k steps or a batch (compute), and a copy to the host (D2H). A step then takes

$$t=\\frac{t_{\\mathrm{H2D}}+t_{\\mathrm{D2H}}}{k}+t_{\\mathrm{step}},$$

so copies matter the less the longer a state stays on the device. From pageable memory the driver copies by way of a
page-locked buffer of its own; pinned memory has no such detour.

* Times are microseconds, per step of gas and of parachutes, of cloth for all steps between copies, of options per batch;
  in brackets those of [Shi]. Parts and total are medians of their own, which need not add up.
* CPU: the computation of the row on one core, and its ratios to compute and total, in brackets those of the CPU of
  [Shi]; a dash where no record has such a time.
* Of several records of a mini-app the latest of a GPU counts; times of a core that it lacks are those of the latest
  record of a host, which the line above a table names.
* Trust the shares of copies and the errors. Ratios to the times of [Shi] compare devices that are a decade apart, and
  mean nothing where [Shi] does not state the number of steps.
"""
ROWS_HEAD = """# Transfers: all rows

All recorded rows of [transfers](transfers.md), which explains the columns and has those of the largest sizes. Written by
`scripts/publish_records.py --tables`. Times are in microseconds, in brackets those of [Shi].
"""
PARTS = {"h2d": "H2D", "compute": "compute", "d2h": "D2H", "total": "total"}
ON_CORE = ["CPU", "CPU / compute", "CPU / total"]


class Row:
    """A record of transfers; times in us."""

    def __init__(self, record):
        facts = record.facts
        self.record, self.facts, self.app = record, facts, record.case.partition("-")[0]
        self.size, self.mesh, self.steps = facts["cells"], facts.get("mesh"), facts.get("substeps")
        self.ours = facts.get("method", "ours" if self.app != "gas" else "seed") != "seed"
        # Records before the memory was a fact: options had pinned memory in our scheme alone.
        self.memory = facts.get("memory") or ("pinned" if self.app == "options" and self.ours else "pageable")
        self.time = {part: 1e6 * facts[f"{part}_s"] for part in PARTS if part != "total"}
        self.time["total"] = 1e6 * statistics.median(record.samples)
        self.thesis = {part: facts.get("thesis", {}).get(f"{part}_us") for part in (*PARTS, "cpu")}
        self.core = 1e6 * facts["cpu_s"] if "cpu_s" in facts else None
        self.copies = self.time["h2d"] + self.time["d2h"]

    @property
    def on_gpu(self):
        return self.facts["backend"] == "cuda"

    @property
    def place(self):
        """Scheme and sizes of the row, which do not depend on the device or its memory."""
        return self.ours, self.size, self.mesh, self.steps

    @property
    def scheme(self):
        return "ours" if self.ours else "of [Shi]"

    def on_core(self):
        """Cells of the columns of one core."""
        found = []
        for part in (None, "compute", "total"):
            core, printed = self.core, self.thesis["cpu"]
            if part:
                core, printed = core and core / self.time[part], printed and printed / self.thesis[part]
            found.append((number(core) if core else "-") + (f" ({number(printed)})" if printed else ""))
        return found

    def cells(self, with_core):
        """Cells of the table: what is measured, times, on request those of one core, error."""
        place = {"options": [str(self.size), str(self.mesh)], "gas": [str(self.size)]}.get(self.app, [str(self.size), str(self.steps)])
        if self.app == "parachute":
            place[0] = self.facts["grid"]
        scheme = [self.scheme] if self.app in ("gas", "options") else []
        times = [number(self.time[part]) + (f" ({self.thesis[part]:.0f})" if self.thesis[part] else "") for part in PARTS]
        return [*scheme, self.memory, *place, *times, *(self.on_core() if with_core else []), error_of(self.record)]


def number(value):
    """Three digits, without an exponent."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def share(part, total):
    return f"{100 * part / total:.0f} %" if part > 0.1 * total else f"{100 * part / total:.1f} %"


def pick(rows, **wanted):
    """The rows with the given attributes, pinned ones last."""
    found = [row for row in rows if all(getattr(row, name) == value for name, value in wanted.items())]
    return sorted(found, key=lambda row: row.memory)


def gas_words(rows):
    size = max(row.size for row in rows)
    theirs = pick(rows, size=size, ours=False)
    thesis = theirs[0].thesis
    words = (f"At {size} cells [Shi] spends {share(thesis['h2d'] + thesis['d2h'], thesis['total'])} of {thesis['total']:.0f} us on "
             "copies: its scheme copies the state to the device and the fluxes back in each of three stages. The same copies take ")
    words += " and ".join(f"{share(row.copies, row.time['total'])} of {number(row.time['total'])} us with {row.memory} memory"
                          for row in theirs)
    ours = pick(rows, size=size, ours=True)
    if not ours:
        return words + ": a newer device does not remove them, since each waits for the bus."
    return (words + " here: a newer device does not remove them, since each waits for the bus. What does is a state that stays on "
            f"the device: with 20 steps between two copies a step of ours takes {number(ours[-1].time['total'])} us, copies "
            f"included ({share(ours[-1].copies, ours[-1].time['total'])}).")


def springs_words(rows):
    size = max(row.size for row in rows)
    own = pick(rows, size=size, memory="pageable")
    few, many = (choose((row for row in own), key=lambda row: row.steps) for choose in (min, max))
    thesis = few.thesis["total"]
    words = (f"[Shi] takes {thesis:.0f} us for {size} vertices and a number of substeps that is not recorded, so no ratio to it means "
             f"anything; its copies are {share(few.thesis['h2d'] + few.thesis['d2h'], thesis)} of that. Here two copies take "
             f"{number(few.copies)} us, whatever lies between them: {share(few.copies, few.time['total'])} of the total with one step "
             f"between them (`--seed-mode`), {share(many.copies, many.time['total'])} with {many.steps}. What changed is the compute, "
             f"{number(many.time['compute'] / many.steps)} us per step of {many.steps}: persistent packets of vertices instead of "
             "arrays of structs with stored neighbours (rung `structs` of the [ladder](lessons/tables.md)).")
    pinned = pick(rows, size=size, memory="pinned", steps=few.steps)
    return words + (f" From pinned memory the copies take {number(pinned[0].copies)} us." if pinned else "")


def options_words(rows):
    size = max(row.size for row in rows)
    theirs, ours = (pick(rows, size=size, ours=ours)[-1] for ours in (False, True))
    thesis = theirs.thesis["total"]
    # This commit had masses of cells as weights of the scheme of [Shi].
    note = " (three times that of the printed nodal weights, which came later)" if theirs.record.run_id[1].startswith("8334d94") else ""
    return (f"{size} puts on a mesh of {theirs.mesh} take {1e-6 * thesis:.2f} s on the device of [Shi]. Its scheme takes "
            f"{number(theirs.time['total'])} us here, with an error of {error_of(theirs.record)} of the strike{note}: the puts of a "
            "batch share the device, which [Shi] fills with the integrals of one put at a time. Ours takes "
            f"{number(ours.time['total'])} us with an error of {error_of(ours.record)}: a fourth of the steps, each on two grids for "
            "a stated error, with the convolution by panels of the jump measure. Copies are "
            f"{share(theirs.copies, theirs.time['total'])} and {share(ours.copies, ours.time['total'])} of the total: a batch moves "
            "once each way.")


def parachute_words(rows):
    size = max(row.size for row in rows)
    few, many = (choose(pick(rows, size=size, memory=rows[0].memory), key=lambda row: row.steps) for choose in (min, max))
    return (f"[Shi] prints no such table: its table 5.6 is of the fabric alone. A copy moves the whole state of cloth and air. On "
            f"{few.facts['grid']} cells the copies of each step would take {number(few.copies)} us, "
            f"{share(few.copies, few.time['total'])} of the step, from {few.memory} memory; with {many.steps} steps between two copies they take "
            f"{share(many.copies, many.time['total'])}. Runs copy only for output and restarts.")


APPS = {
    "gas": ("Gas, table 5.5", ["scheme", "memory", "cells"], gas_words),
    "springs": ("Cloth, table 5.6", ["memory", "vertices", "steps between copies"], springs_words),
    "options": ("Options, tables 5.7 and 5.8", ["scheme", "memory", "options", "mesh"], options_words),
    "parachute": ("Parachute", ["memory", "grid", "steps between copies"], parachute_words),
}


def read(file):
    """Rows of a file of records; stops the script if one failed its check."""
    return [Row(record) for record in passed(file)]


def latest(found):
    """File with its rows whose first record is the latest; None without files."""
    return max(found, key=lambda one: one[1][0].record.run_id, default=None)


def origin(file, rows):
    """Machine, date, commit and link of a file of records."""
    record = rows[0].record
    date, commit = record.run_id
    return f"{record.device(rows[0].on_gpu)}, {date[:10]}, commit {commit} ([records](evidence/{file.name}))"


def section(app, files, whole):
    """Heading and table of the records of a mini-app: all rows, or, after a paragraph, those of the largest size."""
    found = [(file, read(file)) for file in files]
    host = latest([one for one in found if not one[1][0].on_gpu])
    file, rows = latest([one for one in found if one[1][0].on_gpu]) or host
    rows.sort(key=lambda row: (row.ours, row.memory, row.size, row.mesh or 0, row.steps or 0))
    title, columns, words = APPS[app]
    backend = rows[0].facts["backend"]
    source = f"{origin(file, rows)}: `drogue-perf table transfers --app {app} --backend {backend}`."
    if host and not any(row.core for row in rows):
        core = {row.place: row.core for row in host[1]}
        for row in rows:
            row.core = core.get(row.place)
        source += f" CPU: one core of {origin(*host)}."
    with_core = any(row.core or row.thesis["cpu"] for row in rows)
    heading = [*columns, *PARTS.values(), *(ON_CORE if with_core else []), "error"]
    size, mesh = max(row.size for row in rows), max(row.mesh or 0 for row in rows)
    shown = [row for row in rows if whole or row.size == size or row.mesh == mesh]
    lines = table(heading, (row.cells(with_core) for row in shown), range(columns.index("memory") + 1))
    return f"\n## {title}\n" + ("" if whole else wrapped([words(rows)]) + "\n") + wrapped([source, "", *lines])


def page(evidence=EVIDENCE, whole=False):
    """Text of docs/transfers.md, or of the page of the whole tables."""
    found = {app: sorted(evidence.glob(f"{app}-transfers-*.jsonl")) for app in APPS}
    return (ROWS_HEAD if whole else HEAD) + "".join(section(app, files, whole) for app, files in found.items() if files)


def rows_page(evidence=EVIDENCE):
    """Text of docs/transfers-tables.md."""
    return page(evidence, whole=True)
