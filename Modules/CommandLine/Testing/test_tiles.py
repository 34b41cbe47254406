# SPDX-License-Identifier: BSD-3-Clause
"""The job `tiles`: every point is in the file of its tile and of those near it, unchanged, and nothing else is written or removed."""
import json
import os

import numpy as np

import knotwork_testing
import las_files

FILES = knotwork_testing.Files("tiles")
RECORD = np.dtype([("xyz", "<i4", (3,)), ("rest", "V14")])  # of point format 2


def write(name, text):
    with open(FILES.path(name), "w", encoding="utf-8") as stream:
        stream.write(text)


def index(name):
    with open(FILES.path(name), encoding="utf-8") as stream:
        return json.load(stream)


def refused(*words, said=()):
    text = FILES.run(*words, status=1).stderr
    assert len(text.splitlines()) == 1 and all(word in text for word in said), text


def expected(found, xy):
    """(column, row) of every point, by the edges of the index."""
    numbers = []
    for d in range(2):
        first, last = found["first"][d], found["last"][d]
        edges = [found["origin"][d] + n * found["tile_size"][d] for n in range(first + 1, last + 1)]
        numbers.append(first + np.searchsorted(edges, xy[:, d], "right"))
    return numbers


def compare(found, xy, rows, read):
    """The files of all tiles against a brute-force choice of the rows."""
    assert found["points"] == len(xy) and sum(tile["points"] for tile in found["tiles"]) == len(xy)
    column, row = expected(found, xy)
    for tile in found["tiles"]:
        own = (column == tile["column"]) & (row == tile["row"])
        near = np.ones(len(xy), bool)
        for d, (n, low, high) in enumerate(((tile["column"], *tile["box"][:2]), (tile["row"], *tile["box"][2:]))):
            begin, end = (found["origin"][d] + (n + k) * found["tile_size"][d] for k in (0, 1))
            assert low == (found["lower"][d] if n == found["first"][d] else begin), tile
            assert high == (found["upper"][d] if n == found["last"][d] else end), tile
            near &= (xy[:, d] >= begin - found["halo"][d]) & (xy[:, d] <= end + found["halo"][d])
        assert tile["points"] == own.sum() and tile["points"] + tile["neighbours"] == near.sum(), tile
        assert np.all(near[own]) and np.array_equal(read(FILES.path(tile["file"])), rows[near]), tile
    assert sorted(os.listdir(FILES.path(os.path.dirname(found["tiles"][0]["file"])))) == sorted(
        os.path.basename(tile["file"]) for tile in found["tiles"])


def read_las(file):
    """Records of a tile, whose header is that of all points but for counts and box."""
    data = open(file, "rb").read()
    records = np.frombuffer(data, RECORD, offset=int.from_bytes(data[96:100], "little"))
    assert int.from_bytes(data[107:111], "little") == len(records)
    box = np.frombuffer(data, "<f8", 6, 179)
    points = records["xyz"] * 0.001
    assert np.array_equal(box[0::2], points.max(axis=0)) and np.array_equal(box[1::2], points.min(axis=0))
    returns = np.bincount([r["rest"].tobytes()[2] & 7 for r in records], minlength=8)
    assert np.array_equal(np.frombuffer(data, "<u4", 5, 111), returns[1:6])
    return records


def read_ply(file):
    data = open(file, "rb").read()
    head, rest = data.split(b"end_header\n", 1)
    return np.frombuffer(rest, "<f8").reshape(-1, head.count(b"property"))


def test_laser_scans_keep_their_records():
    las_files.write(FILES.path("scan.las"), 2, 2, 20000)
    report = FILES.report("tiles", "scan.las", "--points-per-tile", 2000, "--halo", 0.2, "--output", "scan.tiles")
    data = open(FILES.path("scan.las"), "rb").read()
    records = np.frombuffer(data, RECORD, offset=int.from_bytes(data[96:100], "little"))
    compare(index("scan.tiles"), records["xyz"][:, :2] * 0.001, records, read_las)
    assert report["points"] == 20000 and report["tiles"] == 9, report  # three by three of about 2000
    assert report["reference_system"] == index("scan.tiles")["reference_system"] == las_files.WKT
    assert report["points_written"] > 25000 and report["points_of_largest_tile"] < 5000, report


