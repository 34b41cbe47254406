# SPDX-License-Identifier: BSD-3-Clause
"""Evaluation from Python: parameters, patches, derivatives against differences, probing, fields, errors."""
import knotwork
import knotwork_testing
import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData, vtkUnstructuredGrid


def source(name, **properties):
    made = knotwork.vtkSplineSource()
    made.SetShapeName(name)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    return made


def cloud(places, **arrays):
    """Points with point arrays."""
    data = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(places, float), deep=1))
    data.SetPoints(points)
    for name, values in arrays.items():
        array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=1)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    return data


def evaluate(grid, points, **properties):
    """The evaluated points, wrapped; grid is an algorithm or a dataset."""
    made = knotwork.vtkSplineEvaluate()
    if hasattr(grid, "GetOutputPort"):
        made.SetInputConnection(grid.GetOutputPort())
    else:
        made.SetInputDataObject(grid)
    made.SetPointsData(points)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    made.Update()
    assert made.GetErrorCode() == 0
    return dataset_adapter.WrapDataObject(made.GetOutputDataObject(0))


def parameters(count, seed=7):
    return numpy.random.default_rng(seed).uniform(0.05, 0.95, (count, 3))


def test_defaults():
    made = knotwork.vtkSplineEvaluate()
    assert (made.GetMode(), made.GetDerivatives(), made.GetParameterArray()) == (made.PARAMETERS, 0, "")
    assert (made.GetPatchIdArray(), made.GetPatchId(), made.GetThreads()) == ("PatchId", -1, 0)


def test_annulus_by_parameters():
    u = parameters(200) * [1, 1, 0]
    found = evaluate(source("AnnulusSector", Elements=(2, 3, 1)), cloud(u), Derivatives=2)
    radius = numpy.linalg.norm(found.Points, axis=1)
    assert abs(radius - (0.5 + 0.5 * u[:, 0])).max() <= 1e-14
    radial = found.Points / radius[:, None]
    assert abs(found.PointData["Derivative_u"] - 0.5 * radial).max() <= 1e-13
    assert abs(numpy.sum(found.PointData["Derivative_v"] * found.Points, axis=1)).max() <= 1e-13
    assert abs(found.PointData["Derivative_uu"]).max() <= 1e-12
    assert {"Derivative_uv", "Derivative_vv"} <= set(found.PointData.keys())


def test_derivatives_are_limits_of_differences():
    # a rational solid; the step's error is of order step^2 and rounding of order eps / step
    ball = source("BallSector", InnerRadius=0.5)
    u, step = parameters(50), 1e-5
    exact = evaluate(ball, cloud(u), Derivatives=2)
    for k, name in enumerate("uvw"):
        ahead, behind = (evaluate(ball, cloud(u + s * step * numpy.eye(3)[k]), Derivatives=1) for s in (1, -1))
        first = (ahead.Points - behind.Points) / (2 * step)
        assert abs(first - exact.PointData["Derivative_" + name]).max() <= 1e-8
        second = (ahead.PointData["Derivative_w"] - behind.PointData["Derivative_w"]) / (2 * step)
        assert abs(second - exact.PointData[f"Derivative_{name}w"]).max() <= 1e-7


def test_arrays_name_parameters_and_patches():
    ids = numpy.array([0, 1, 2, 3, 4, 5, 2], numpy.int32)
    middle = numpy.full((7, 2), 0.5)
    found = evaluate(source("SphereSurface"), cloud(numpy.full((7, 3), 9.0), UV=middle, Side=ids), ParameterArray="UV",
                     PatchIdArray="Side")
    # middles of six faces: the six unit vectors of the axes
    assert (found.PointData["PatchId"] == ids).all()
    unit = numpy.round(found.Points)
    assert abs(found.Points - unit).max() <= 1e-14
    assert len(set(map(tuple, unit))) == 6
    assert (found.Points[2] == found.Points[6]).all()
    one = evaluate(source("SphereSurface"), cloud([[0.5, 0.5, 0]]), PatchId=3)
    assert (one.Points[0] == found.Points[3]).all()


