# SPDX-License-Identifier: BSD-3-Clause
"""Contours of a fitted surface from Python and by the program: the bound by dense evaluation, the number of components
by VTK's contours of a fine grid; errors."""
import json

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkPolyDataConnectivityFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

LEVELS = (-0.25, -0.1, 0.0, 0.03, 0.11, 0.3)


def height(x, y):
    cliff = np.tanh((y - 0.4 - 0.1 * np.sin(6 * x)) / 0.01)
    return 0.15 * np.sin(14 * x + 1) * np.cos(11 * y) + 0.15 * cliff


def polydata(points):
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    made = vtkPolyData()
    made.SetPoints(places)
    return made


def fitted():
    xy = np.random.default_rng(1).uniform(size=(30000, 2))
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputData(polydata(np.c_[xy, height(*xy.T)]))
    fit.SetDomain(0, 1, 0, 1)
    fit.SetTolerance(0.02)
    fit.Update()
    return fit.GetOutputDataObject(0)


SURFACE = fitted()


def heights(xy):
    """z of the surface at parameters x, y."""
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, SURFACE)
    evaluate.SetPointsData(polydata(np.c_[xy, np.zeros(len(xy))]))
    evaluate.Update()
    return vtk_to_numpy(evaluate.GetOutputDataObject(0).GetPoints().GetData())[:, 2]


def contoured(levels=LEVELS, **properties):
    made = knotwork.vtkSplineContour()
    made.SetInputData(SURFACE)
    for level in levels:
        made.AddLevel(level)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    made.Update()
    return made


def column(made, name):
    table = made.GetOutputDataObject(2)
    return [table.GetValueByName(row, name).ToDouble() for row in range(table.GetNumberOfRows())]


def grid_components(n):
    """Components of VTK's contours of n x n samples, a level."""
    axis = np.linspace(0, 1, n)
    x, y = np.meshgrid(axis, axis)
    image = vtkImageData()
    image.SetDimensions(n, n, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(heights(np.c_[x.ravel(), y.ravel()]), deep=1))
    counts = []
    for level in LEVELS:
        contour = vtkContourFilter()
        contour.SetInputData(image)
        contour.SetValue(0, level)
        parts = vtkPolyDataConnectivityFilter()
        parts.SetInputConnection(contour.GetOutputPort())
        parts.SetExtractionModeToAllRegions()
        parts.Update()
        counts.append(parts.GetNumberOfExtractedRegions())
    return counts


def test_components_are_those_of_a_fine_grid():
    made = contoured()
    assert column(made, "Components") == grid_components(2001)
    assert sum(column(made, "Undecided")) == 0
    assert made.GetOutputDataObject(0).GetNumberOfLines() == sum(column(made, "Components"))


def test_the_bound_holds_between_the_points():
    for tolerance in (1e-3, 1e-5):
        made = contoured(Tolerance=tolerance)
        lines = made.GetOutputDataObject(0)
        points = vtk_to_numpy(lines.GetPoints().GetData())
        levels = vtk_to_numpy(lines.GetCellData().GetArray("Level"))
        bounds = vtk_to_numpy(lines.GetCellData().GetArray("MaxError"))
        assert bounds.max() <= tolerance == column(made, "Tolerance")[0]
        largest = 0
        for cell in range(lines.GetNumberOfCells()):
            ids = lines.GetCell(cell).GetPointIds()
            run = points[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]]
            for share in np.linspace(0, 1, 9):
                xy = (1 - share) * run[:-1, :2] + share * run[1:, :2]
                error = np.abs(heights(xy) - levels[cell]).max()
                assert error <= bounds[cell] + 1e-12, (error, bounds[cell])
                largest = max(largest, error)
        assert largest > 0.01 * tolerance  # not finer than asked for


def test_program():
    surface, output, curves, report, table = (
        knotwork_testing.output("contour/" + name) for name in ("s.vtu", "c.vtp", "c.vtu", "r.json", "t.csv"))
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(SURFACE)
    writer.SetFileName(surface)
    writer.Write()
    made = contoured(Tolerance=1e-4)
    numbers = []
    for name in (output, curves):
        done = knotwork_testing.run_program("contour", surface, "--levels", *LEVELS, "--tolerance", 1e-4, "--output", name,
                                            "--report", report, "--table", table)
        assert done.returncode == 0, done.stderr
        with open(report) as file:
            numbers.append(json.load(file))
        assert numbers[-1]["levels"] == sorted(LEVELS)
        assert numbers[-1]["level_components"] == column(made, "Components")
        assert numbers[-1]["level_closed"] == column(made, "Closed")
        assert numbers[-1]["components"] == sum(column(made, "Components"))
        assert numbers[-1]["closed"] == sum(column(made, "Closed")) > 0
        assert numbers[-1]["undecided"] == 0 and 0 < numbers[-1]["max_error"] <= 1e-4 and numbers[-1]["seconds"] > 0
    with open(table) as file:
        assert len(file.read().splitlines()) == 1 + len(LEVELS)
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(output)
    reader.Update()
    assert reader.GetOutput().GetNumberOfLines() == numbers[0]["components"]
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(curves)
    reader.Update()
    ids = vtk_to_numpy(reader.GetOutput().GetCellData().GetArray("ComponentId"))
    assert len(np.unique(ids)) == numbers[0]["components"] and len(ids) < numbers[0]["points"]
    # as many as asked for, none beside the range
    done = knotwork_testing.run_program("contour", surface, "--number", 4, "--range", 5, 6, "--output", output, "--report",
                                        report)
    assert done.returncode == 0, done.stderr
    with open(report) as file:
        found = json.load(file)
    assert found["components"] == 0 and np.allclose(found["levels"], [5, 5 + 1 / 3, 5 + 2 / 3, 6], rtol=1e-15)


def test_threads_do_not_matter():
    one, two = (contoured(Threads=threads).GetOutputDataObject(0) for threads in (1, 2))
    assert (vtk_to_numpy(one.GetPoints().GetData()) == vtk_to_numpy(two.GetPoints().GetData())).all()


def test_errors():
    for properties, word in ((dict(FieldName="Heat"), "no field 'Heat'"), (dict(Component=3), "component 3"),
                             (dict(Tolerance=1e-18), "rounding"), (dict(levels=(float("nan"),)), "finite")):
        made = knotwork.vtkSplineContour()
        made.SetInputData(SURFACE)
        for level in properties.pop("levels", ()):
            made.AddLevel(level)
        for key, value in properties.items():
            getattr(made, "Set" + key)(value)
        with knotwork_testing.Errors(made) as errors:
            made.Update()
        assert errors and word in errors[0], errors
        assert made.GetOutputDataObject(0).GetNumberOfPoints() == 0
    output = knotwork_testing.output("contour/none.vtp")
    done = knotwork_testing.run_program("contour", knotwork_testing.output("missing.vtu"), "--output", output)
    assert done.returncode == 1 and "missing.vtu" in done.stderr, done.stderr


knotwork_testing.main(globals())
