# SPDX-License-Identifier: BSD-3-Clause
"""GeoPackages of contours, read with sqlite3 and struct by the tables of the OGC's standard: lengths of circles, elevations, numbers of reference
systems; and what cannot be written, as one line. Skipped without GDAL."""
import math
import os
import resource
import signal
import sqlite3
import struct
import warnings

import numpy as np

import geotiff_files
import knotwork
import knotwork_testing

if not os.path.exists(os.path.join(knotwork_testing.BIN_DIR, "..", "libexec", "knotwork", "knotwork-gdal.so")):
    knotwork_testing.skip("knotwork-gdal.so is not built: GDAL is missing")

FILES = knotwork_testing.Files("geopackages")
CORNER = (432000.0, 5510080.0)
SUMMIT = (CORNER[0] + 50, CORNER[1] - 40)
COLUMNS = "elevation component_id closed patch_id max_error".split()


def radius(level):
    return math.sqrt(100 * (100 - level))


def surface(name="surface.vtu", epsg=25832):
    """z = 100 - r^2 / 100 around the summit, which a fit of degree two is exactly."""
    if not os.path.exists(FILES.path(name)):
        x, y = geotiff_files.middles(80, 100, corner=CORNER)
        values = 100 - ((x - SUMMIT[0])**2 + (y - SUMMIT[1])**2) / 100
        geotiff_files.write(FILES.path("dem.tif"), values, corner=CORNER, epsg=epsg)
        FILES.run("fit", "dem.tif", "--degree", 2, "--tolerance", 1e-6, "--output", name)
    return name


def read(name):
    """[(attributes, points)] of the one layer, and its reference system: (organization, number)."""
    base = sqlite3.connect("file:" + FILES.path(name) + "?mode=ro", uri=True)
    assert base.execute("PRAGMA application_id").fetchone()[0] == 0x47504B47
    (table, kind, srs), = base.execute("SELECT table_name, data_type, srs_id FROM gpkg_contents").fetchall()
    assert kind == "features"
    (column, geometry, own, z, m), = base.execute("SELECT column_name, geometry_type_name, srs_id, z, m FROM gpkg_geometry_columns").fetchall()
    assert (geometry, own, z, m) == ("LINESTRING", srs, 1, 0)
    system = base.execute("SELECT organization, organization_coordsys_id FROM gpkg_spatial_ref_sys WHERE srs_id = ?", (srs,)).fetchone()
    lines = []
    names = [row[1] for row in base.execute(f'PRAGMA table_info("{table}")') if row[1] not in ("fid", column)]
    for blob, *values in base.execute("SELECT " + ", ".join(f'"{each}"' for each in [column, *names]) + f' FROM "{table}" ORDER BY fid'):
        magic, version, flags, at = struct.unpack_from("<2sBBi", blob)
        assert magic == b"GP" and version == 0 and flags & 1 and at == srs, blob[:8]
        begin = 8 + 8 * (0, 4, 6, 6, 8)[flags >> 1 & 7]
        order, kind, count = struct.unpack_from("<BII", blob, begin)
        assert order == 1 and kind == 1002 and len(blob) == begin + 9 + 24 * count
        lines.append((dict(zip(names, values)), np.frombuffer(blob, "<f8", 3 * count, begin + 9).reshape(count, 3)))
    base.close()
    return lines, system, table


def test_circles_have_their_lengths_and_elevations():
    FILES.run("contour", surface(), "--levels", 90, 95, 99, 70, "--tolerance", 1e-5, "--output", "lines.gpkg", "--report", "lines.json", "--force")
    lines, system, table = read("lines.gpkg")
    assert system == ("EPSG", 25832) and table == "lines", (system, table)
    assert [sorted(each) == sorted(COLUMNS) for each, _ in lines] == [True] * len(lines), lines[0][0]
    assert FILES.report("contour", "surface.vtu", "--levels", 90, "--output", "l.gpkg")["reference_system"] == "EPSG:25832"
    for level in (90, 95, 99):
        (attributes, points), = (each for each in lines if each[0]["elevation"] == level)
        length = np.linalg.norm(np.diff(points[:, :2], axis=0), axis=1).sum()
        # a chord is at most 1e-5 below the level, so 1e-5 * 50 / r inside the circle; the fit is exact to rounding of 5.5e6
        assert attributes["closed"] == 1 and np.array_equal(points[0], points[-1]), level
        assert abs(length - 2 * math.pi * radius(level)) < 1e-4 * length, (level, length)
        r = np.hypot(points[:, 0] - SUMMIT[0], points[:, 1] - SUMMIT[1])
        assert np.abs(r - radius(level)).max() < 1e-3, (level, np.abs(r - radius(level)).max())  # half a cell would be 0.5
        assert np.abs(points[:, 2] - level).max() <= attributes["max_error"] + 1e-9 <= 1e-5 + 1e-9
    ends = [each for each in lines if each[0]["elevation"] == 70]  # circles that leave the domain
    assert len(ends) > 1 and all(attributes["closed"] == 0 for attributes, _ in ends)


