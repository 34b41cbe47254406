# SPDX-License-Identifier: BSD-3-Clause
"""Jobs started by mpirun: one, two and four processes write what one writes, and report it; what fails or is killed ends all."""
import contextlib
import glob
import json
import math
import os
import pathlib
import random
import shutil
import signal
import subprocess
import time

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (VTK_QUAD, VTK_TETRA, vtkCellArray, vtkPartitionedDataSetCollection,
                                           vtkPolyData, vtkUnstructuredGrid)
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkCleanPolyData, vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource
from vtkmodules.vtkIOParallelXML import vtkXMLPartitionedDataSetCollectionWriter
from vtkmodules.vtkIOXML import (vtkXMLGenericDataObjectReader, vtkXMLPartitionedDataSetCollectionReader, vtkXMLPolyDataWriter,
                                 vtkXMLUnstructuredGridWriter)

import knotwork_testing

# of a run, not of its result
OF_A_RUN = {"cpu_seconds", "peak_bytes", "peak_own_bytes", "ranks", "threads", "output", "input", "points", "report"}
MPIRUN = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--quiet", "-np"]


def path(name):
    return knotwork_testing.output(os.path.join("processes", name))


def run(processes, *arguments, expect=0):
    """What the program prints and says, by so many processes."""
    command = [knotwork_testing.PROGRAM, *map(str, arguments)]
    if processes > 1:
        command = [*MPIRUN, str(processes), *command]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120)
    assert done.returncode == expect, (processes, arguments, done.returncode, done.stdout, done.stderr)
    return done.stdout, done.stderr


def processes_of(mpirun):
    found = subprocess.run(["pgrep", "-P", str(mpirun.pid), "-x", "knotwork"], stdout=subprocess.PIPE, text=True)
    return [int(word) for word in found.stdout.split()]


def read(name):
    kind = vtkXMLPartitionedDataSetCollectionReader if name.endswith(".vtpc") else vtkXMLGenericDataObjectReader
    reader = kind()
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutputDataObject(0)


def data_sets(data):
    if not isinstance(data, vtkPartitionedDataSetCollection):
        return [data]
    return [data.GetPartition(b, i) for b in range(data.GetNumberOfPartitionedDataSets()) for i in range(data.GetNumberOfPartitions(b))]


def assert_same(one, other, exact=True):
    """The same cells, points and arrays in the same order, bit for bit."""
    assert len(data_sets(one)) == len(data_sets(other))
    for a, b in zip(data_sets(one), data_sets(other)):
        assert (a is None) == (b is None)
        if a is None:
            continue
        assert a.GetClassName() == b.GetClassName() and a.GetNumberOfCells() == b.GetNumberOfCells()
        assert a.GetNumberOfPoints() == b.GetNumberOfPoints()
        for of in ("GetLines", "GetPolys") if isinstance(a, vtkPolyData) else ("GetCells",):
            if hasattr(a, of) and a.GetNumberOfCells() > 0:
                for array in ("GetOffsetsArray", "GetConnectivityArray"):
                    assert np.array_equal(*(vtk_to_numpy(getattr(getattr(d, of)(), array)()) for d in (a, b))), (of, array)
        if a.GetNumberOfPoints() > 0:
            assert np.array_equal(vtk_to_numpy(a.GetPoints().GetData()), vtk_to_numpy(b.GetPoints().GetData()))
        for of in ("GetPointData", "GetCellData", "GetFieldData"):
            left, right = getattr(a, of)(), getattr(b, of)()
            names = [left.GetArrayName(i) for i in range(left.GetNumberOfArrays())]
            assert names == [right.GetArrayName(i) for i in range(right.GetNumberOfArrays())], (of, names)
            for name in names:
                x, y = left.GetArray(name), right.GetArray(name)
                if x is not None:
                    assert np.array_equal(vtk_to_numpy(x), vtk_to_numpy(y), equal_nan=True), (of, name)
        for of in ("GetPointData", "GetCellData"):
            scalars = [getattr(d, of)().GetScalars() for d in (a, b)]
            assert [s and s.GetName() for s in scalars][0] == [s and s.GetName() for s in scalars][1]


def of_result(report):
    """A report, and those of parts in it, without what is of the run."""
    if isinstance(report, dict):
        return {k: of_result(v) for k, v in report.items() if k not in OF_A_RUN and not k.startswith(("rank_", "seconds"))}
    return [of_result(each) for each in report] if isinstance(report, list) else report


def assert_same_numbers(one, other):
    """Sums over cells and points are made in another order: equal but for 1e-12 of them."""
    left, right = (of_result(json.load(open(name))) for name in (one, other))
    assert list(left) == list(right), (left, right)
    for key, value in left.items():
        if isinstance(value, float):
            assert math.isclose(value, right[key], rel_tol=1e-12, abs_tol=1e-15), (key, value, right[key])
        else:
            assert value == right[key], (key, value, right[key])


def write(data, name):
    writer = vtkXMLPolyDataWriter() if isinstance(data, vtkPolyData) else vtkXMLUnstructuredGridWriter()
    writer.SetInputData(data)
    writer.SetFileName(name)
    writer.SetDataModeToBinary()
    writer.Write()
    return name


def grid_of(points, cells, kind):
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=float), deep=True))
    grid = vtkUnstructuredGrid()
    grid.SetPoints(places)
    for cell in cells:
        grid.InsertNextCell(kind, len(cell), cell)
    return grid


