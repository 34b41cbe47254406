# SPDX-License-Identifier: BSD-3-Clause
"""LAS files for tests and benchmarks, written with struct and numpy from the tables of the specification."""
import struct

import numpy as np

HEAD = {0: 227, 1: 227, 2: 227, 3: 235, 4: 375}
LENGTH = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67]
WKT = 'PROJCS["site",UNIT["metre",1]]'


def header(form, minor, count, lower, upper, scale=0.001, offset=(0, 0, 0), extra=0, wkt=WKT):
    """Everything before the points: header and a record with the WKT."""
    record = struct.pack("<H16s2H32s", 0, b"LASF_Projection", 2112, len(wkt) + 1, b"") + wkt.encode() + b"\0"
    data = bytearray(HEAD[minor])
    data[:4] = b"LASF"
    for kind, at, value in (("<H", 6, 16 if form > 5 else 0), ("<B", 24, 1), ("<B", 25, minor), ("<H", 94, HEAD[minor]),
                            ("<I", 96, HEAD[minor] + len(record)), ("<I", 100, 1), ("<B", 104, form), ("<H", 105, LENGTH[form] + extra),
                            ("<I", 107, count if form < 6 and count < 2**32 else 0)):
        struct.pack_into(kind, data, at, value)
    struct.pack_into("<6d", data, 131, *3 * [scale], *offset)
    struct.pack_into("<6d", data, 179, *(side for pair in zip(upper, lower) for side in pair))
    if minor == 4:
        struct.pack_into("<Q", data, 247, count)
    return bytes(data) + record


def write(file, form, minor, count, seed=1, extra=0):
    """Points of random bytes, with coordinates of a slope in [0, 100] x [0, 100]; seeded."""
    random = np.random.default_rng(seed)
    points = random.integers(0, 256, (count, LENGTH[form] + extra), dtype=np.uint8)
    places = random.integers(0, 100000, (count, 3), dtype=np.int32)
    places[:, 2] = places[:, 0] // 10
    points[:, :12] = places.view(np.uint8).reshape(count, 12)
    if form not in (0, 2):
        at = 20 if form < 6 else 22
        points[:, at:at + 8] = random.random(count).view(np.uint8).reshape(count, 8)  # a time is a number
    with open(file, "wb") as stream:
        stream.write(header(form, minor, count, (0, 0, 0), (100, 100, 10), extra=extra) + points.tobytes())