def test_probe_finds_the_nearest_point():
    places = numpy.random.default_rng(3).normal(size=(300, 3)) * 2
    found = evaluate(source("SphereSurface"), cloud(places), Mode=1)
    norm = numpy.linalg.norm(places, axis=1)
    assert abs(found.PointData["Distance"] - abs(norm - 1)).max() <= 1e-12
    assert abs(found.Points - places / norm[:, None]).max() <= 1e-6  # flat near the foot point: root of rounding


def test_probe_inverts_a_refined_solid():
    bar = source("TwistedBar", Degree=2, Elements=(2, 2, 2))
    refine = knotwork.vtkSplineRefine()
    refine.SetInputConnection(bar.GetOutputPort())
    refine.SetMode(refine.CELL_ARRAY)
    refine.SetInputArrayToProcess(0, 0, 0, 1, "ElementId")
    refine.SetUpperThreshold(0)
    refine.SetNumberOfRefinements(2)
    u = parameters(100)
    there = evaluate(bar, cloud(u))
    back = evaluate(refine, cloud(numpy.array(there.Points)), Mode=1)
    assert back.PointData["Distance"].max() <= 1e-14
    refine.Update()
    bounds = dataset_adapter.WrapDataObject(refine.GetOutputDataObject(0)).CellData["ParametricBounds"]
    element = numpy.array(back.PointData["ElementId"])
    lower, upper = bounds[element][:, 0::2], bounds[element][:, 1::2]
    assert abs(lower + back.PointData["LocalParameters"] * (upper - lower) - u).max() <= 1e-11


def test_fields_and_arrays_of_the_points():
    disc = source("Disc")
    disc.Update()
    grid = disc.GetOutputDataObject(0)
    places = numpy.array(dataset_adapter.WrapDataObject(grid).Points)
    field = numpy_to_vtk(places @ [1.0, 4.0, 0.0], deep=1)
    field.SetName("Heat")
    grid.GetPointData().AddArray(field)
    points = numpy.random.default_rng(5).uniform(-0.6, 0.6, (60, 3)) * [1, 1, 0]
    found = evaluate(grid, cloud(points, Tag=numpy.arange(60)), Mode=1, Derivatives=1)
    assert (found.PointData["Tag"] == numpy.arange(60)).all()
    assert abs(found.PointData["Heat"] - points @ [1.0, 4.0, 0.0]).max() <= 1e-12
    slope = found.PointData["Derivative_v"] @ numpy.array([1.0, 4.0, 0.0])
    assert abs(found.PointData["Heat_v"] - slope).max() <= 1e-12


def expect(code, words, grid, points, **properties):
    made = knotwork.vtkSplineEvaluate()
    made.SetInputDataObject(grid)
    made.SetPointsData(points)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    with knotwork_testing.Errors(made) as errors:
        made.Update()
    assert errors and words in errors[0], errors
    if code:
        assert made.GetErrorCode() == 40000 + code, made.GetErrorCode()
        assert made.GetOutputDataObject(0).GetNumberOfPoints() == 0


def test_errors():
    annulus, disc = source("AnnulusSector"), source("Disc")
    annulus.Update()
    disc.Update()
    grid, patches = annulus.GetOutputDataObject(0), disc.GetOutputDataObject(0)
    one = cloud([[0.5, 0.5, 0]])
    expect(9, "point 1", grid, cloud([[0.5, 0.5, 0], [1.5, 0.5, 0]]))
    expect(2, "", grid, cloud([[float("nan"), 0.5, 0]]), Mode=1)
    expect(1, "Missing", grid, one, ParameterArray="Missing")
    expect(1, "no spline", vtkUnstructuredGrid(), one)
    expect(10, "PatchId 8", grid, one, PatchId=8)
    expect(6, "5 patches", patches, one)
    expect(8, "needs 2", grid, cloud([[0, 0, 0]], U=numpy.array([0.5])), ParameterArray="U")
    foreign = vtkUnstructuredGrid()
    foreign.DeepCopy(grid)
    foreign.GetFieldData().Initialize()
    expect(8, "probe by position", foreign, one)
    expect(0, "", grid, vtkImageData())


knotwork_testing.main(globals())
