# SPDX-License-Identifier: BSD-3-Clause
"""A saddle with two holes: flattened and trimmed. The distance of mesh and faces, both ways, is measured here and held
against the bound that the filter reports."""
import math

import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance


def saddle(n=40):
    """z = x y / 2 over a disc with an ear cut out of its side and two round holes."""
    x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
    flat = np.c_[x.ravel(), y.ravel()]
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    triangles = np.vstack([np.c_[first, first + 1, first + n + 2], np.c_[first, first + n + 2, first + n + 1]])
    centres = flat[triangles].mean(1)
    inside = np.hypot(*centres.T) < 1
    for at, radius in (((1, 0), 0.4), ((-0.3, 0.4), 0.2), ((-0.3, -0.4), 0.25)):
        inside &= np.hypot(*(centres - at).T) > radius
    used, cells = np.unique(triangles[inside], return_inverse=True)
    mesh = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.c_[flat[used], flat[used].prod(1) / 2], deep=1))
    polygons = vtkCellArray()
    for cell in cells.reshape(-1, 3):
        polygons.InsertNextCell(3, [int(i) for i in cell])
    mesh.SetPoints(points)
    mesh.SetPolys(polygons)
    return mesh


def trimmed(mesh, **properties):
    flat = knotwork.vtkMeshParameterization()
    flat.SetInputDataObject(mesh)
    surface = knotwork.vtkTrimmedSurface()
    surface.SetInputConnection(flat.GetOutputPort())
    for name, value in properties.items():
        getattr(surface, "Set" + name)(value)
    surface.Update()
    assert surface.GetErrorCode() == 0
    return surface


def number(surface, name):
    return surface.GetOutputDataObject(4).GetValueByName(0, name).ToDouble()


def samples(mesh):
    """Points in all triangles: corners, middles of edges, centres."""
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    cells = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    weights = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (.5, .5, 0), (0, .5, .5), (.5, 0, .5), (1 / 3, 1 / 3, 1 / 3)])
    return np.einsum("wk,tkx->twx", weights, points[cells]).reshape(-1, 3)


def largest_distance(a, b):
    """From samples of a to the triangles of b."""
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(b)
    return max(abs(distance.EvaluateFunction(*p)) for p in samples(a))


def test_distances_both_ways_are_within_the_bound():
    mesh = saddle()
    for tolerance in (0.02, 0.002):
        surface = trimmed(mesh, Tolerance=tolerance)
        assert number(surface, "WithinTolerance") == 1
        bound = number(surface, "MaxDeviation") + number(surface, "TriangleBound")
        faces = surface.GetOutputDataObject(0)
        there, back = largest_distance(mesh, faces), largest_distance(faces, mesh)
        assert max(there, back) <= bound * (1 + 1e-9), (there, back, bound)
        assert number(surface, "MaxDeviation") <= tolerance
        assert max(there, back) > 1e-3 * bound  # a face that is measured, not the mesh itself
        assert number(surface, "Loops") == 3 and number(surface, "LoopsProved") == 1
        assert surface.GetOutputDataObject(4).GetValueByName(0, "Verdict").ToString() == "valid"
        area, mesh_area = number(surface, "Area"), number(surface, "MeshArea")
        assert abs(area / mesh_area - 1) < 5e-3, (area, mesh_area)


def test_the_surface_leads_back_to_the_mesh():
    surface = trimmed(saddle(), Tolerance=0.005)
    mesh = surface.GetOutputDataObject(3)
    uv = vtk_to_numpy(mesh.GetPointData().GetArray("UV"))
    queries = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.c_[uv, np.zeros(len(uv))], deep=1))
    queries.SetPoints(points)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, surface.GetOutputDataObject(1))
    evaluate.SetInputDataObject(1, queries)
    evaluate.Update()
    there = vtk_to_numpy(evaluate.GetOutputDataObject(0).GetPoints().GetData())
    found = np.linalg.norm(there - vtk_to_numpy(mesh.GetPoints().GetData()), axis=1)
    said = vtk_to_numpy(mesh.GetPointData().GetArray("Deviation"))
    assert abs(found - said).max() < 1e-12
    assert math.isclose(np.hypot(*np.ptp(uv, axis=0)), math.sqrt(8), rel_tol=0.2)  # plane and mesh have one scale


def test_trimming_curves_run_on_the_surface():
    surface = trimmed(saddle(), Tolerance=0.005)
    curves = surface.GetOutputDataObject(2)
    fine = knotwork.vtkSplineTessellate()
    fine.SetInputDataObject(curves)
    fine.Update()
    line = fine.GetOutputDataObject(0)
    queries = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    uv = vtk_to_numpy(line.GetPointData().GetArray("UV"))
    points.SetData(numpy_to_vtk(np.c_[uv, np.zeros(len(uv))], deep=1))
    queries.SetPoints(points)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, surface.GetOutputDataObject(1))
    evaluate.SetInputDataObject(1, queries)
    evaluate.Update()
    on_surface = vtk_to_numpy(evaluate.GetOutputDataObject(0).GetPoints().GetData())
    gap = np.linalg.norm(on_surface - vtk_to_numpy(line.GetPoints().GetData()), axis=1)
    assert gap.max() <= number(surface, "MaxEdgeGap") + 1e-12, (gap.max(), number(surface, "MaxEdgeGap"))


knotwork_testing.main(globals())