def test_lines_are_those_of_the_polydata():
    for name in ("lines.gpkg", "lines.vtp"):
        FILES.run("contour", surface(), "--number", 7, "--output", name, "--force", "--quiet")
    data = knotwork.read(FILES.path("lines.vtp"))
    lines, _, _ = read("lines.gpkg")
    assert len(lines) == data.GetNumberOfCells() > 6
    levels = data.GetCellData().GetArray("Level")
    for number, (attributes, points) in enumerate(lines):
        cell = data.GetCell(number).GetPoints()
        assert np.array_equal(points, [cell.GetPoint(i) for i in range(cell.GetNumberOfPoints())])
        assert attributes["elevation"] == levels.GetValue(number)


def test_reference_systems_are_stated_or_none():
    surface("plain.vtu", epsg=None)
    for words, said, system in (((), "", None), (("--crs", "EPSG:31467"), "EPSG:31467", ("EPSG", 31467)),
                                (("--crs", "EPSG:4326"), "EPSG:4326", ("EPSG", 4326))):
        report = FILES.report("contour", "plain.vtu", "--levels", 95, *words, "--output", "lines.gpkg")
        lines, found, _ = read("lines.gpkg")
        assert report["reference_system"] == said and len(lines) == 1, report
        assert found == system if system else found[1] in (-1, 0), found
        assert abs(lines[0][1][:, 0].mean() - SUMMIT[0]) < 1, "x stays x"
    report = FILES.report("contour", surface(), "--levels", 95, "--crs", "EPSG:31467", "--output", "lines.gpkg")
    assert report["reference_system"] == "EPSG:31467" and read("lines.gpkg")[1] == ("EPSG", 31467)


def test_reference_systems_of_clouds_are_stated():
    """Points in text have none: what is stated goes with fits and tiles, and with what is made of them."""
    x, y = np.meshgrid(np.linspace(0.0, 10.0, 41), np.linspace(0.0, 10.0, 41))
    np.savetxt(FILES.path("hill.xyz"), np.column_stack([x.ravel(), y.ravel(), 5.0 - 0.1 * ((x - 5) ** 2 + (y - 5) ** 2).ravel()]))
    report = FILES.report("fit", "hill.xyz", "--tolerance", 0.01, "--crs", "EPSG:25832", "--output", "hill.vtu")
    assert report["reference_system"] == "EPSG:25832"
    for made in (("hill.xyz", "--tile-size", 5, "--crs", "EPSG:25832", "--output", "hill.tiles"), ("hill.xyz", "--tile-size", 5, "--output", "plain.tiles")):
        FILES.run("tiles", *made)
    FILES.run("fit", "hill.tiles", "--tolerance", 0.01, "--output", "of_tiles.vtu")
    FILES.run("fit", "plain.tiles", "--tolerance", 0.01, "--crs", "EPSG:25832", "--output", "stated.vtu")
    for name in ("hill.vtu", "of_tiles.vtu", "stated.vtu"):
        FILES.run("contour", name, "--levels", 3, "--output", "hill.gpkg", "--force")
        assert read("hill.gpkg")[1] == ("EPSG", 25832), name
    for job, name, words in (("fit", "hill.xyz", ("--tolerance", 0.01)), ("fit", "plain.tiles", ("--tolerance", 0.01)), ("tiles", "hill.xyz", ("--tile-size", 5))):
        output = "never.tiles" if job == "tiles" else "never.vtu"
        FILES.refused(job, name, *words, "--output", output, "--crs", "EPSG:99999", said=("EPSG:99999", "unknown"))


