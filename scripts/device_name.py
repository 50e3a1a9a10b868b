"""Name of the device of a record, for tables and lists."""

import re


def device_name(provenance, on_gpu):
    """Name of the GPU or the processor of a record, without marks of trade."""
    return re.sub(r"\((R|TM)\)", "", provenance["gpu" if on_gpu else "cpu"]) or "unknown processor"
