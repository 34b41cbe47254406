# SPDX-License-Identifier: BSD-3-Clause
"""Template mapping from Python: a circle in a square carried onto an ellipse-like curve, results as numpy arrays."""
import math

import knotwork
import knotwork_testing
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
    assert made.GetTikhonovWeight() == 0.02


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


def test_error_is_one_clear_line():
    made = mapping()
    made.SetTargetData(polydata([[(0, 0), (1, 0)]] * 7))
    with knotwork_testing.Errors(made) as errors:
        made.Update()
    ours = [error for error in errors if "target patches 5, 6 have no patch of the same id" in error]
    assert len(ours) == 1, errors
    assert made.GetOutputDataObject(0).GetNumberOfCells() == 0


knotwork_testing.main(globals())
