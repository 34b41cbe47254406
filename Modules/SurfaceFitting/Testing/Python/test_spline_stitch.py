# SPDX-License-Identifier: BSD-3-Clause
"""Tiles fitted apart, stitched from Python and by the program; errors."""
import json

import knotwork
import knotwork_testing
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter


def height(x, y):
    return 0.2 * numpy.sin(3 * x) * numpy.cos(2 * y) + 0.3 * numpy.exp(-8 * (x - 1) ** 2 - 5 * (y - 0.9) ** 2)


def fitted_tile(column, row, seed):
    """Noisy points of one tile, fitted on its own."""
    random = numpy.random.default_rng(seed)
    points = random.uniform(size=(4000, 2)) + (column, row)
    z = height(points[:, 0], points[:, 1]) + random.normal(scale=2e-3, size=len(points))
    cloud = vtkPolyData()
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(numpy.column_stack((points, z)), deep=1))
    cloud.SetPoints(places)
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputData(cloud)
    fit.SetDomain(column, column + 1, row, row + 1)
    fit.SetTolerance(0.01)
    fit.Update()
    assert fit.GetOutputDataObject(0).GetNumberOfCells() > 1
    return fit.GetOutputDataObject(0)


TILES = [fitted_tile(i % 2, i // 2, i) for i in range(4)]


def stitched(**properties):
    made = knotwork.vtkSplineStitch()
    for tile in TILES:
        made.AddInputDataObject(tile)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    made.Update()
    return made


def numbers(made):
    table = made.GetOutputDataObject(2)
    return {table.GetColumnName(i): table.GetValue(0, i).ToDouble() for i in range(table.GetNumberOfColumns())}


def test_both_continuities():
    for continuity in (0, 1):
        found = numbers(stitched(Continuity=continuity))
        assert found["Tiles"] == 4 and found["Edges"] == 4, found
        assert 1e-3 < found["MaxJumpBefore"] < 0.05 and found["MaxJump"] < 1e-13, found
        assert found["MaxChange"] < 0.05, found
        assert (found["MaxSlopeJump"] < 1e-11) == (continuity == 1), found


def test_program():
    files = []
    for i, tile in enumerate(TILES):
        files.append(knotwork_testing.output(f"tile{i}.vtu"))
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetInputData(tile)
        writer.SetFileName(files[-1])
        writer.Write()
    output, report, edges = (knotwork_testing.output("stitched" + ending) for ending in (".vtu", ".json", ".csv"))
    done = knotwork_testing.run_program("stitch", *files, "--continuity", 1, "--output", output, "--report", report,
                                        "--edges", edges)
    assert done.returncode == 0, done.stderr
    with open(report) as file:
        found = json.load(file)
    expected = numbers(stitched())
    assert found["edges"] == 4 and found["tiles"] == 4 and found["continuity"] == 1 and found["seconds"] >= 0
    for key, name in (("max_jump_before", "MaxJumpBefore"), ("max_change", "MaxChange"), ("max_jump", "MaxJump"),
                      ("max_slope_jump", "MaxSlopeJump"), ("max_slope_jump_before", "MaxSlopeJumpBefore")):
        assert found[key] == expected[name], key
    with open(edges) as file:
        assert len(file.read().splitlines()) == 5
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(output)
    reader.Update()
    again = knotwork.vtkSplineStitch()
    again.SetInputConnection(reader.GetOutputPort())
    again.Update()
    assert numbers(again)["MaxJumpBefore"] < 1e-13 and numbers(again)["MaxChange"] < 1e-13, numbers(again)
    # given pairs are the same edges
    pairs = ["--pair", 0, 1, 1, 0, 0, "--pair", 0, 3, 2, 2, 0, "--pair", 1, 3, 3, 2, 0, "--pair", 2, 1, 3, 0, 0]
    done = knotwork_testing.run_program("stitch", *files, "--output", output, "--report", report, *pairs)
    assert done.returncode == 0, done.stderr
    with open(report) as file:
        assert json.load(file)["max_change"] == expected["MaxChange"]


def test_errors():
    made = knotwork.vtkSplineStitch()
    made.AddInputDataObject(TILES[0])
    made.AddInputDataObject(TILES[3])
    with knotwork_testing.Errors(made) as errors:
        made.Update()
    assert errors and "share an edge" in errors[0], errors
    made = knotwork.vtkSplineStitch()
    made.AddInputDataObject(TILES[0])
    made.AddInputDataObject(TILES[0])
    with knotwork_testing.Errors(made) as errors:
        made.Update()
    assert errors and "overlap" in errors[0], errors
    output = knotwork_testing.output("none.vtu")
    done = knotwork_testing.run_program("stitch", knotwork_testing.output("missing.vtu"), "--output", output)
    assert done.returncode == 1 and "missing.vtu" in done.stderr, done.stderr
    done = knotwork_testing.run_program("stitch", "--output", output)
    assert done.returncode == 2


knotwork_testing.main(globals())
