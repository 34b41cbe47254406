# SPDX-License-Identifier: BSD-3-Clause
"""Ways in which the bytes of a file are damaged, for any format: functions of the bytes and a random.Random."""
import re

WRONG_NUMBERS = [b"nan", b"inf", b"-inf", b"1e309", b"-1", b"0", b"-0", b"1e-320", b"99999999", b"2147483648", b"4294967295",
                 b"9223372036854775807", b"-9223372036854775809", b"18446744073709551616", b"1e18", b"0x10", b"1.5", b"1,5", b"12abc",
                 b"", b"\xff\xfe", b"9" * 400]
NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
TOKEN = re.compile(rb"[^\s<>/=\"',;]+")


def place(content, chance):
    """Some more of the damage is near the beginning, where the structure is."""
    most = max(len(content), 1)
    return chance.randrange(min(most, 600)) if chance.random() < 0.25 else chance.randrange(most)


def flip_bits(content, chance):
    damaged = bytearray(content)
    for _ in range(chance.choice((1, 1, 2, 5, 50))):
        damaged[place(content, chance)] ^= 1 << chance.randrange(8)
    return bytes(damaged)


def replace_bytes(content, chance):
    damaged = bytearray(content)
    for _ in range(chance.choice((1, 2, 5, 20))):
        damaged[place(content, chance)] = chance.randrange(256)
    return bytes(damaged)


def truncate(content, chance):
    return content[:chance.randrange(len(content))]


def lose_beginning(content, chance):
    return content[place(content, chance):]


def swap_blocks(content, chance):
    size = chance.choice((1, 4, 20, 200))
    a, b = sorted((place(content, chance), place(content, chance)))
    if a + size > b:
        return content[a:] + content[:a]
    return content[:a] + content[b:b + size] + content[a + size:b] + content[a:a + size] + content[b + size:]


def copy_block(content, chance):
    """Part of the file over another part of the same length."""
    size = chance.choice((2, 8, 20, 100))
    damaged = bytearray(content)
    for _ in range(chance.randint(1, 5)):
        to, source = place(content, chance), place(content, chance)
        block = content[source:source + size]
        damaged[to:to + len(block)] = block
    return bytes(damaged)


def repeat_block(content, chance):
    start = place(content, chance)
    block = content[start:start + chance.choice((1, 10, 100, 1000))]
    return content[:start] + block * chance.choice((2, 3, 50)) + content[start:]


def delete_block(content, chance):
    start = place(content, chance)
    return content[:start] + content[start + chance.choice((1, 4, 30, 300)):]


def replace_match(content, chance, pattern, makers):
    found = list(pattern.finditer(content))
    damaged = content
    near = [match for match in found if match.start() < 3000]
    chosen = {chance.choice(near if near and chance.random() < 0.7 else found) for _ in range(chance.choice((1, 1, 2, 6)))} if found else ()
    for match in sorted(chosen, key=lambda match: -match.start()):
        damaged = damaged[:match.start()] + chance.choice(makers) + damaged[match.end():]
    return damaged


def wrong_number(content, chance):
    return replace_match(content, chance, NUMBER, WRONG_NUMBERS)


def delete_token(content, chance):
    return replace_match(content, chance, TOKEN, [b""])


def exchange_token(content, chance):
    tokens = TOKEN.findall(content[:20000]) or [b""]
    return replace_match(content, chance, TOKEN, [chance.choice(tokens), b"\x1b[31m", b"\xe9\xff", b"a" * 5000, b"%s%n", b"../../x"])


def delete_line(content, chance):
    lines = content.splitlines(keepends=True)
    for _ in range(min(chance.choice((1, 1, 3)), len(lines) - 1)):
        del lines[chance.randrange(min(len(lines), 40)) if chance.random() < 0.5 else chance.randrange(len(lines))]
    return b"".join(lines)


def move_line(content, chance):
    lines = content.splitlines(keepends=True)
    line = lines.pop(chance.randrange(len(lines)))
    lines.insert(chance.randrange(len(lines) + 1), line)
    return b"".join(lines)


def nest_deeply(content, chance):
    """What opens in this format, very often."""
    at = place(content, chance)
    opening = chance.choice((b"<a>", b"<DataArray>", b"<Piece>", b"[", b"{\"a\":", b"(", b"((", b"<!--", b"<"))
    return content[:at] + opening * chance.choice((101, 5000, 200000)) + content[at:]


def change_header(content, chance):
    head = chance.choice((b"<?xml version=\"1.0\"?>\n<!DOCTYPE x [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>\n<x>&b;</x>",
                          b"ISO-10303-21;\n", b"solid \x00\x01\n", b"ply\nformat binary_little_endian 1.0\n", b"# vtk DataFile Version 9.9\n",
                          b"OFF\n", b"\xef\xbb\xbf", b"\xff\xfe", b"\x1f\x8b\x08", b"PK\x03\x04", b"\x7fELF", b"\n\n\n", b"{", b"\x00" * 80))
    lines = content.splitlines(keepends=True)
    return head + b"".join(lines[chance.choice((0, 1, 2)):])


def not_text(content, chance):
    at = place(content, chance)
    return content[:at] + bytes(chance.randrange(256) for _ in range(chance.choice((1, 3, 500)))) + content[at:]


def empty(content, chance):
    return chance.choice((b"", b" ", b"\n", b"\x00", b"\n" * 100000, b" " * 100000))


MODES = [flip_bits, replace_bytes, truncate, lose_beginning, swap_blocks, copy_block, repeat_block, delete_block, wrong_number, wrong_number,
         wrong_number, delete_token, exchange_token, delete_line, move_line, nest_deeply, change_header, not_text, empty]


def damage(content, chance):
    """One mode, now and then two; never the content itself."""
    for _ in range(100):
        mode = chance.choice(MODES)
        name, damaged = mode.__name__, mode(content, chance)
        if chance.random() < 0.15 and damaged:
            second = chance.choice(MODES)
            name, damaged = name + "+" + second.__name__, second(damaged, chance)
        if damaged != content:
            return name, damaged
    raise AssertionError("no mode changes the content")