def test_python_writes_them():
    lines = knotwork.contour(knotwork.read(FILES.path(surface())), levels=[95.0])
    lines.save(FILES.path("python.gpkg"))
    assert read("python.gpkg")[1:] == (("EPSG", 25832), "python")
    knotwork.write(lines, FILES.path("python.gpkg"))  # which replaces it
    writer = knotwork.vtkGeoPackageWriter()
    writer.SetInputDataObject(lines)
    writer.SetFileName(FILES.path("stated.gpkg"))
    writer.SetReferenceSystem("EPSG:32632")
    assert writer.Write() == 1 and read("stated.gpkg")[1] == ("EPSG", 32632)


def test_keys_of_laser_scans_are_numbers():
    """The GeoTIFF keys that LAS files have in place of WKT."""
    lines = knotwork.contour(knotwork.read(FILES.path(surface())), levels=[95.0])
    field = lines.GetFieldData().GetAbstractArray("CoordinateReferenceSystem")
    for keys, system in (("1 1 0 2 1024 0 1 1 3072 0 1 25833", ("EPSG", 25833)), ("1 1 0 2 1024 0 1 2 2048 0 1 4258", ("EPSG", 4258)),
                         # with heights: a compound system has no number
                         ("1 1 0 3 1024 0 1 1 3072 0 1 25833 4096 0 1 7837", ("NONE", 100000))):
        field.SetValue(0, "GeoKeyDirectory " + keys)
        lines.save(FILES.path("keys.gpkg"))
        assert read("keys.gpkg")[1] == system, (keys, read("keys.gpkg")[1])
    base = sqlite3.connect(FILES.path("keys.gpkg"))
    (wkt,), = base.execute("SELECT definition FROM gpkg_spatial_ref_sys WHERE srs_id = 100000").fetchall()
    base.close()
    assert wkt.startswith("COMPD_CS") and '"EPSG","25833"' in wkt and '"EPSG","7837"' in wkt, wkt
    field.SetValue(0, "GeoKeyDirectory 1 1 0 1 3072 0 1 32767")  # defined by the user: not carried
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        lines.save(FILES.path("keys.gpkg"))
    assert any("reference system" in str(each.message) for each in caught) and read("keys.gpkg")[1][1] in (-1, 0), [str(each.message) for each in caught]


def test_what_cannot_be_written_is_one_line_and_leaves_nothing():
    lines = ("contour", surface(), "--levels", 95, "--output")
    for name in ("new.gpkg", "l.gpkg"):
        FILES.refused(*lines, name, "--crs", "EPSG:99999", said=("EPSG:99999", "unknown"))
    FILES.refused(*lines, "no/such/folder/lines.gpkg", said=("no/such/folder",))
    FILES.refused("contour", surface(), "--levels", 1e5, "--output", "none.gpkg", said=("no lines", "none.gpkg"))
    FILES.refused("convert", "dem.tif", "--output", "points.gpkg", said=("points.gpkg", "change the ending"))

    def full(size):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        return limit

    FILES.run(*lines, "whole.gpkg", "--force")
    whole = os.path.getsize(FILES.path("whole.gpkg"))
    for size in (0, 5000, whole // 2, whole - 1):
        FILES.refused(*lines, "full.gpkg", said=("full.gpkg", "cannot be written"), limit=full(size))


def test_the_same_lines_make_the_same_bytes():
    for name in ("once.gpkg", "twice.gpkg"):
        FILES.run("contour", surface(), "--levels", 95, 90, "--output", name, "--force")
    os.rename(FILES.path("once.gpkg"), FILES.path("kept"))
    os.rename(FILES.path("twice.gpkg"), FILES.path("once.gpkg"))
    FILES.run("contour", surface(), "--levels", 95, 90, "--output", "once.gpkg", "--force", "--threads", 1)
    assert open(FILES.path("kept"), "rb").read() == open(FILES.path("once.gpkg"), "rb").read()
    os.remove(FILES.path("kept"))


knotwork_testing.main(globals())
