"""Shared parts of the recording and measuring scripts: options, runs, histories, summaries, bitwise comparison of backends, and
the record file."""

import argparse
import csv
import json
import pathlib
import subprocess
import sys


# mpi_yield_when_idle: ranks that wait leave their core to others.
LAUNCHER = ("mpirun", "--oversubscribe", "--mca", "mpi_yield_when_idle", "1", "-n")
STOPPING_S = 30.0  # from the signal until a run is killed


def parse_with_arguments(parser, out):
    """Options of the command line, with --bin and --out (default: `out`), and the words after `--`, which go to the program."""
    parser.add_argument("--bin", type=pathlib.Path, default=pathlib.Path("build/host/bin"))
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path(out))
    words = sys.argv[1:]
    end = words.index("--") if "--" in words else len(words)
    return parser.parse_args(words[:end]), words[end + 1:]


def run_parachute(options, scene, folder, sets, arguments, codes=(0,)):
    """Runs a scene with assignments and more arguments; returns its folder in --out. Another code than `codes` ends this program."""
    command = [options.bin / "drogue-parachute", scene, "--quiet", "--overwrite", "--out", options.out / folder]
    code = subprocess.run([*command, *assignments(*sets), *arguments], check=False).returncode
    if code not in codes:
        sys.exit(code)
    return options.out / folder


def read_history(directory):
    """Rows of history.csv as numbers, by the names of the columns without their units."""
    with open(directory / "history.csv", newline="", encoding="utf-8") as file:
        return [{name.split(" ")[0]: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def run(program, scene, backend, folder, *more, ranks=1, limit=None):
    """Runs a scene into `folder`; returns its result.json with the keys `exit_code` and `message`.

    `ranks` above 1 start it through mpirun. A run that takes more than `limit` seconds is stopped; its exit code is None.
    """
    file = pathlib.Path(folder) / "result.json"
    file.unlink(missing_ok=True)
    launch = [*LAUNCHER, ranks] if ranks > 1 else []
    command = [*launch, program, scene, "--backend", backend, "--overwrite", "--quiet", "--out", folder, *more]
    words = [str(word) for word in command]
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        try:
            errors = process.communicate(timeout=limit)[1]
        except subprocess.TimeoutExpired:
            process.terminate()
            try:
                process.communicate(timeout=STOPPING_S)
            except subprocess.TimeoutExpired:
                process.kill()
            return {"exit_code": None, "message": f"stopped after {limit:g} s"}
    result = json.loads(file.read_text()) if file.exists() else {}
    message = own_message(errors) if ranks > 1 else errors.strip()
    return result | {"exit_code": process.returncode, "message": message or result.get("message", "")}


def own_message(errors):
    """The lines of stderr that are of a program: mpirun adds others after a failure."""
    own = [line for line in errors.splitlines() if line.startswith("drogue-")]
    return "\n".join(own) if own else errors.strip()


def assignments(*sets):
    """Command-line arguments `--set a --set b ...`."""
    return [word for assignment in sets for word in ("--set", assignment)]


def list_scenes(program):
    """Names of the shipped scenes of a program; raises CalledProcessError if it fails."""
    listed = subprocess.run([program, "--list-scenes"], capture_output=True, text=True, check=True).stdout
    return [line.split()[0] for line in listed.splitlines() if line.strip()]


def small_scenes(program):
    """Names of the scenes without -full."""
    return [name for name in list_scenes(program) if not name.endswith("-full")]


def summary(result):
    """The part of a result that a record keeps; times in s."""
    keep = ("scene", "backend", "device", "threads", "steps", "exit_code", "message", "checks", "ledger")
    short = {key: result.get(key) for key in keep} | {
        key: result[key] for key in ("limiter", "energy") if key in result
    }
    timing = result.get("timing", {})
    return short | {"compute_s": timing.get("compute_s"), "wall_s": timing.get("wall_s")}


def differing_datasets(first, second):
    """Names of the datasets of two fields.h5 that are not bitwise equal; `no dataset` if there are none."""
    import h5py

    def bits_of(file):
        """Bytes of each dataset of the steps, by name."""
        items = {}
        with h5py.File(file) as fields:
            fields["steps"].visititems(items.__setitem__)
            return {name: item[...].tobytes() for name, item in items.items() if isinstance(item, h5py.Dataset)}

    bits = [bits_of(file) for file in (first, second)]
    names = sorted(bits[0].keys() | bits[1].keys())
    return [name for name in names if bits[0].get(name) != bits[1].get(name)] if names else ["no dataset"]


def differing_results(first, second):
    """Names of the datasets of fields.h5 that differ between two run directories, and of history.csv if it does."""
    differences = {"fields.h5": differing_datasets, "history.csv": differing_bytes}
    names, compared = [], False
    for file, difference in differences.items():
        present = [(folder / file).exists() for folder in (first, second)]
        if all(present):
            names += difference(first / file, second / file)
            compared = True
        elif any(present):
            names.append(f"{file} of one run alone")
    return names if compared or names else ["neither fields nor history"]


def differing_bytes(first, second):
    """The name of two files, if they differ."""
    return [] if first.read_bytes() == second.read_bytes() else [first.name]


def exact_row(program, scene, backends, work):
    """Row on the bitwise equality of a scene between the first backend and the others, and the results of its runs in `work`."""
    folders = {backend: work / f"exact-{scene}-{backend}" for backend in backends}
    results = [run(program, scene, backend, folder) for backend, folder in folders.items()]
    row = {"scene": scene, "exit_codes": [result["exit_code"] for result in results], "different": {}}
    if any(row["exit_codes"]):
        row["message"] = next((result["message"] for result in results if result["exit_code"]), "")
    else:
        row["different"] = {b: len(differing_results(folders[backends[0]], folders[b])) for b in backends[1:]}
    row["identical"] = not any(row["exit_codes"]) and not any(row["different"].values())
    return row, results


def exact_rows(program, backends, work):
    """Rows of all scenes by `exact_row`."""
    return [exact_row(program, scene, backends, work)[0] for scene in list_scenes(program)]


def scene_runs(program, backends, work):
    """Head of a record: provenance, and the summary of each shipped scene on each backend."""
    runs = [run(program, scene, backend, work / f"{scene}-{backend}") for scene in list_scenes(program) for backend in backends]
    return {"provenance": runs[0].get("provenance"), "git": runs[0].get("git"), "runs": [summary(r) for r in runs]}


def argument_parser(description):
    """Parser with the options that all recording scripts share."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("machine")
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--backends", default="serial,openmp")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("out/record"))
    parser.add_argument("--to", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent / "docs/evidence")
    return parser


def save_record(record, file):
    """Writes the record to `file`, whose folder it creates."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(record, indent=1) + "\n")


def write_record(record, file, failed, shown):
    """Writes the record, prints a summary with the keys `shown`, and returns the exit code: 1 if a run failed."""
    save_record(record, file)
    print(f"{len(record['runs'])} runs, {len(failed)} failed")
    for row in failed:
        print("failed:", json.dumps(row)[:300])
    for key in shown:
        print(key, json.dumps(record.get(key))[:1500])
    return 1 if failed else 0
