# SPDX-License-Identifier: BSD-3-Clause
"""Warp from Python: points keep their cells, splines stay splines within the tolerance, clamping, errors."""
import knotwork
import knotwork_testing
import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkTable, vtkUnstructuredGrid
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource


def source(name, **properties):
    made = knotwork.vtkSplineSource()
    made.SetShapeName(name)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    return made


def warp(algorithm, map_, **properties):
    made = knotwork.vtkSplineWarp()
    made.SetInputConnection(algorithm.GetOutputPort())
    made.SetMapConnection(map_.GetOutputPort())
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    made.Update()
    return made


def annulus():
    """(u, v) to the quarter annulus of radius 1/2 + u/2."""
    return source("AnnulusSector")


def test_defaults():
    made = knotwork.vtkSplineWarp()
    assert (made.GetMapPatchId(), made.GetClamp(), made.GetTolerance(), made.GetMaxLevel()) == (-1, False, 1e-3, 5)


def test_points_of_a_mesh_in_a_solid():
    # a twisted bar turns its slices about z and keeps their shape
    sphere = vtkSphereSource()
    sphere.SetCenter(0.5, 0.5, 0.5)
    sphere.SetRadius(0.4)
    sphere.SetPhiResolution(9)  # odd: an equator
    sphere.SetOutputPointsPrecision(1)
    sphere.Update()
    before = dataset_adapter.WrapDataObject(sphere.GetOutput())
    bar = source("TwistedBar", Twist=40.0)
    made = warp(sphere, bar)
    output = made.GetOutputDataObject(0)
    after = dataset_adapter.WrapDataObject(output)
    assert output.GetNumberOfPolys() == sphere.GetOutput().GetNumberOfPolys()
    assert output.GetPointData().GetNormals() is None
    flat = numpy.linalg.norm(before.Points[:, :2] - 0.5, axis=1)
    assert abs(numpy.linalg.norm(after.Points[:, :2], axis=1) - flat).max() <= 1e-14
    middle = abs(before.Points[:, 2] - 0.5) < 1e-12
    assert not middle.all() and abs(after.Points[middle][:, 2]).max() <= 1e-14
    # and the map is what the evaluation says
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputConnection(bar.GetOutputPort())
    evaluate.SetPointsConnection(sphere.GetOutputPort())
    evaluate.Update()
    assert (dataset_adapter.WrapDataObject(evaluate.GetOutputDataObject(0)).Points == after.Points).all()


def test_splines_stay_splines_within_the_tolerance():
    distances, elements = [], []
    for tolerance in (1e-2, 1e-3, 1e-4):
        disc = source("Disc", Center=(0.5, 0.5, 0), OuterRadius=0.45, InnerRadius=0.2, Degree=3)
        made = warp(disc, annulus(), Tolerance=tolerance)
        grid = made.GetOutputDataObject(0)
        assert isinstance(grid, vtkUnstructuredGrid)
        data = dataset_adapter.WrapDataObject(grid)
        assert 0 < data.CellData["Distance"].max() <= tolerance
        # the image, evaluated, against the map of the disc, evaluated
        uv = numpy.stack([a.ravel() for a in numpy.meshgrid(*2 * [numpy.linspace(0, 1, 15)])] + [numpy.zeros(225)], 1)
        worst = 0
        for patch in range(5):
            inner, image = evaluated(disc, uv, patch), evaluated(made, uv, patch)
            expected = evaluated(annulus(), inner, -1)
            worst = max(worst, numpy.linalg.norm(image - expected, axis=1).max())
        assert worst <= 1.5 * tolerance  # the filter samples other points
        distances.append(worst)
        elements.append(grid.GetNumberOfCells())
    assert distances[2] < distances[0] and elements[2] > elements[0]
    # without refinement the spaces are the patches' own
    coarse = warp(source("Disc", Center=(0.5, 0.5, 0), OuterRadius=0.45, InnerRadius=0.2, Degree=3), annulus(),
                  Tolerance=0)
    assert coarse.GetOutputDataObject(0).GetNumberOfCells() == 5


def evaluated(algorithm, uv, patch):
    data = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(uv), deep=1))
    data.SetPoints(points)
    made = knotwork.vtkSplineEvaluate()
    made.SetInputConnection(algorithm.GetOutputPort())
    made.SetPointsData(data)
    made.SetPatchId(patch)
    made.Update()
    assert made.GetErrorCode() == 0
    return numpy.array(dataset_adapter.WrapDataObject(made.GetOutputDataObject(0)).Points)


def test_images_can_be_drawn_refined_and_warped_again():
    disc = source("Disc", Center=(0.5, 0.5, 0), OuterRadius=0.2, InnerRadius=0.1, Degree=2)
    twice = warp(warp(disc, annulus()), annulus())
    mesh = knotwork.vtkSplineTessellate()
    mesh.SetInputConnection(twice.GetOutputPort())
    mesh.Update()
    assert mesh.GetErrorCode() == 0 and mesh.GetOutputDataObject(0).GetNumberOfPolys() > 5


def expect(code, words, made):
    with knotwork_testing.Errors(made) as errors:
        made.Update()
    assert errors and words in errors[0], errors
    assert made.GetErrorCode() == 40000 + code, made.GetErrorCode()
    assert made.GetOutputDataObject(0).GetNumberOfPoints() == 0


def test_outside_is_an_error_or_clamped():
    plane = vtkPlaneSource()  # from -0.5 to 0.5
    made = knotwork.vtkSplineWarp()
    made.SetInputConnection(plane.GetOutputPort())
    ring = annulus()
    made.SetMapConnection(ring.GetOutputPort())
    expect(9, "point 0", made)
    made.ClampOn()
    made.Update()
    radii = numpy.linalg.norm(dataset_adapter.WrapDataObject(made.GetOutputDataObject(0)).Points, axis=1)
    # u = -0.5, 0.5 become u = 0, 0.5
    assert abs(numpy.sort(radii) - [0.5, 0.5, 0.75, 0.75]).max() <= 1e-14


def test_errors():
    square = source("Square", Center=(0.5, 0.5, 0))
    for code, words, map_, patch in ((6, "5 patches", source("Disc"), -1), (6, "no patch 9", source("Disc"), 9)):
        made = knotwork.vtkSplineWarp()
        made.SetInputConnection(square.GetOutputPort())
        made.SetMapConnection(map_.GetOutputPort())
        made.SetMapPatchId(patch)
        expect(code, words, made)
    empty = knotwork.vtkSplineWarp()
    empty.SetInputConnection(square.GetOutputPort())
    empty.SetMapData(vtkUnstructuredGrid())
    expect(1, "map", empty)
    ring = annulus()
    ring.Update()
    foreign = vtkUnstructuredGrid()
    foreign.DeepCopy(ring.GetOutputDataObject(0))
    foreign.GetFieldData().Initialize()
    bezier = knotwork.vtkSplineWarp()
    bezier.SetInputConnection(square.GetOutputPort())
    bezier.SetMapData(foreign)
    expect(8, "without a parameter domain", bezier)
    wrong = knotwork.vtkSplineWarp()
    wrong.SetInputDataObject(vtkTable())
    wrong.SetMapConnection(ring.GetOutputPort())
    with knotwork_testing.Errors(wrong) as errors:
        wrong.Update()
    assert errors


knotwork_testing.main(globals())
