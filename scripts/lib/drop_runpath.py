"""Drops DT_RUNPATH from shared libraries (ELF, 64 bit, little-endian): python3 drop_runpath.py FILE...

A library with a path of its own ignores that of the program, and would look for its libraries where its package put them.
"""

import struct
import sys
from pathlib import Path

PT_DYNAMIC, DT_NULL, DT_RUNPATH = 2, 0, 29
ENTRY = struct.Struct("<qQ")  # tag, value


def without_runpath(image):
    """The bytes of a library without the entry; later entries move up, as the list ends at the first DT_NULL."""
    if image[:6] != b"\x7fELF\x02\x01":
        raise ValueError("no ELF file of 64 bits, little-endian")
    image = bytearray(image)
    headers, size, count = struct.unpack_from("<Q", image, 32)[0], *struct.unpack_from("<HH", image, 54)
    for header in range(headers, headers + size * count, size):
        kind, _, offset, _, _, length = struct.unpack_from("<IIQQQQ", image, header)
        if kind != PT_DYNAMIC:
            continue
        entries = [ENTRY.unpack_from(image, at) for at in range(offset, offset + length, ENTRY.size)]
        kept = [entry for entry in entries if entry[0] != DT_RUNPATH]
        kept += [(DT_NULL, 0)] * (len(entries) - len(kept))
        for number, entry in enumerate(kept):
            ENTRY.pack_into(image, offset + number * ENTRY.size, *entry)
    return bytes(image)


def main(files):
    for file in map(Path, files):
        image = file.read_bytes()
        changed = without_runpath(image)
        if changed != image:
            file.write_bytes(changed)


if __name__ == "__main__":
    main(sys.argv[1:])
