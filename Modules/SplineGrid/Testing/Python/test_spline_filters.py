# SPDX-License-Identifier: BSD-3-Clause
"""The source, the refinement, the control net and the parametric mesh from Python."""
import math

import knotwork
import knotwork_testing
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkSphere, vtkTable, vtkUnstructuredGrid
from vtkmodules.vtkFiltersSources import vtkLineSource


def source(name, **properties):
    made = knotwork.vtkSplineSource()
    made.SetShapeName(name)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    return made


def test_shapes_by_name():
    shapes = knotwork.vtkSplineSource
    ball = source("Ball", InnerRadius=0.25, OuterRadius=2.0)
    assert ball.GetShape() == shapes.BALL
    assert ball.GetShapeName() == "Ball"
    ball.Update()
    grid = ball.GetOutputDataObject(0)
    assert isinstance(grid, vtkUnstructuredGrid)
    assert grid.GetNumberOfCells() == 7
    assert math.isclose(grid.GetBounds()[1], -grid.GetBounds()[0])


def test_chain():
    disc = source("Disc", Degree=2, Elements=(2, 2, 1))
    sphere = vtkSphere()
    sphere.SetCenter(1, 0, 0)
    sphere.SetRadius(0.2)
    refine = knotwork.vtkSplineRefine()
    refine.SetInputConnection(disc.GetOutputPort())
    refine.SetMode(refine.IMPLICIT_FUNCTION)
    refine.SetImplicitFunction(sphere)
    refine.SetNumberOfRefinements(2)
    mesh = knotwork.vtkSplineParametricMesh()
    mesh.SetInputConnection(refine.GetOutputPort())
    mesh.Update()
    net = knotwork.vtkSplineControlNet()
    net.SetInputConnection(refine.GetOutputPort())
    net.Update()
    grid = refine.GetOutputDataObject(0)
    assert grid.GetCellData().GetArray("Level").GetRange() == (0, 2)
    assert mesh.GetOutputDataObject(0).GetNumberOfCells() == grid.GetNumberOfCells()
    points = net.GetOutputDataObject(0)
    assert points.GetNumberOfVerts() == points.GetNumberOfPoints() > 0
    assert points.GetPointData().GetArray("Level").GetRange()[1] >= 1
    assert points.GetPointData().GetArray("Weight").GetRange()[0] < 1


def test_lr_and_extract():
    sphere = vtkSphere()
    sphere.SetCenter(-0.4, 0, 0)
    sphere.SetRadius(0.1)
    square = source("Square", Degree=2, Elements=(6, 6, 1))
    refine = knotwork.vtkSplineRefine()
    refine.SetInputConnection(square.GetOutputPort())
    refine.SetMode(refine.IMPLICIT_FUNCTION)
    refine.SetImplicitFunction(sphere)
    refine.SetLocalSpace(refine.LOCALLY_REFINED)
    refine.SetLRStrategy(refine.MINIMUM_SPAN)
    refine.KeepIndependentOn()
    extract = knotwork.vtkSplineExtract()
    extract.SetInputConnection(refine.GetOutputPort())
    extract.SetIsoCurve(extract.FIRST)
    extract.SetIsoValue(0.25)
    extract.Update()
    assert 36 < refine.GetOutputDataObject(0).GetNumberOfCells() < 144
    x = extract.GetOutputDataObject(0).GetBounds()  # the square of side 1 around the origin
    assert math.isclose(x[0], -0.25) and math.isclose(x[1], -0.25) and math.isclose(x[2], -0.5) and math.isclose(x[3], 0.5)


def test_derivatives_from_below():
    square = source("Square", Degree=1, Elements=(2, 1, 1))
    square.Update()
    grid = square.GetOutputDataObject(0)
    for i in range(grid.GetNumberOfPoints()):
        x, y, _ = grid.GetPoint(i)
        grid.GetPoints().SetPoint(i, x, y, abs(x))
    at = vtkPoints()
    at.InsertNextPoint(0.5, 0.5, 0)
    points = vtkPolyData()
    points.SetPoints(at)
    for side, slope in ((0, 1), (1, -1)):
        evaluate = knotwork.vtkSplineEvaluate()
        evaluate.SetInputDataObject(grid)
        evaluate.SetPointsData(points)
        evaluate.SetDerivatives(1)
        evaluate.SetFromBelow(side, 0, 0)
        evaluate.Update()
        assert evaluate.GetOutputDataObject(0).GetPointData().GetArray("Derivative_u").GetComponent(0, 2) == slope


def test_segments():
    """Two half lines that are one, as a table of strings and as lines: a row of the square's 6 x 6 elements is halved across 4 of them."""
    square = source("Square", Degree=2, Elements=(6, 6, 1))
    refine = knotwork.vtkSplineRefine()
    refine.SetInputConnection(square.GetOutputPort())
    refine.SetMode(refine.SEGMENTS)
    table = vtkTable()
    for name, values in (("Direction", "00"), ("Value", ("0.25", "0.25")), ("Start", ("0.5", "0")), ("End", ("0.66666666666666663", "0.5"))):
        column = vtkStringArray()
        column.SetName(name)
        for value in values:
            column.InsertNextValue(value)
        table.AddColumn(column)
    refine.SetSegmentsData(table)
    refine.Update()
    assert refine.GetOutputDataObject(0).GetNumberOfCells() == 36 + 4
    line = vtkLineSource()
    line.SetOutputPointsPrecision(1)
    line.SetPoint1(0.25, 0, 0)
    line.SetPoint2(0.25, 1, 0)
    refine.SetSegmentsConnection(line.GetOutputPort())
    refine.Update()
    assert refine.GetOutputDataObject(0).GetNumberOfCells() == 36 + 6


def test_errors_are_one_line():
    bad = source("Disc", InnerRadius=3.0)
    with knotwork_testing.Errors(bad) as errors:
        bad.Update()
    assert bad.GetErrorCode() > 40000
    assert "inner radius" in errors[0]
    assert bad.GetOutputDataObject(0).GetNumberOfCells() == 0
    with knotwork_testing.Errors(bad) as errors:
        bad.SetShapeName("Nothing")
    assert len(errors) == 1

    for kind in (knotwork.vtkSplineRefine, knotwork.vtkSplineExtract, knotwork.vtkSplineControlNet,
                 knotwork.vtkSplineParametricMesh):
        wrong = kind()
        wrong.SetInputDataObject(vtkTable())
        with knotwork_testing.Errors(wrong) as errors:
            wrong.Update()
        assert errors


knotwork_testing.main(globals())
