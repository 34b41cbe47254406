# SPDX-License-Identifier: BSD-3-Clause
"""GeoTIFF files as points: in the middle of the cells that the files' own tags give, whatever numbers they hold; the reference system goes on to
surfaces, contours and tiles; and damaged ones as one line each. Skipped without GDAL."""
import json
import os
import random

import numpy as np

import geotiff_files
import knotwork
import knotwork_testing

if not os.path.exists(os.path.join(knotwork_testing.BIN_DIR, "..", "libexec", "knotwork", "knotwork-gdal.so")):
    knotwork_testing.skip("knotwork-gdal.so is not built: GDAL is missing")

FILES = knotwork_testing.Files("geotiff")
CORNER = (432000.0, 5510040.0)
TYPES = "u1 i1 u2 i2 u4 i4 f4 f8".split()


def array(values):
    return np.array([values.GetTuple(i) for i in range(values.GetNumberOfTuples())])


def read(name):
    """Points, reference system, cells without data."""
    data = knotwork.read(FILES.path(name))
    field = data.GetFieldData()
    system = field.GetAbstractArray("CoordinateReferenceSystem")
    return array(data.GetPoints().GetData()), system.GetValue(0) if system else "", field.GetArray("CellsWithoutData").GetValue(0)


def terrain(rows, columns, **place):
    x, y = geotiff_files.middles(rows, columns, **place)
    return 300 + 20 * np.sin((x - CORNER[0]) / 40) * np.cos((y - CORNER[1]) / 30)


def test_points_are_the_middles_of_cells_with_data():
    rng = np.random.default_rng(3)
    for kind in TYPES:
        for is_point in (False, True):
            values = rng.integers(1, 100, (7, 11)).astype(kind)
            values[2, 3] = values[6, 10] = 0
            place = dict(corner=CORNER, cell=2.5, is_point=is_point)
            geotiff_files.write(FILES.path("dem.tif"), values, nodata=0, **place)
            x, y = geotiff_files.middles(7, 11, **place)
            points, system, without = read("dem.tif")
            kept = values != 0
            # two products and sums of the cell's numbers: half a unit in the last place of 5.5e6 each
            assert np.abs(points - np.c_[x[kept], y[kept], values[kept]]).max() < 4e-9, (kind, is_point)
            assert without == 2 and len(points) == 75 and '"EPSG","25832"' in system, (kind, without, system)


def test_numbers_that_are_not_finite_are_no_data():
    values = np.array([[1, np.nan, 2], [np.inf, 3, -np.inf]], "f4")
    geotiff_files.write(FILES.path("dem.tif"), values)
    points, _, without = read("dem.tif")
    assert without == 3 and points[:, 2].tolist() == [1, 2, 3], points


def test_rotated_and_scaled():
    matrix = (CORNER[0], 0.8, 0.6, CORNER[1], 0.6, -0.8)
    values = np.arange(35, dtype="i2").reshape(5, 7)
    geotiff_files.write(FILES.path("dem.tif"), values, matrix=matrix, scale=(0.25, 100.0), nodata=34)
    x, y = geotiff_files.middles(5, 7, matrix=matrix)
    points, _, without = read("dem.tif")
    expected = np.c_[x.ravel(), y.ravel(), 100 + 0.25 * values.ravel()][:34]
    assert without == 1 and np.abs(points - expected).max() < 4e-9, np.abs(points - expected).max()


def test_without_a_reference_system():
    geotiff_files.write(FILES.path("dem.tif"), np.ones((3, 3), "f4"), epsg=None)
    assert read("dem.tif")[1] == ""


def test_reference_system_goes_on():
    geotiff_files.write(FILES.path("dem.tif"), terrain(40, 60, corner=CORNER).astype("f4"), corner=CORNER)
    report = FILES.report("fit", "dem.tif", "--tolerance", 0.01, "--output", "surface.vtu")
    assert report["points"] == 2400 and report["within_tolerance"], report
    FILES.run("convert", "surface.vtu", "--output", "surface.vtpc", "--force")
    FILES.run("contour", "surface.vtpc", "--levels", 305, "--tolerance", 0.01, "--output", "lines.vtp", "--force")
    FILES.run("extract", "surface.vtu", "--box", CORNER[0] + 5, CORNER[0] + 20, CORNER[1] - 30, CORNER[1] - 10, "--output", "part.vtu", "--force")
    FILES.run("stitch", "part.vtu", "--output", "stitched.vtu", "--force")
    for name in ("surface.vtu", "lines.vtp", "part.vtu", "stitched.vtu"):
        system = knotwork.read(FILES.path(name)).GetFieldData().GetAbstractArray("CoordinateReferenceSystem")
        assert system and '"EPSG","25832"' in system.GetValue(0), name


