# SPDX-License-Identifier: BSD-3-Clause
"""GeoTIFF files for tests, written and read with struct, zlib and numpy from the tables of TIFF 6.0, its Technical Notes 1 and 3 and the GeoTIFF
standard: what GDAL makes of them is not asked."""
import struct
import zlib

import numpy as np

SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 12: 8, 16: 8}
FORMATS = {"u": 1, "i": 2, "f": 3, "c": 6}


def write(file, values, corner=(0, 0), cell=1.0, epsg=25832, nodata=None, is_point=False, matrix=None, scale=None, place=True):
    """Rows from north to south in one strip a row; an array of rows, columns (, bands) of any number type, little-endian.

    corner: of the first cell to the north-west (is_point: its middle); matrix: x0, xc, xr, y0, yc, yr instead, for rotated ones.
    scale: (scale, offset) of the numbers. place: whether it says where it lies."""
    values = np.asarray(values)
    values = values.reshape(*values.shape[:2], -1)
    rows, columns, bands = values.shape
    entries = []

    def add(tag, kind, numbers, data=None):
        code = {2: "s", 3: "H", 4: "I", 12: "d"}[kind]
        data = data if data is not None else struct.pack(f"<{len(numbers)}{code}", *numbers)
        entries.append((tag, kind, len(data) // SIZES[kind], data))

    bits = 8 * values.dtype.itemsize
    row_bytes = columns * bands * values.dtype.itemsize
    add(256, 4, [columns])
    add(257, 4, [rows])
    add(258, 3, [bits] * bands)
    add(259, 3, [1])
    add(262, 3, [1])
    add(273, 4, [8 + r * row_bytes for r in range(rows)])
    add(277, 3, [bands])
    add(278, 4, [1])
    add(279, 4, [row_bytes] * rows)
    if bands > 1:
        add(338, 3, [0] * (bands - 1))
    add(339, 3, [FORMATS[values.dtype.kind]] * bands)
    if place and matrix is None:
        add(33550, 12, [cell, cell, 0.0])
        add(33922, 12, [0, 0, 0, *map(float, corner), 0.0])
    elif place:
        x0, xc, xr, y0, yc, yr = map(float, matrix)
        add(34264, 12, [xc, xr, 0, x0, yc, yr, 0, y0, 0, 0, 0, 0, 0, 0, 0, 1])
    keys = [*([1024, 0, 1, 1] if epsg else []), 1025, 0, 1, 2 if is_point else 1, *([3072, 0, 1, epsg] if epsg else [])]
    add(34735, 3, [1, 1, 0, len(keys) // 4, *keys])
    if scale:
        items = "".join(f'<Item name="{name.upper()}" sample="0" role="{name}">{number}</Item>' for name, number in zip(("scale", "offset"), scale))
        add(42112, 2, [], f"<GDALMetadata>{items}</GDALMetadata>\0".encode())
    if nodata is not None:
        add(42113, 2, [], f"{nodata}\0".encode())
    at = 8 + rows * row_bytes
    at += at % 2
    table, behind = struct.pack("<H", len(entries)), b""
    first = at + 2 + 12 * len(entries) + 4
    for tag, kind, count, data in entries:
        table += struct.pack("<HHI", tag, kind, count)
        table += data.ljust(4, b"\0") if len(data) <= 4 else struct.pack("<I", first + len(behind))
        behind += data + b"\0" * (len(data) % 2) if len(data) > 4 else b""
    with open(file, "wb") as stream:
        stream.write(struct.pack("<2sHI", b"II", 42, at) + values.astype(values.dtype.newbyteorder("<")).tobytes())
        stream.write(b"\0" * (at - stream.tell()) + table + b"\0\0\0\0" + behind)


def middles(rows, columns, corner=(0, 0), cell=1.0, is_point=False, matrix=None):
    """x and y in the middle of all cells, as write() places them."""
    c, r = np.meshgrid(np.arange(columns), np.arange(rows))
    half = 0.0 if is_point else 0.5
    x0, xc, xr, y0, yc, yr = matrix if matrix is not None else (corner[0], cell, 0, corner[1], 0, -cell)
    return x0 + (c + half) * xc + (r + half) * xr, y0 + (c + half) * yc + (r + half) * yr


def read(file):
    """Values (rows, columns), (x0, cell, y0, -cell) of the north-western corner, tags; tiled, deflated files with the floating-point predictor."""
    data = open(file, "rb").read()
    assert data[:4] == b"II*\0", data[:4]
    at, = struct.unpack_from("<I", data, 4)
    count, = struct.unpack_from("<H", data, at)
    tags = {}
    for entry in range(at + 2, at + 2 + 12 * count, 12):
        tag, kind, number = struct.unpack_from("<HHI", data, entry)
        size = SIZES[kind] * number
        begin = entry + 8 if size <= 4 else struct.unpack_from("<I", data, entry + 8)[0]
        tags[tag] = (data[begin:begin + size].rstrip(b"\0").decode() if kind == 2 else
                     struct.unpack_from("<%d%s" % (number, {1: "B", 3: "H", 4: "I", 12: "d", 16: "Q"}[kind]), data, begin))
    columns, rows, size = tags[256][0], tags[257][0], tags[258][0] // 8
    assert tags[259][0] in (8, 32946) and tags[317][0] == 3 and tags[339][0] == 3 and tags[277][0] == 1, tags
    width, height = tags[322][0], tags[323][0]
    across = -(-columns // width)
    values = np.zeros((-(-rows // height) * height, across * width), f"<f{size}")
    for number, (begin, length) in enumerate(zip(tags[324], tags[325])):
        assert length > 0
        planes = np.frombuffer(zlib.decompress(data[begin:begin + length]), np.uint8).reshape(height, -1)
        planes = np.cumsum(planes, axis=1, dtype=np.uint8).reshape(height, size, width)  # bytes of numbers, the highest ones first
        block = np.ascontiguousarray(planes[:, ::-1].transpose(0, 2, 1)).view(f"<f{size}")[:, :, 0]
        r, c = divmod(number, across)
        values[r * height:(r + 1) * height, c * width:(c + 1) * width] = block
    assert tags[33922][:3] == (0, 0, 0)
    return values[:rows, :columns], (tags[33922][3], tags[33550][0], tags[33922][4], -tags[33550][1]), tags


def epsg(tags):
    """The number of the projected system, and whether cells are points."""
    numbers = tags.get(34735, ())
    keys = dict(zip(numbers[4::4], numbers[7::4]))
    return keys.get(3072), keys.get(1025) == 2
