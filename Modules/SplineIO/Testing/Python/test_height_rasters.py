# SPDX-License-Identifier: BSD-3-Clause
"""Heights of surfaces on rasters, read by a reader of our own of TIFF: in the middle of the cells to rounding, nowhere else, with place and reference
system; a terrain comes back from GeoTIFF to GeoTIFF; and what cannot be written, as one line. Skipped without GDAL."""
import os
import resource
import signal

import numpy as np

import geotiff_files
import knotwork
import knotwork_testing

if not os.path.exists(os.path.join(knotwork_testing.BIN_DIR, "..", "libexec", "knotwork", "knotwork-gdal.so")):
    knotwork_testing.skip("knotwork-gdal.so is not built: GDAL is missing")

FILES = knotwork_testing.Files("height_rasters")
CORNER = (432000.0, 5510040.0)


def height(x, y):
    """Of degree two in both: a fit of that degree has it exactly."""
    u, v = (x - CORNER[0]) / 50, (y - CORNER[1]) / 40
    return 300 + 20 * u - 10 * v + 5 * u * v + 3 * u**2 - 2 * v**2


def terrain(x, y):
    return 300 + 20 * np.sin((x - CORNER[0]) / 25) * np.cos((y - CORNER[1]) / 20) + 2 * np.sin((x + y) / 6)


def fit(name, function, rows=60, columns=80, tolerance=1e-6, degree=2, epsg=25832, **place):
    place = dict(corner=CORNER, **place)
    x, y = geotiff_files.middles(rows, columns, **place)
    geotiff_files.write(FILES.path("dem.tif"), function(x, y), epsg=epsg, **place)
    return FILES.report("fit", "dem.tif", "--degree", degree, "--tolerance", tolerance, "--output", name)


def places(name):
    values, (x0, dx, y0, dy), tags = geotiff_files.read(FILES.path(name))
    c, r = np.meshgrid(np.arange(values.shape[1]) + 0.5, np.arange(values.shape[0]) + 0.5)
    return values, x0 + c * dx, y0 + r * dy, tags


def test_heights_are_those_in_the_middle_of_cells():
    fit("surface.vtu", height)
    # of the surface: the middles of the outermost cells of dem.tif
    box = (CORNER[0] + 0.5, CORNER[0] + 79.5, CORNER[1] - 59.5, CORNER[1] - 0.5)
    for size in (0.25, 1.0, 3.7):
        report = FILES.report("raster", "surface.vtu", "--cell-size", size, "--double-precision", "--output", "out.tif")
        values, x, y, tags = places("out.tif")
        assert geotiff_files.epsg(tags) == (25832, False) and report["reference_system"] == "EPSG:25832" and tags[42113] == "-9999", tags
        has = values != -9999
        eps = 1e-6
        inside = (x > box[0] - eps) & (x < box[1] + eps) & (y > box[2] - eps) & (y < box[3] + eps)
        assert np.array_equal(has, inside) and has.sum() == report["cells_with_data"], (size, has.sum(), inside.sum())
        assert (~has).sum() == report["cells_without_data"] and values.shape == (report["rows"], report["columns"])
        # half a cell of 0.25 along x would be 0.05; the fit is exact but for rounding of coordinates of 5.5e6
        assert np.abs(values - height(x, y))[has].max() < 1e-5, (size, np.abs(values - height(x, y))[has].max())
        assert report["lowest"] == values[has].min() and report["highest"] == values[has].max()
        corners = np.array([x[0, 0] - size / 2, y[0, 0] + size / 2]) / size
        assert np.abs(corners - np.round(corners)).max() < 1e-6, corners  # whole multiples of the size


def test_rasters_of_one_size_are_one_raster():
    fit("surface.vtu", height)
    report = FILES.report("raster", "surface.vtu", "--cell-size", 1, "--output", "out.tif")
    values, x, y, _ = places("out.tif")
    assert (x[0, 0] - 0.5, y[0, 0] + 0.5) == CORNER and values.shape == (60, 80) and report["cells_without_data"] == 0
    assert values.dtype == np.float32 and np.abs(values - height(x, y)).max() < 300 * 2.0**-23
    FILES.run("raster", "surface.vtu", "--cell-size", 1, "--corner", 0.5, 0.5, "--no-data", 7, "--output", "moved.tif", "--force")
    values, x, y, tags = places("moved.tif")
    assert x[0, 0] == CORNER[0] + 1 and tags[42113] == "7" and np.abs(values - height(x, y))[values != 7].max() < 1e-4


def test_a_terrain_comes_back():
    """GeoTIFF to fit to GeoTIFF: within the tolerance and rounding to single precision, at the same cells; pixel-is-point files too."""
    for is_point in (False, True):
        tolerance = 0.05
        report = fit("terrain.vtu", terrain, rows=90, columns=120, tolerance=tolerance, is_point=is_point)
        assert report["within_tolerance"], report
        corner = (-0.5, -0.5) if is_point else (0, 0)
        FILES.run("raster", "terrain.vtu", "--cell-size", 1, "--corner", *corner, "--output", "back.tif", "--force")
        values, x, y, tags = places("back.tif")
        expected_x, expected_y = geotiff_files.middles(90, 120, corner=CORNER, is_point=is_point)
        assert np.array_equal(x, expected_x) and np.array_equal(y, expected_y), is_point
        assert np.abs(values - terrain(x, y)).max() <= tolerance + 300 * 2.0**-24 and geotiff_files.epsg(tags)[0] == 25832