def test_tiles_are_those_of_the_same_points():
    values = terrain(120, 200, corner=CORNER).astype("f4")
    values[:50, :70] = -9999
    geotiff_files.write(FILES.path("dem.tif"), values, corner=CORNER, nodata=-9999)
    report = FILES.report("tiles", "dem.tif", "--points-per-tile", 6000, "--output", "dem.tiles")
    assert report["points"] == 20500 and report["cells_without_data"] == 3500 and report["tiles"] == 6, report
    with open(FILES.path("dem.tiles"), encoding="utf-8") as stream:
        index = json.load(stream)
    found = []
    for tile in index["tiles"]:
        data = open(FILES.path(tile["file"]), "rb").read().split(b"end_header\n", 1)[1]
        points = np.frombuffer(data, "<f8").reshape(-1, 3)
        assert len(points) == tile["points"] + tile["neighbours"], tile
        found.append(points)
    whole = read("dem.tif")[0]
    assert np.array_equal(np.unique(np.concatenate(found), axis=0), np.unique(whole, axis=0))
    FILES.run("fit", "dem.tiles", "--tolerance", 0.05, "--output", "tiles.vtpc", "--force")
    FILES.run("contour", "tiles.vtpc", "--levels", 300, "--tolerance", 0.05, "--output", "lines.vtp", "--force")
    system = knotwork.read(FILES.path("lines.vtp")).GetFieldData().GetAbstractArray("CoordinateReferenceSystem")
    assert '"EPSG","25832"' in system.GetValue(0)


def test_what_cannot_be_read_is_one_line():
    ones = np.ones((20, 30), "f4")
    for name, words in (("bands", dict(values=np.ones((4, 4, 3), "u1"))), ("complex", dict(values=ones.astype("c8"))),
                        ("nowhere", dict(values=ones, place=False)), ("flat", dict(values=ones, matrix=(0, 1, 2, 0, 1, 2))),
                        ("empty", dict(values=ones, nodata=1))):
        geotiff_files.write(FILES.path(name + ".tif"), **words)
    geotiff_files.write(FILES.path("whole.tif"), ones)
    whole = open(FILES.path("whole.tif"), "rb").read()
    with open(FILES.path("cut.tif"), "wb") as stream:
        stream.write(whole[:len(whole) // 2])
    # the numbers of the last row lie behind the file's end
    moved = bytearray(whole)
    row = whole.index(np.uint32(8 + 19 * 120).tobytes())
    moved[row:row + 4] = np.uint32(len(whole) - 50).tobytes()
    with open(FILES.path("short.tif"), "wb") as stream:
        stream.write(moved)
    # a header of 2^30 x 20 cells, and of 200000 x 1000
    for name, columns in (("wide", 2**30), ("large", 10**7)):
        wide = bytearray(whole)
        at = int.from_bytes(whole[4:8], "little") + 2
        wide[at + 8:at + 12] = np.uint32(columns).tobytes()
        with open(FILES.path(name + ".tif"), "wb") as stream:
            stream.write(wide)
    with open(FILES.path("text.tif"), "w", encoding="utf-8") as stream:
        stream.write("no tiff")
    for name, said in (("bands", ("3 bands", "gdal_translate -b 1")), ("complex", ("complex", "Float64")), ("nowhere", ("geotransform", "-a_ullr")),
                       ("flat", ("geotransform", "without an area")), ("empty", ("no cell with data",)), ("cut", ("no GeoTIFF",)),
                       ("short", ("cannot be read", "truncated")), ("wide", ("a row of its blocks", "TILED=YES")), ("large", ("cells", "knotwork tiles")), ("text", ("no GeoTIFF",)),
                       ("missing", ("check the name",))):
        FILES.refused("info", name + ".tif", said=(name + ".tif", *said))
        if name not in ("wide", "large"):
            FILES.refused("tiles", name + ".tif", "--tile-size", 5, "--output", "bad.tiles",
                    said=(name + ".tif", *(() if name in ("missing", "empty") else said)))


def test_damaged_files_are_points_or_one_line():
    rng = random.Random(11)
    geotiff_files.write(FILES.path("whole.tif"), terrain(6, 8).astype("f4"), nodata=-9999)
    whole = open(FILES.path("whole.tif"), "rb").read()
    for number in range(60):
        damaged = bytearray(whole[:rng.randrange(8, len(whole) + 1)])
        for _ in range(rng.randrange(4)):
            damaged[rng.randrange(len(damaged))] = rng.randrange(256)
        with open(FILES.path("damaged.tif"), "wb") as stream:
            stream.write(damaged)
        done = knotwork_testing.run_program("info", "damaged.tif", "--quiet", folder=FILES.folder)
        assert done.returncode in (0, 1, 5), (number, done)
        assert (done.returncode == 1) == (len(done.stderr.splitlines()) == 1 and "damaged.tif" in done.stderr), (number, done)


def test_missing_library_is_named():
    geotiff_files.write(FILES.path("dem.tif"), np.ones((3, 3), "f4"))
    os.environ["KNOTWORK_WORKERS"] = FILES.folder
    try:
        FILES.refused("info", "dem.tif", said=("knotwork-gdal.so", "libgdal-dev"))
    finally:
        del os.environ["KNOTWORK_WORKERS"]


knotwork_testing.main(globals())
