"""Section on a machine beside that of [Shi]: Table 4.1."""

from .perf_record import Record
from .section import Section, Table

_UNITS = ("B", "KiB", "MiB", "GiB", "TiB")


def _bytes(value) -> str:
    """Size in the largest unit of which it holds one; "not stated" for an unknown one."""
    if not isinstance(value, int | float) or value <= 0:
        return "not stated"
    place = 0
    while value >= 1024 and place + 1 < len(_UNITS):
        value, place = value / 1024, place + 1
    return f"{value:.4g} {_UNITS[place]}"


def _clock(value) -> str:
    return f"{1e-9 * value:.4g} GHz" if isinstance(value, int | float) and value > 0 else "clock not stated"


def _rows(record: Record) -> list[list[str]]:
    host, device = record.facts["host"], record.facts.get("device", {})
    printed, built = record.facts.get("thesis", {}), record.provenance
    caches = ", ".join(f"L{level} {_bytes(host.get(f'l{level}_bytes'))}" for level in (1, 2, 3))
    here = {
        "cpu": f"{host.get('cpu') or 'unknown'}, {host.get('cores')} cores, {_clock(host.get('clock_hz'))}, "
        f"{_bytes(host.get('memory_bytes'))}",
        "caches": f"{caches}, of all cores",
        "gpu": "none",
        "os": f"{host.get('os') or 'unknown'}, {host.get('kernel') or 'unknown kernel'}",
        "compiler": str(built.get("compiler") or "unknown"),
        "cuda": f"driver {built['driver']}" if built.get("driver") else "none",
    }
    if device:
        here["gpu"] = f"{device.get('gpu')}, {device.get('multiprocessors')} multiprocessors, {_clock(device.get('clock_hz'))}"
        here["gpu_memory"] = (
            f"{_bytes(device.get('memory_bytes'))} global, {_bytes(device.get('constant_bytes'))} constant, "
            f"{_bytes(device.get('shared_bytes'))} shared per multiprocessor, L2 {_bytes(device.get('l2_bytes'))}"
        )
        here["registers"] = f"{device.get('registers')} registers per multiprocessor"
    names = {
        "cpu": "CPU", "caches": "caches", "gpu": "GPU", "gpu_memory": "memory of the GPU", "registers": "registers",
        "os": "OS", "compiler": "compiler", "cuda": "CUDA",
    }
    return [[name, str(printed.get(key, "")), here.get(key, "")] for key, name in names.items()]


def sections(records: list[Record]) -> list[Section]:
    """One section on the latest record of a machine, none without records."""
    if not records:
        return []
    columns = [("part", False), ("[Shi]", False), ("this machine", False)]
    table = Table(columns, _rows(records[-1]), "Table 4.1")
    return [Section("Machine", "drogue-perf table machine --out FILE.jsonl", records[-1:], tables=[table])]