def test_tiles_are_one_raster():
    x, y = geotiff_files.middles(120, 160, corner=CORNER)
    geotiff_files.write(FILES.path("dem.tif"), terrain(x, y).astype("f4"), corner=CORNER)
    FILES.run("tiles", "dem.tif", "--points-per-tile", 5000, "--output", "dem.tiles", "--force")
    report = FILES.report("fit", "dem.tiles", "--tolerance", 0.05, "--output", "tiles.vtpc")
    assert report["tiles"] == 4 and report["within_tolerance"], report
    report = FILES.report("raster", "tiles.vtpc", "--cell-size", 0.4, "--output", "tiles.tif")
    values, u, v, tags = places("tiles.tif")
    assert geotiff_files.epsg(tags) == (25832, False)
    inside = (u > x.min()) & (u < x.max()) & (v > y.min()) & (v < y.max())
    assert np.array_equal(values != -9999, inside)  # no gap between tiles
    # between the points the terrain's second derivatives, 0.09 at most, allow a tenth more than at them
    assert np.abs(values - terrain(u, v))[inside].max() < 0.2
    FILES.run("raster", "tiles.vtpc", "--cell-size", 1, "--output", "tiles.tif", "--force")
    values, u, v, _ = places("tiles.tif")
    assert np.array_equal(u, x) and np.abs(values - terrain(u, v)).max() < 0.05 + 1e-4


def test_trimmed_faces_have_no_data_outside():
    fit("surface.vtu", height)
    rng = np.random.default_rng(1)
    x, y = rng.uniform(1, 79, 20000) + CORNER[0], CORNER[1] - rng.uniform(1, 59, 20000)
    r = np.hypot(x - CORNER[0] - 40, y - CORNER[1] + 30)
    points = np.c_[x, y, height(x, y)][(r < 25) & (r > 8)]
    np.savetxt(FILES.path("ring.xyz"), points, fmt="%.17g")
    for name in ("face.vtu", "face.step"):
        FILES.run("crop", "surface.vtu", "ring.xyz", "--output", name, "--force")
        FILES.run("raster", name, "--cell-size", 0.5, "--output", "ring.tif", "--force", "--crs", "EPSG:25832")
        values, u, v, _ = places("ring.tif")
        r = np.hypot(u - CORNER[0] - 40, v - CORNER[1] + 30)
        has = values != -9999
        assert has[(r > 9.5) & (r < 23.5)].all() and not has[(r < 6.5) | (r > 26.5)].any(), name
        assert np.abs(values - height(u, v))[has].max() < 1e-3, name


def test_what_cannot_be_written_is_one_line_and_leaves_nothing():
    report = fit("plain.vtu", height, epsg=None)
    assert report["within_tolerance"]
    assert FILES.report("raster", "plain.vtu", "--cell-size", 1, "--output", "out.tif")["reference_system"] == ""
    assert geotiff_files.epsg(places("out.tif")[3])[0] is None
    for name, shape in (("sphere", "sphere-surface"), ("box", "cube")):
        FILES.run("source", "--shape", shape, "--output", name + ".vtu", "--force")
    for words, said in ((("sphere.vtu", "--cell-size", 1), ("sphere.vtu", "no height function")), (("box.vtu", "--cell-size", 1), ("no surface",)),
                        (("plain.vtu",), ("size of cells is 0",)), (("plain.vtu", "--cell-size", 1e-9), ("MaximumCells", "larger CellSize")),
                        (("plain.vtu", "--cell-size", 0.1, "--maximum-cells", 1000), ("790 x 590", "1000")),
                        (("plain.vtu", "--cell-size", 1e-300), ("MaximumCells",)), (("plain.vtu", "--cell-size", 1e9), ("no cell has its middle",)),
                        (("plain.vtu", "--cell-size", 1, "--crs", "EPSG:0"), ("EPSG:0", "unknown"))):
        FILES.refused("raster", *words, "--output", "bad.tif", said=said)
    FILES.refused("raster", "plain.vtu", "--cell-size", 1, "--output", "no/folder/bad.tif", said=("no/folder",))
    FILES.refused("raster", "plain.vtu", "--cell-size", 1, "--output", "bad.vti", said=("bad.vti", ".tif"))
    value = places("out.tif")[0][3, 5]
    FILES.refused("raster", "plain.vtu", "--cell-size", 1, "--no-data", float(value), "--output", "bad.tif", said=("NoData",))

    def full(size):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        return limit

    FILES.run("raster", "plain.vtu", "--cell-size", 0.1, "--output", "whole.tif", "--force")
    whole = os.path.getsize(FILES.path("whole.tif"))
    for size in (0, 100, whole // 2, whole - 1):
        FILES.refused("raster", "plain.vtu", "--cell-size", 0.1, "--output", "full.tif", said=("full.tif", "cannot be written"), limit=full(size))


def test_python_writes_them_and_threads_do_not_matter():
    fit("terrain.vtu", terrain, tolerance=0.05)
    writer = knotwork.vtkGeoTIFFWriter()
    writer.SetInputDataObject(knotwork.read(FILES.path("terrain.vtu")))
    writer.SetCellSize(0.5)
    writer.SetFileName(FILES.path("python.tif"))
    assert writer.Write() == 1
    FILES.run("raster", "terrain.vtu", "--cell-size", 0.5, "--threads", 1, "--output", "program.tif", "--force")
    assert open(FILES.path("python.tif"), "rb").read() == open(FILES.path("program.tif"), "rb").read()


knotwork_testing.main(globals())