def quads(n, seed, lift=0.0, shake=0.55):
    """n x n quadrilaterals whose inner points are shaken, so that some are folded; `lift` bends the right half out of the plane."""
    random_numbers = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0))
    for places in (x, y):
        places[1:-1, 1:-1] += random_numbers.uniform(-shake, shake, (n - 1, n - 1))
    z = lift * np.maximum(0, x - n / 2) ** 2
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    at = lambda i, j: j * (n + 1) + i  # noqa: E731
    cells = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(n) for i in range(n)]
    return grid_of(points, cells, VTK_QUAD)


def cloud(n, seed):
    points = vtkPoints()
    points.SetDataTypeToDouble()
    places = np.random.default_rng(seed).uniform(0.05, 0.95, (n, 3))
    points.SetData(numpy_to_vtk(places, deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    weights = numpy_to_vtk(np.arange(float(n)), deep=True)
    weights.SetName("Given")
    data.GetPointData().SetScalars(weights)
    return data


def surface():
    """A height field over the unit square."""
    name = path("surface.vtu")
    if not os.path.exists(name):
        rows = np.stack(np.meshgrid(np.linspace(0, 1, 30), np.linspace(0, 1, 30)), axis=-1).reshape(-1, 2)
        heights = 0.3 * np.sin(5 * rows[:, 0]) * np.cos(4 * rows[:, 1])
        np.savetxt(path("surface.xyz"), np.column_stack([rows, heights]))
        run(1, "fit", path("surface.xyz"), "--tolerance", "0.01", "--output", name)
    return name


def write_collection(parts, name):
    writer = vtkXMLPartitionedDataSetCollectionWriter()
    writer.SetInputData(parts)
    writer.SetFileName(path(name))
    writer.Write()
    return path(name)


def compared(job, inputs, output, options=(), expect=0, others=()):
    """Runs a job by one, two and four processes; what they write and tell is the same."""
    kept = {}
    for processes in (1, 2, 4):
        stem = f"{job}-{processes}-"
        main = path(stem + output)
        report = path(stem + "report.json")
        extra = [word for option, name in others for word in (option, path(stem + name))]
        said = run(processes, job, *inputs, "--output", main, *extra, "--report", report, *options, expect=expect)
        kept[processes] = main, report, [path(stem + name) for _, name in others], said
        assert json.load(open(report)).get("ranks", 1) == processes
    for processes in (2, 4):
        assert_same(read(kept[1][0]), read(kept[processes][0]))
        assert_same_numbers(kept[1][1], kept[processes][1])
        for one, other in zip(kept[1][2], kept[processes][2]):
            if one.endswith(".csv"):
                rows = [list(csv_rows(name)) for name in (one, other)]
                assert rows[0][0] == rows[1][0] and len(rows[0]) == len(rows[1])
                for left, right in zip(*rows):
                    for a, b in zip(left, right):
                        assert a == b or math.isclose(float(a), float(b), rel_tol=1e-12), (a, b)
            else:
                assert_same(read(one), read(other))
        assert kept[1][3][0] == kept[processes][3][0], kept
    return json.load(open(kept[2][1]))


def csv_rows(name):
    import csv
    return csv.reader(open(name))


def test_validate_planes():
    """Folded and valid quadrilaterals: verdicts, bounds, witnesses and the table."""
    report = compared("validate", [write(quads(12, 1), path("quads.vtu"))], "quads.vtu", expect=3,
                      others=[("--witnesses", "witnesses.vtu"), ("--table", "table.csv")])
    assert report["invalid_cells"] > 3 and report["valid_cells"] > 100 and len(report["rank_cpu_seconds"]) == 2


def test_validate_surfaces_in_space():
    """A mesh that is flat at its left only is a surface in space, in the process that has the flat part too."""
    report = compared("validate", [write(quads(12, 2, lift=0.02, shake=0.2), path("bent.vtu"))], "bent.vtu", expect=0)
    assert report["invalid_cells"] == 0


def test_validate_splines():
    """Multi-patch splines: injectivity is proved of the whole, by one process."""
    name = path("ball.vtu")
    run(1, "source", "--shape", "solid-torus", "--output", name)
    report = compared("validate", [name], "torus.vtu", others=[("--table", "torus.csv")])
    assert report["verdict"] == "valid" and report["injective"].startswith("injective"), report
    collection = path("blocks.vtpc")
    run(1, "convert", name, "--output", collection)
    compared("validate", [collection], "blocks.vtpc")


def test_validate_overlap():
    """Two squares that overlap, in two processes: both cells are valid, the map is not injective."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 0), (1.5, 0.5, 0), (1.5, 1.5, 0), (0.5, 1.5, 0)]
    name = write(grid_of(points, [(0, 1, 2, 3), (4, 5, 6, 7)], VTK_QUAD), path("overlap.vtu"))
    report = compared("validate", [name], "overlap.vtu", expect=3, others=[("--witnesses", "overlap_places.vtu")])
    assert report["invalid_cells"] == 0 and report["injective"] == "not_injective"


def test_validate_numbered_elements():
    """Elements of a solver's mesh are named by their numbers in the file."""
    n = 5
    grid = [(x, y, z) for z in range(2) for y in range(2) for x in range(n + 1)]
    at = lambda x, y, z: x + (n + 1) * (y + 2 * z)  # noqa: E731
    cells = [(at(x, 0, 0), at(x + 1, 0, 0), at(x, 1, 0), at(x, 0, 1)) for x in range(n)]
    cells[3] = (cells[3][0], cells[3][2], cells[3][1], cells[3][3])
    name = write(grid_of(grid, cells, VTK_TETRA), path("tets.vtu"))
    mesh = path("tets.msh")
    run(1, "convert", name, "--output", mesh)
    report = compared("validate", [mesh], "tets.vtu", expect=3)
    assert len(report["reversed_elements"]) == 1


def test_points():
    """Evaluation, distances and warps of points; more processes than points too."""
    for count in (1000, 3):
        points = write(cloud(count, count), path(f"cloud{count}.vtp"))
        compared("evaluate", [surface(), points], "at.vtp", ["--derivatives", "1"])
        report = compared("evaluate", [surface(), points], "near.vtp", ["--mode", "probe"])
        assert report["number_of_points"] == count and report["max_distance"] > 0
        report = compared("distance", [points, surface()], "far.vtp", ["--tolerances", "0.1", "0.3"],
                          others=[("--class-table", "classes.csv")])
        assert report["points_measured"] == count
        compared("warp", [points, surface()], "warped.vtp")
    mesh = quads(9, 4)
    points = mesh.GetPoints()
    for i in range(points.GetNumberOfPoints()):
        x = points.GetPoint(i)
        points.SetPoint(i, x[0] / 9, x[1] / 9, 0)
    report = compared("warp", [write(mesh, path("mesh.vtu")), surface()], "mesh.vtu")
    assert report["number_of_cells"] == 81


def test_pieces():
    """A file in pieces is read by pieces and written in pieces; together they are the whole."""
    whole = write(quads(12, 1), path("whole.vtu"))
    pieces = path("pieces.pvtu")
    run(1, "convert", surface(), "--output", path("surface.pvtu"), "--pieces", "1")
    shutil.rmtree(path("divided"), ignore_errors=True)
    run(1, "validate", whole, "--injectivity", "off", "--output", path("verdicts.vtu"), "--report", path("serial.json"), expect=3)
    for count in (3, 5):
        run(1, "convert", whole, "--output", pieces, "--pieces", count)
        assert len(glob.glob(path("pieces/*.vtu"))) == count
        for processes in (1, 2, 4):
            written = path("verdicts.pvtu")
            report = path("pieces.json")
            run(processes, "validate", pieces, "--output", written, "--report", report, expect=3)
            serial, found = (json.load(open(name)) for name in (path("serial.json"), report))
            for key in ("verdict", "cells", "invalid_cells", "min_jacobian_lower"):
                assert serial[key] == found[key], (processes, key)
            assert math.isclose(serial["measure"], found["measure"], rel_tol=1e-12)
            assert found["injective"] == "not_injective" or found["injectivity_reason"], found
            parts = read(written)
            verdicts = vtk_to_numpy(parts.GetCellData().GetArray("JacobianVerdict"))
            assert np.array_equal(verdicts, vtk_to_numpy(read(path("verdicts.vtu")).GetCellData().GetArray("JacobianVerdict")))
            assert len(glob.glob(path("verdicts/*.vtu"))) == min(processes, count)


def test_damaged_pieces():
    """An index that is none, names nothing, what is not there, or what is no piece; a piece that is cut off."""
    whole = write(quads(4, 1), path("small.vtu"))
    run(1, "convert", whole, "--output", path("small.pvtu"), "--pieces", "2")
    text = open(path("small.pvtu")).read()
    damaged = path("damaged.pvtu")
    for content, words in (("", "no index of pieces"), (text[:len(text) // 2], "no index of pieces"), (text.replace("<Piece ", "<Peace "), "names none"),
                           (text.replace("small_1.vtu", "small_7.vtu"), "is not there"), (text.replace("small_1.vtu", "../small.pvtu"), "is no .vtu file"),
                           (text.replace("PUnstructuredGrid", "PPolyData"), "names none"), (text.replace("small/small_1.vtu", "cut.vtu"), "cut.vtu")):
        open(damaged, "w").write(content)
        open(path("cut.vtu"), "wb").write(open(path("small/small_1.vtu"), "rb").read()[:700])
        for processes in (1, 2):
            _, errors = run(processes, "validate", damaged, expect=1)
            lines = [line for line in errors.splitlines() if line.startswith("knotwork")]
            assert len(lines) == 1 and words in lines[0], (content[:40], errors)
    # pieces of an older index of the name go, what is not theirs stays
    run(1, "convert", whole, "--output", path("small.pvtu"), "--pieces", "1")
    assert os.listdir(path("small")) == ["small_0.vtu"]
    os.makedirs(path("others"), exist_ok=True)
    open(path("others/notes.txt"), "w").write("mine")
    _, errors = run(2, "validate", path("small.pvtu"), "--output", path("others.pvtu"), expect=1)
    assert "holds other files" in errors and os.listdir(path("others")) == ["notes.txt"]


def test_splines_in_pieces():
    """Patches of splines stay whole and become one grid again."""
    name = path("torus_patches.vtu")
    run(1, "source", "--shape", "solid-tube", "--output", name)
    run(1, "convert", name, "--output", path("patches.pvtu"), "--pieces", 3)
    again = path("again.vtu")
    run(1, "convert", path("patches.pvtu"), "--output", again)
    reports = []
    for one in (name, again):
        run(1, "validate", one, "--report", path("again.json"))
        reports.append(json.load(open(path("again.json"))))
    for key in ("verdict", "injective", "cells"):
        assert reports[0][key] == reports[1][key]
    assert math.isclose(reports[0]["measure"], reports[1]["measure"], rel_tol=1e-14)


def test_interfaces_between_pieces():
    """A piece has the definitions of its own patches, and what is stated of their sides; all pieces together what the whole has."""
    ball, stated = path("stated.vtu"), path("stated.pvtu")
    run(1, "source", "--shape", "ball", "--output", ball)
    grid = read(ball)
    rows = {(0, side, 1 + side, 0, 0, 0) for side in range(6)}  # the core with the blocks around it
    table = numpy_to_vtk(np.array(sorted(rows), dtype=np.int64), deep=True)
    table.SetName("KnotworkInterfaces")
    grid.GetFieldData().AddArray(table)
    write(grid, ball)
    run(1, "convert", ball, "--output", stated, "--pieces", 3)
    seen = set()
    for i in range(3):
        piece = read(path(f"stated/stated_{i}.vtu"))
        own = set(vtk_to_numpy(piece.GetCellData().GetArray("PatchId")))
        fields = piece.GetFieldData()
        assert set(vtk_to_numpy(fields.GetArray("KnotworkPatches"))[:, 0]) == own
        mine = {tuple(row) for row in vtk_to_numpy(fields.GetArray("KnotworkInterfaces"))}
        assert mine == {row for row in rows if row[0] in own or row[2] in own}
        seen |= own
    assert len(seen) == 7
    again = path("stated-again.vtu")
    run(1, "convert", stated, "--output", again)
    fields = read(again).GetFieldData()
    assert {tuple(row) for row in vtk_to_numpy(fields.GetArray("KnotworkInterfaces"))} == rows
    assert fields.GetArray("KnotworkInterfaces").GetNumberOfTuples() == len(rows)


def test_blocks():
    """Blocks of a collection: refined, cut out, tessellated; of other things a grid is refined by the first process."""
    for patches in ("blocks.vtpc", "ball.vtu"):
        if not os.path.exists(path(patches)):
            test_validate_splines()
    parts = vtkPartitionedDataSetCollection()
    for i in range(5):
        name = path(f"part{i}.vtu")
        run(1, "source", "--center", i, 0, 0, "--elements", 2 + i, 3, 1, "--output", name)
        parts.SetPartition(i, 0, read(name))
    write_collection(parts, "parts.vtpc")
    assert compared("refine", [path("parts.vtpc")], "parts.vtpc")["elements"] == 4 * 3 * (2 + 3 + 4 + 5 + 6)
    compared("extract", [path("parts.vtpc")], "swapped.vtpc", ["--swap-parameters"])
    compared("tessellate", [path("parts.vtpc")], "triangles.vtpc", ["--chordal-tolerance", "1e-3"])
    compared("refine", [path("ball.vtu")], "ball.vtu")


def mixed_grid():
    """A curve, a surface and a solid in one grid; the solid alone has a field that is not zero."""
    append = vtkAppendFilter()
    for i, shape in enumerate(("arc", "annulus-sector", "cube")):
        name = path(shape + ".vtu")
        run(1, "source", "--shape", shape, "--center", 3 * i, 0, 0, "--elements", 3, 2, 2, "--output", name)
        grid = read(name)
        grid.GetFieldData().Initialize()
        for array in ("PatchBasis", "ElementId"):
            grid.GetCellData().RemoveArray(array)
        grid.GetCellData().GetArray("PatchId").Fill(i)
        heat = numpy_to_vtk(np.full(grid.GetNumberOfPoints(), 20.0 if shape == "cube" else 0.0), deep=True)
        heat.SetName("Heat")
        grid.GetPointData().AddArray(heat)
        append.AddInputData(grid)
    append.Update()
    return write(append.GetOutput(), path("mixed.vtu"))


def test_parts_of_a_grid():
    """A grid is tessellated by parts, whose points and cells are those of the whole, in one file and in pieces."""
    if not os.path.exists(path("ball.vtu")):
        test_validate_splines()
    run(1, "source", "--shape", "torus-surface", "--elements", 5, 3, 1, "--output", path("torus.vtu"))
    for name in (path("ball.vtu"), path("torus.vtu"), mixed_grid()):
        for options in ((), ("--splitting", 1)):
            compared("tessellate", [name], "faces.vtp", ["--chordal-tolerance", "1e-2", *options])
            compared("tessellate", [name], "cells.vtu", ["--chordal-tolerance", "1e-2", "--cells", "volume", *options])
    words = ["tessellate", path("torus.vtu"), "--chordal-tolerance", "1e-3", "--force", "--output"]
    run(1, *words, path("whole.vtp"))
    run(3, *words, path("torus-pieces.pvtp"), "--report", path("pieces.json"))
    whole = read(path("whole.vtp"))
    points = vtk_to_numpy(whole.GetPoints().GetData())
    seen, cells = set(), 0
    for i in range(3):
        piece = read(path(f"torus-pieces/torus-pieces_{i}.vtp"))
        ids = vtk_to_numpy(piece.GetPointData().GetArray("GlobalPointIds"))
        assert np.array_equal(vtk_to_numpy(piece.GetPoints().GetData()), points[ids])
        own = vtk_to_numpy(piece.GetPolys().GetConnectivityArray())
        corners = vtk_to_numpy(whole.GetPolys().GetConnectivityArray())
        first = vtk_to_numpy(whole.GetPolys().GetOffsetsArray())[cells]
        assert np.array_equal(ids[own], corners[first:first + len(own)])
        seen |= set(ids)
        cells += piece.GetNumberOfCells()
        assert 0.25 < piece.GetNumberOfCells() / whole.GetNumberOfCells() < 0.42  # 15 elements of different size
    report = json.load(open(path("pieces.json")))
    assert cells == whole.GetNumberOfCells() == report["number_of_cells"]
    assert len(seen) == whole.GetNumberOfPoints() == report["number_of_points"]


def test_contours_and_extrema():
    """Features of patches in blocks: levels and tolerances are those of the whole, components and clusters are counted on; more processes than blocks too."""
    chosen = np.random.default_rng(11)
    for count in (5, 2):
        parts = vtkPartitionedDataSetCollection()
        for i in range(count):
            places = chosen.uniform(0, 1, (400, 2)) + (i, 0)
            heights = (1 + 0.3 * i) * np.sin(5 * places[:, 0]) * np.cos(6 * places[:, 1])
            np.savetxt(path("waves.xyz"), np.column_stack([places, heights]))
            run(1, "fit", path("waves.xyz"), "--output", path("waves.vtu"), "--tolerance", "0.05")
            parts.SetPartition(i, 0, read(path("waves.vtu")))
        waves = write_collection(parts, f"waves{count}.vtpc")
        report = compared("contour", [waves], f"{count}.vtp", ["--number", "7"],
                          others=[("--table", "levels.csv"), ("--undecided", "undecided.vtp")] if count == 5 else [("--table", "levels.csv")])
        assert len(report["levels"]) == 7 and report["components"] > 7 and report["tolerance"] > 0
        compared("contour", [waves], f"curves{count}.vtu", ["--number", "5"])
        report = compared("extrema", [waves], f"points{count}.vtp", others=[("--boxes", "boxes.vtp"), ("--table", "counts.csv")])
        assert report["minima"] > count and report["proved"]
    # of a grid that is no collection
    compared("contour", [path("waves.vtu")], "one.vtp")
    compared("extrema", [path("waves.vtu")], "one.vtp")


def sides(name, width, bulge):
    """The four curves of a rectangle whose lower side is a parabola."""
    corners = [(0.0, 0.0), (width, 0.0), (width, 1.0), (0.0, 1.0)]
    curves = []
    for i, (begin, end) in enumerate(zip(corners, corners[1:] + corners[:1])):
        middle = [0.5 * (a + b) for a, b in zip(begin, end)]
        middle[1] += bulge if i == 0 else 0.0
        curves.append({"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "control_points": [begin, middle, end]})
    with open(path(name + ".json"), "w", encoding="utf-8") as stream:
        json.dump({"curves": curves}, stream)
    run(1, "convert", path(name + ".json"), "--output", path(name + ".vtu"), "--force")
    return read(path(name + ".vtu"))


def test_domains():
    """Blocks with four curves each are domains: a map each, of numbers that are those of all."""
    parts = vtkPartitionedDataSetCollection()
    for i, bulge in enumerate((0.3, -0.5, 0.9)):
        parts.SetPartition(i, 0, sides(f"sides{i}", 1.0 + 0.5 * i, bulge))
    domains = write_collection(parts, "domains.vtpc")
    few = ("--metric-samples", "21")
    report = compared("parameterize", [domains], "maps.vtu", few, others=[("--first-map", "first.vtu")])
    assert report["patches"] == 3 and report["verdict"] == "valid" and report["injective"] == "injective"
    maps = read(path("parameterize-4-maps.vtu"))
    assert set(vtk_to_numpy(maps.GetCellData().GetArray("PatchId"))) == {0, 1, 2}
    alone = []
    for i in range(3):
        run(1, "parameterize", path(f"sides{i}.vtu"), *few, "--output", path("one.vtu"), "--table", path("one.csv"), "--report", path("one.json"), "--force")
        with open(path("one.json"), encoding="utf-8") as stream:
            alone.append(json.load(stream))
    assert math.isclose(report["area"], sum(one["area"] for one in alone), rel_tol=1e-12)
    assert report["min_jacobian_lower"] == min(one["min_jacobian_lower"] for one in alone)
    assert report["functions"] == sum(one["functions"] for one in alone)
    run(2, "parameterize", domains, *few, "--output", path("two.vtu"), "--table", path("two.csv"))
    rows = list(csv_rows(path("two.csv")))
    assert rows[0][0] == "Domain" and {row[0] for row in rows[1:]} == {"0", "1", "2"}
    assert [row[1:] for row in rows if row[0] in ("Domain", "2")] == list(csv_rows(path("one.csv")))
    # one domain is for the first process, with a curve a block, too
    compared("parameterize", [path("sides1.vtu")], "one.vtu", few)
    # nor is one that has a layout divided, though its eight curves are in two blocks of four
    places = [(x, y) for y in (0.0, 1.0, 2.0) for x in (0.0, 1.0, 2.0)]
    write(grid_of([(x, y, 0.0) for x, y in places], [(i, i + 1, i + 4, i + 3) for i in (0, 1, 3, 4)], VTK_QUAD), path("layout.vtu"))
    around = [0, 1, 2, 5, 8, 7, 6, 3]
    lines = [{"degree": 1, "knots": [0, 0, 1, 1], "control_points": [places[a], places[b]]} for a, b in zip(around, around[1:] + around[:1])]
    halves = vtkPartitionedDataSetCollection()
    for i in range(2):
        with open(path("half.json"), "w", encoding="utf-8") as stream:
            json.dump({"curves": lines[4 * i:4 * i + 4]}, stream)
        run(1, "convert", path("half.json"), "--output", path("half.vtu"), "--force")
        halves.SetPartition(i, 0, read(path("half.vtu")))
    report = compared("parameterize", [write_collection(halves, "halves.vtpc")], "patches.vtu", (*few, "--layout", path("layout.vtu")))
    assert report["patches"] == 4 and math.isclose(report["area"], 4.0, rel_tol=1e-12)
    # what fails in a block names it
    parts.SetPartition(1, 0, sides("sides3", 1.0, 0.0))
    parts.SetPartition(2, 0, sides("sides4", float("1e-300"), 0.0))
    _, errors = run(2, "parameterize", write_collection(parts, "broken.vtpc"), "--output", path("never.vtu"), "--quiet", expect=1)
    assert "block 2" in errors and not os.path.exists(path("never.vtu")), errors


def box_mesh(centre, size):
    """Twelve triangles, seen from outside."""
    source, triangles, clean = vtkCubeSource(), vtkTriangleFilter(), vtkCleanPolyData()
    source.SetCenter(*centre)
    source.SetXLength(size)
    clean.SetInputConnection(source.GetOutputPort())
    triangles.SetInputConnection(clean.GetOutputPort())
    triangles.Update()
    mesh = vtkPolyData()
    mesh.SetPoints(triangles.GetOutput().GetPoints())
    mesh.SetPolys(triangles.GetOutput().GetPolys())
    return mesh


def wave_mesh():
    n = 9
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    at = np.arange(n * n).reshape(n, n)
    corners = [each.ravel() for each in (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1])]
    grid = grid_of(np.c_[x.ravel(), y.ravel() + 10, (0.2 * np.sin(5 * x) * np.cos(3 * y)).ravel()], [], VTK_QUAD)
    mesh = vtkPolyData()
    mesh.SetPoints(grid.GetPoints())
    cells = vtkCellArray()
    for a, b, c, d in zip(*corners):
        cells.InsertNextCell(3, (a, b, c))
        cells.InsertNextCell(3, (a, c, d))
    mesh.SetPolys(cells)
    return mesh


def test_trimmed_parts():
    """Meshes in blocks become the faces of one model: two solids, and a sheet of free form."""
    parts = vtkPartitionedDataSetCollection()
    for i, mesh in enumerate((box_mesh((0, 0, 0), 1), wave_mesh(), box_mesh((5, 0, 0), 2))):
        parts.SetPartition(i, 0, mesh)
    meshes = write_collection(parts, "meshes.vtpc")
    report = compared("trim", [meshes], "faces.vtu", others=[("--triangles", "faces.vtp"), ("--curves", "curves.vtu")])
    assert report["faces"] == 13 and report["planes"] == 12 and report["free_faces"] == 1 and report["verdict"] == "valid", report
    assert [part["faces"] for part in report["parts"]] == [6, 1, 6] and not report["analytic"]
    assert report["control_points"] == sum(part["control_points"] for part in report["parts"])
    assert report["max_deviation"] == max(part["max_deviation"] for part in report["parts"])
    blocks = vtk_to_numpy(read(path("trim-4-faces.vtp")).GetCellData().GetArray("Block"))
    assert set(blocks) == {0, 1, 2}
    assert len(np.unique(vtk_to_numpy(read(path("trim-4-faces.vtu")).GetCellData().GetArray("FaceId")))) == 13
    texts = []
    for processes in (1, 2):
        run(processes, "trim", meshes, "--output", path("faces.step"), "--report", path("step.json"), "--force")
        with open(path("faces.step"), encoding="latin-1") as stream:
            texts.append([line for line in stream if not line.startswith("FILE_NAME")])
        with open(path("step.json"), encoding="utf-8") as stream:
            assert json.load(stream)["brep_valid"]
    assert texts[0] == texts[1]
    assert sum("MANIFOLD_SOLID_BREP" in line for line in texts[0]) == 2
    # one mesh is for the first process
    report = compared("trim", [write(box_mesh((0, 0, 0), 1), path("box.vtp"))], "box.vtu")
    assert report["faces"] == 6 and "parts" not in report
    # what fails in a block names it, and nothing is written
    parts.SetPartition(2, 0, cloud(5, 3))
    broken = write_collection(parts, "broken_meshes.vtpc")
    _, errors = run(2, "trim", broken, "--output", path("never.step"), "--quiet", expect=1)
    assert "block 2" in errors and not os.path.exists(path("never.step")), errors
    parts.SetPartition(2, 1, box_mesh((0, 5, 0), 1))
    _, errors = run(2, "trim", write_collection(parts, "pieces.vtpc"), "--output", path("never.step"), "--quiet", expect=1)
    assert "block 2 has several pieces" in errors, errors
    _, errors = run(1, "trim", meshes, "--output", path("never.step"), "--table", path("never.csv"), expect=1)
    assert "--table" in errors and not os.path.exists(path("never.csv")), errors


def write_pieces(name, rows, ends):
    """Points as a .pvtp of polydata, which end at these rows."""
    files = []
    for begin, end in zip(ends[:-1], ends[1:]):
        part = vtkPolyData()
        points = vtkPoints()
        points.SetDataTypeToDouble()
        points.SetData(numpy_to_vtk(rows[begin:end].copy(), deep=True))
        part.SetPoints(points)
        os.makedirs(path(f"{name}-pieces"), exist_ok=True)
        files.append(write(part, path(f"{name}-pieces/part{len(files)}.vtp")))
    with open(path(f"{name}.pvtp"), "w") as index:
        index.write('<VTKFile type="PPolyData" version="0.1"><PPolyData GhostLevel="0"><PPoints>'
                    '<PDataArray type="Float64" NumberOfComponents="3"/></PPoints>' +
                    "".join(f'<Piece Source="{file}"/>' for file in files) + "</PPolyData></VTKFile>")
    return path(f"{name}.pvtp")


def test_memory_of_fits():
    """Each of two processes holds half of the points: at most 0.6 of what one holds, beside what the program is without any."""
    places = np.random.default_rng(7).uniform(0, 1, (2000000, 3))
    places[:, 2] = 0.1 * np.sin(9 * places[:, 0]) * np.cos(7 * places[:, 1]) + 0.002 * places[:, 2]
    held = {}
    for name, rows in (("few", places[:4000]), ("many", places)):
        cloud = write_pieces(name, rows, (0, len(rows) // 2, len(rows)))
        for processes in (1, 2):
            run(processes, "fit", cloud, "--tolerance", "0.004", "--output", path("cloud.vtu"), "--report", path("cloud.json"), "--threads", "1")
            report = json.load(open(path("cloud.json")))
            assert report["points"] == len(rows)
            held[name, processes] = max(report["rank_peak_bytes"]) if processes > 1 else report["peak_bytes"]
    alone, each = (held["many", processes] - held["few", processes] for processes in (1, 2))
    assert alone > 50 * len(places), "the points are what is held"
    assert each <= 0.6 * alone, (each, alone)
    for name in glob.glob(path("many*")):
        shutil.rmtree(name) if os.path.isdir(name) else os.remove(name)


def test_fits():
    """One set of points is fitted by several processes together, the fit of one to the last bit; what needs all points is done by the first."""
    chosen = np.random.default_rng(17)
    places = chosen.uniform(0, 1, (20000, 2))
    heights = 0.2 * np.sin(17 * places[:, 0]) * np.cos(15 * places[:, 1]) + chosen.uniform(-0.003, 0.003, len(places))
    for i in range(20):
        heights[1000 * i] += 0.2
    data = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.column_stack([places, heights]), deep=True))
    data.SetPoints(points)
    for name, values in (("Temperature", chosen.uniform(0, 1, len(places))), ("Weight", places[:, 0] > 0.9)):
        array = numpy_to_vtk(np.asarray(values, float), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    write(data, path("hills.vtp"))
    options = ["--tolerance", "0.006", "--maximum-iterations", "5"]
    others = [("--table", "iterations.csv"), ("--points", "hills.vtp"), ("--elements", "elements.vtp")]
    report = compared("fit", [path("hills.vtp")], "hills.vtu", [*options, "--field", "Temperature", "--significant-array", "Weight",
                                                                "--element-features"], others=others)
    assert report["points"] == len(places) and report["functions"] > 300 and report["significant_points"] > 1000
    compared("fit", [path("hills.vtp")], "thb.vtu", [*options, "--space", "thb", "--method", "mba", "--degree", "3"])
    start = path("fit-1-thb.vtu")
    compared("fit", [path("hills.vtp"), "--start", start], "again.vtu", options)
    for asked in (["--find-outliers"], ["--side", "above"], ["--parameterization", "computed", "--correct-parameters"],
                  ["--feature-grid-size", "4"]):
        report = compared("fit", [path("hills.vtp")], "whole.vtu", [*options[:-1], "2", *asked], others=[("--points", "whole.vtp")])
    # pieces are read and written by pieces; the second one has no points
    run(1, "fit", path("hills.vtp"), "--output", path("one.vtu"), *options)
    write_pieces("hills", np.column_stack([places, heights]), (0, 7000, 7000, 20000))
    run(3, "fit", path("hills.pvtp"), "--output", path("three.vtu"), "--points", path("three.pvtp"), "--report", path("three.json"), *options)
    assert_same(read(path("one.vtu")), read(path("three.vtu")))
    report = json.load(open(path("three.json")))
    assert report["points"] == 20000 and report["largest_tolerance"] == 0.006
    found = [read(name) for name in sorted(glob.glob(path("three/*.vtp")))]
    assert sum(part.GetNumberOfPoints() for part in found) == 20000
    assert max(np.abs(vtk_to_numpy(part.GetPointData().GetArray("Distance"))).max() for part in found if part.GetNumberOfPoints() > 0) > 0.1
    for asked, words in ((["--find-outliers"], "FindOutliers"), (["--side", "below"], "Side")):
        _, said = run(3, "fit", path("hills.pvtp"), "--output", path("not.vtu"), *asked, expect=1)
        assert said.count("\n") == 1 and "spread over 2 of 3 processes" in said and words in said, said
    # a bad point of one of them, and a closed object, end it in all
    np.savetxt(path("bad.xyz"), np.vstack([np.column_stack([places, heights]), [0.5, 0.5, 1e200]]))
    _, said = run(2, "fit", path("bad.xyz"), "--output", path("not.vtu"), expect=1)
    assert said.count("\n") == 1 and "process 1 of 2" in said, said
    sphere = chosen.normal(0, 1, (20000, 3))
    np.savetxt(path("sphere.xyz"), sphere / np.linalg.norm(sphere, axis=1)[:, None])
    _, said = run(2, "fit", path("sphere.xyz"), "--output", path("not.vtu"), expect=1)
    assert said.count("\n") == 1 and "in layers over x and y" in said and "around point" not in said, said
    assert not os.path.exists(path("not.vtu"))


def test_tiles():
    """Tiles of a cloud are fitted by several processes: the same surface, bit for bit, and a run that was killed goes on."""
    chosen = np.random.default_rng(5)
    places = chosen.uniform(0, 1, (30000, 2))
    heights = 0.2 * np.sin(7 * places[:, 0]) * np.cos(5 * places[:, 1]) + chosen.normal(0, 0.003, len(places))
    np.savetxt(path("terrain.xyz"), np.column_stack([places, heights]))
    run(1, "tiles", path("terrain.xyz"), "--output", path("terrain.tiles"), "--tile-size", "0.34")
    options = ["--tolerance", "0.012", "--maximum-iterations", "6"]
    for output in ("terrain.vtpc", "terrain.vtu"):
        report = compared("fit", [path("terrain.tiles")], output, options, others=[("--table", "terrain.csv")])
        assert report["tiles"] > 5 and report["max_slope_jump"] < 1e-10
        fitted = report["rank_tiles"]
        assert sum(fitted) == report["tiles"] and max(fitted) - min(fitted) <= 1, fitted
    kept = path("kept")
    command = [*MPIRUN, "2", knotwork_testing.PROGRAM, "fit", path("terrain.tiles"), "--resume", kept, "--output",
               path("resumed.vtpc"), "--report", path("resumed.json"), *options]
    for _ in range(5):  # a run may be done before it is killed
        for folder in (kept, path("resumed")):  # of an earlier test
            shutil.rmtree(folder, ignore_errors=True)
        pathlib.Path(path("resumed.vtpc")).unlink(missing_ok=True)
        process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        while len(glob.glob(os.path.join(kept, "fitted-*.vtu"))) < 3 and process.poll() is None:
            time.sleep(0.01)
        for found in processes_of(process)[:1]:
            os.kill(found, signal.SIGKILL)
        process.communicate(timeout=60)
        if process.returncode != 0:
            break
    assert process.returncode != 0 and not os.path.exists(path("resumed.vtpc"))
    run(2, *command[len(MPIRUN) + 2:])
    assert_same(read(path("resumed.vtpc")), read(path("fit-1-terrain.vtpc")))
    assert json.load(open(path("resumed.json")))["tiles_resumed"] >= 3


def test_failures():
    """What fails in one process or in all is one line of the program, and nothing is written."""
    before = set(os.listdir(path("")))
    for words, sentence in ((["validate", path("missing.vtu"), "--output", path("none.vtu")], "missing.vtu"),
                            (["evaluate", surface(), write(cloud(5, 1), path("five.vtp")), "--patch-id", "7", "--output",
                              path("none.vtp")], "PatchId 7"),
                            (["warp", write(cloud(5, 1), path("five.vtp")), path("five.vtp"), "--output", path("none.vtp")], "is required")):
        for processes in (2, 4):
            _, errors = run(processes, *words, expect=1)
            lines = [line for line in errors.splitlines() if line.startswith("knotwork")]
            assert len(lines) == 1 and sentence in lines[0], errors
    # the last point alone is outside: its process tells
    points = cloud(8, 2)
    points.GetPoints().SetPoint(7, 5.0, 5.0, 0.0)
    outside = write(points, path("outside.vtp"))
    for processes in (2, 4):
        _, errors = run(processes, "evaluate", surface(), outside, "--output", path("none.vtp"), expect=1)
        lines = [line for line in errors.splitlines() if line.startswith("knotwork")]
        assert len(lines) == 1 and lines[0].count(f"process {processes - 1} of {processes}") == 1, errors
    _, errors = run(2, "source", "--output", path("none.vtu"), expect=2)
    assert "validate" in errors and "without mpirun" in errors
    assert not any(name.startswith(("none", ".knotwork")) for name in set(os.listdir(path(""))) - before)


def kill_at_ten_times(job, *arguments, output):
    """One of two processes is killed at ten times of a run: an end within seconds, one line, nothing left behind.

    A process that is killed between the last file and its own end leaves the whole output.
    """
    command = [*MPIRUN, "2", knotwork_testing.PROGRAM, job, *arguments, "--output", output]
    begin = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    whole = time.monotonic() - begin
    undisturbed = open(output, "rb").read()
    os.remove(output)
    before = set(os.listdir(path("")))
    chosen = random.Random(23)
    killed = 0
    for i in range(10):
        wait = whole * (i + 0.5) / 10
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(wait)
        found = processes_of(process)
        if len(found) == 2:
            with contextlib.suppress(ProcessLookupError):  # it may have ended meanwhile
                os.kill(chosen.choice(found), signal.SIGKILL)
                killed += 1
        begin = time.monotonic()
        _, errors = process.communicate(timeout=60)
        if process.returncode == 0 or os.path.exists(output):  # it had done its work
            assert open(output, "rb").read() == undisturbed
            os.remove(output)
            continue
        assert len(found) == 2 and time.monotonic() - begin < 10, errors
        lines = [line for line in errors.splitlines() if line.startswith("knotwork")]
        assert len(lines) <= 1, errors
        assert set(os.listdir(path(""))) <= before, set(os.listdir(path(""))) - before
    assert killed >= 5


def test_killed_processes():
    """Jobs that divide cells or points, and a fit, whose processes wait for each other all the time."""
    points = path("many.vtp")
    write(cloud(100000, 9), points)
    kill_at_ten_times("distance", points, surface(), "--kind", "closest", output=path("killed.vtp"))
    random_numbers = np.random.default_rng(11)
    x = random_numbers.uniform(0.0, 1.0, (200000, 2))
    z = np.sin(9.0 * x[:, 0]) * np.cos(7.0 * x[:, 1]) + random_numbers.normal(0.0, 1e-3, len(x))
    np.savetxt(path("hills.xyz"), np.column_stack([x, z]))
    kill_at_ten_times("fit", path("hills.xyz"), "--tolerance", "4e-3", output=path("killed.vtu"))


if not shutil.which("mpirun"):
    knotwork_testing.skip("there is no mpirun")
knotwork_testing.main(globals())