def test_text_and_ply_keep_their_numbers():
    random = np.random.default_rng(5)
    rows = np.c_[random.uniform(-3, 4, (5000, 2)), random.normal(size=(5000, 2))]
    text = "".join("%.17g %.17g %.17g %.17g\n" % tuple(row) for row in rows)
    write("cloud.xyz", "# x y z heat\n" + text)
    head = "element vertex 5000\nproperty double x\nproperty double y\nproperty double z\nproperty double heat\nend_header\n"
    write("ascii.ply", "ply\nformat ascii 1.0\n" + head + text)
    with open(FILES.path("binary.ply"), "wb") as stream:
        stream.write(("ply\nformat binary_big_endian 1.0\n" + head).encode() + rows.astype(">f8").tobytes())
    for name in ("cloud.xyz", "ascii.ply", "binary.ply"):
        FILES.run("tiles", name, "--tile-size", 1.5, "--output", "text.tiles")
        compare(index("text.tiles"), rows[:, :2], rows, read_ply)


def test_a_lattice_that_ends_on_an_edge_has_no_slivers():
    x, y = (side.ravel() for side in np.meshgrid(np.arange(11.0), np.arange(5.0)))
    write("lattice.csv", "x,y,z\n" + "".join("%g,%g,1\n" % pair for pair in zip(x, y)))
    FILES.run("tiles", "lattice.csv", "--tile-size", 5, "--halo", 0, "--output", "lattice.tiles")
    found = index("lattice.tiles")
    assert [tile["box"] for tile in found["tiles"]] == [[0, 5, 0, 4], [5, 10, 0, 4]], found
    compare(found, np.c_[x, y], np.c_[x, y, np.ones(55)], read_ply)


def test_tiles_are_points_of_other_jobs():
    las_files.write(FILES.path("scan.las"), 7, 4, 2000, extra=3)
    FILES.run("tiles", "scan.las", "--tile-size", 60, "--output", "modern.tiles")
    for tile in index("modern.tiles")["tiles"]:
        done = FILES.run("info", tile["file"])
        assert f"{tile['points'] + tile['neighbours']} points" in done.stdout and "NearInfrared" not in done.stdout, done.stdout


def test_what_cannot_be_split_is_one_line():
    las_files.write(FILES.path("scan.las"), 2, 2, 100)
    data = open(FILES.path("scan.las"), "rb").read()
    for name, content in (("short.las", data[:-30]), ("flat.las", data[:179] + bytes(48) + data[227:])):
        open(FILES.path(name), "wb").write(content)
    write("line.xyz", "1 2 3\n1 3 4\n")
    write("far.xyz", "0 0 0\n1e300 1 1\n")
    write("damaged.xyz", "0 0 0\n1 1 1\n2 2\n")
    before = sorted(os.listdir(FILES.folder))
    for words, said in ((("short.las",), ("short.las", "truncated")), (("flat.las",), ("flat.las", "--tile-size")),
                        (("line.xyz", "--tile-size", 1), ("line.xyz", "same x")), (("far.xyz", "--tile-size", 1), ("point 1", "1e+300")),
                        (("damaged.xyz", "--tile-size", 1), ("line 3", "2 columns")), (("damaged.xyz",), ("--tile-size",)),
                        (("missing.las",), ("missing.las", "cannot be read"))):
        refused("tiles", *words, "--output", "bad.tiles", said=said)
        assert sorted(os.listdir(FILES.folder)) == before
    FILES.run("tiles", "flat.las", "--tile-size", 50, "--output", "flat.tiles")


def test_nothing_else_goes():
    write("cloud.xyz", "0 0 0\n1 0 0\n0 1 0\n3 3 1\n")
    os.makedirs(FILES.path("mine"), exist_ok=True)
    write("mine/notes.txt", "mine")
    refused("tiles", "cloud.xyz", "--tile-size", 1, "--output", "mine.tiles", said=("'mine'", "other files"))
    FILES.run("tiles", "cloud.xyz", "--tile-size", 1, "--output", "again.tiles")
    write("again/notes.txt", "mine")
    old = set(os.listdir(FILES.path("again")))
    FILES.run("tiles", "cloud.xyz", "--tile-size", 4, "--output", "again.tiles")
    assert len(old) > 3 and set(os.listdir(FILES.path("again"))) == {"notes.txt", "tile-0-0.ply"}
    refused("tiles", "again/tile-0-0.ply", "--tile-size", 1, "--output", "again.tiles", said=("replace the input",))


knotwork_testing.main(globals())
