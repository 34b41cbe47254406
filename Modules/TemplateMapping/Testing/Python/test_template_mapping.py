# SPDX-License-Identifier: BSD-3-Clause
"""Template mapping from Python: a circle in a square carried onto an ellipse-like curve, results as numpy arrays."""
import math

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

CORNERS = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)]


def polydata(curves):
    points, lines, ids = vtkPoints(), vtkCellArray(), vtkIntArray()
    points.SetDataTypeToDouble()
    ids.SetName("PatchId")
    for patch, curve in enumerate(curves):
        lines.InsertNextCell(len(curve))
        ids.InsertNextValue(patch)
        for x, y in curve:
            lines.InsertCellPoint(points.InsertNextPoint(x, y, 0))
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetLines(lines)
    data.GetCellData().AddArray(ids)
    return data


def skeleton(samples, lobes):
    """The unit square's edges and the curve r(a) = 0.25 (1 + lobes cos(2 a)) about its centre."""
    ts = [i / (samples - 1) for i in range(samples)]
    curves = [[(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])) for t in ts] for a, b in zip(CORNERS, CORNERS[1:])]
    radii = [0.25 * (1 + lobes * math.cos(4 * math.pi * t)) for t in ts]
    curves.append([(0.5 + r * math.cos(2 * math.pi * t), 0.5 + r * math.sin(2 * math.pi * t))
                   for r, t in zip(radii, ts)])
    return polydata(curves)


def mapping(lobes=0.2):
    mapping = knotwork.vtkTemplateMapping()
    mapping.SetInputData(0, skeleton(2001, 0.0))
    mapping.SetTargetData(skeleton(200, lobes))
    return mapping


def test_defaults():
    made = knotwork.vtkTemplateMapping()
    assert (made.GetMethod(), made.GetIterations(), made.GetDegree()) == (made.TDM, 20, 3)
    assert (made.GetInnerKnots(), made.GetTemplateSamples(), made.GetNewtonSteps()) == (11, 0, 2)
    assert made.GetTikhonovWeight() == 0.02 and made.GetPdmWeight() == made.GetTdmWeight() == 1
    for functional in ("Uniformity", "Length", "Orthogonality", "Skewness", "Eccentricity", "Area", "SelfIntersection"):
        assert getattr(made, f"Get{functional}Weight")() == 0, functional
    assert made.GetGuard() and made.GetInjectivity() and not made.GetUseDomain()
    assert (made.GetRefinement(), made.GetRefineEvery(), made.GetExtension()) == (made.NONE, 1, 1)
    assert (made.GetRefineThreshold(), made.GetRefineShare(), made.GetStagnationRatio()) == (1e-5, 0, 0.05)
    assert (made.GetAccuracy(), made.GetMaxIrregularShare(), made.GetMaxLevel()) == (0, 1, 10)
    assert made.GetMaxFunctions() == 200000 and made.GetInitialMap() == made.IDENTITY
    assert made.GetInitialUniformityWeight() == 1e-4 and (made.MOVED, made.QUADRATIC, made.HELD) == (1, 2, 3)
    assert made.GetInnerKnotsPerDirection() == (-1, -1, -1)


def test_quadratic_start_reproduces_affine_maps():
    """Beyond all steps: what is left is the first map."""
    made = knotwork.vtkTemplateMapping()
    made.SetInputData(0, skeleton(501, 0.0))
    target = skeleton(501, 0.0)
    points = vtk_to_numpy(target.GetPoints().GetData())
    points[:, :2] = points[:, :2] @ np.array([[1.2, 0.3], [-0.2, 0.8]]) + (4.0, -3.0)
    made.SetTargetData(target)
    made.SetMethod(made.FIXED)
    made.SetIterations(1)
    made.SetTikhonovWeight(1e20)
    made.SetInitialMap(made.QUADRATIC)
    made.Update()
    assert vtk_to_numpy(made.GetOutputDataObject(2).GetColumnByName("MaxError"))[0] < 1e-6
    made.SetInitialMap(made.MOVED)
    made.Update()
    assert vtk_to_numpy(made.GetOutputDataObject(2).GetColumnByName("MaxError"))[0] > 1e-3


