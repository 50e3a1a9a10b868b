"""Random damage to a file, reproducible by its seed."""

import random


def mutate(content, seed):
    """Returns `content` (bytes) after one to four random changes."""
    rng = random.Random(seed)
    data = bytearray(content)
    for _ in range(rng.randint(1, 4)):
        data = rng.choice(_ACCIDENTS)(data, rng)
    return bytes(data)


def _replace_byte(data, rng):
    data[rng.randrange(len(data))] = rng.randrange(256)
    return data


def _printable_byte(data, rng):
    data[rng.randrange(len(data))] = rng.choice(b" \n\t\"'[]{}=.,#+-0123456789eE_abcxyz^*/()<>&|?:")
    return data


def _flip_bit(data, rng):
    data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return data


def _insert(data, rng):
    place = rng.randrange(len(data))
    data[place:place] = bytes(rng.randrange(256) for _ in range(rng.randint(1, 4)))
    return data


def _delete(data, rng):
    start = rng.randrange(len(data))
    del data[start:start + rng.randint(1, 8)]
    return data or bytearray(b"a")


def _cut_off(data, rng):
    return data[:rng.randint(1, len(data))]


def _repeat(data, rng):
    start = rng.randrange(len(data))
    piece = data[start:start + rng.randint(1, 40)]
    data[start:start] = piece * rng.randint(1, 20)
    return data


def _change_number(data, rng):
    digits = [i for i, byte in enumerate(data) if 48 <= byte <= 57]
    if not digits:
        return data
    place = rng.choice(digits)
    data[place:place + 1] = rng.choice([b"0", b"-1", b"9999999999", b"1e308", b"1e-320", b"nan", b"inf", b"0x7f", b"7"])
    return data


def _swap_lines(data, rng):
    lines = data.split(b"\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return bytearray(b"\n".join(lines))


def _lose_line(data, rng):
    lines = data.split(b"\n")
    del lines[rng.randrange(len(lines))]
    return bytearray(b"\n".join(lines)) or bytearray(b"a")


_ACCIDENTS = [_replace_byte, _printable_byte, _flip_bit, _insert, _delete, _cut_off, _repeat, _change_number, _change_number,
              _swap_lines, _lose_line]