def test_target_is_reached():
    made = mapping()
    made.Update()
    table = made.GetOutputDataObject(2)
    errors = vtk_to_numpy(table.GetColumnByName("SquaredL2Error"))
    assert len(errors) == 20 and errors[-1] < 1e-5 and errors[-1] < 0.1 * errors[0]
    assert vtk_to_numpy(table.GetColumnByName("NegativeJacobianPercent"))[-1] == 0.0
    assert vtk_to_numpy(table.GetColumnByName("Functions"))[-1] == 225
    mapped = dataset_adapter.WrapDataObject(made.GetOutputDataObject(1))
    largest = vtk_to_numpy(table.GetColumnByName("MaxError"))[-1]
    assert 0 <= mapped.PointData["Distance"].max() <= largest * (1 + 1e-12) < 2e-3
    grid = dataset_adapter.WrapDataObject(made.GetOutputDataObject(0))
    assert grid.GetNumberOfCells() == 144
    assert abs(grid.CellData["MaxError"].max() - largest) < 1e-3


def field(mapping, name):
    array = mapping.GetOutputDataObject(0).GetFieldData().GetAbstractArray(name)
    return array and array.GetValue(0)


def test_map_is_proved_regular():
    made = mapping()
    made.Update()
    grid = dataset_adapter.WrapDataObject(made.GetOutputDataObject(0))
    assert field(made, "MinJacobianBound") == grid.CellData["JacobianMinLower"].min() > 0
    assert (grid.CellData["JacobianMaxUpper"] >= grid.CellData["JacobianMinLower"]).all()
    assert field(made, "Injective") == "injective"
    made.InjectivityOff()
    made.Update()
    assert field(made, "Injective") is None


def test_local_refinement_and_functionals():
    made = mapping(0.3)
    made.SetRefinement(made.LOCAL)
    made.SetRefineThreshold(1e-4)
    made.SetExtension(2)
    made.SetUniformityWeight(1e-7)
    made.SetMethod(made.WEIGHTED)
    made.SetPdmWeight(0.1)
    made.SetIterations(5)
    made.Update()
    functions = vtk_to_numpy(made.GetOutputDataObject(2).GetColumnByName("Functions"))
    assert functions[0] == 225 < functions[-1] < 2601 and (functions[1:] >= functions[:-1]).all(), functions
    grid = dataset_adapter.WrapDataObject(made.GetOutputDataObject(0))
    assert grid.CellData["Level"].max() >= 1 and field(made, "MinJacobianBound") > 0
    assert (vtk_to_numpy(made.GetOutputDataObject(2).GetColumnByName("StepLength")) == 1).all()
    assert (vtk_to_numpy(made.GetOutputDataObject(2).GetColumnByName("HeldElements")) == 0).all()


def test_given_map_is_continued():
    first = mapping()
    first.SetIterations(4)
    first.SetInnerKnotsPerDirection(5, 8, -1)
    second = mapping()
    second.SetIterations(2)
    second.SetInitialMapConnection(first.GetOutputPort())
    second.Update()
    last = [vtk_to_numpy(made.GetOutputDataObject(2).GetColumnByName("SquaredL2Error"))[-1] for made in (first, second)]
    assert last[1] < last[0]
    assert vtk_to_numpy(second.GetOutputDataObject(2).GetColumnByName("Functions"))[-1] == 9 * 12


def test_error_is_one_clear_line():
    made = mapping()
    made.SetTargetData(polydata([[(0, 0), (1, 0)]] * 7))
    with knotwork_testing.Errors(made) as errors:
        made.Update()
    ours = [error for error in errors if "target patches 5, 6 have no patch of the same id" in error]
    assert len(ours) == 1, errors
    assert made.GetOutputDataObject(0).GetNumberOfCells() == 0


knotwork_testing.main(globals())
