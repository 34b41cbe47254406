# SPDX-License-Identifier: BSD-3-Clause
"""A cone on a cylinder, a ball and a ring: types, numbers and edges of what they are made from."""
import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkAppendPolyData

SIDES = 48


def turned(profile, x=0.0):
    """The triangles of a profile, points (radius, z), turned about the z axis; every triangle has corners of its own, as in STL files."""
    angles = 2 * np.pi * np.arange(SIDES) / SIDES
    circle = np.c_[np.cos(angles), np.sin(angles)]
    rings = [np.c_[radius * circle + (x, 0), np.full(SIDES, height)] for radius, height in profile]
    points = vtkPoints()
    points.SetDataTypeToDouble()
    cells = vtkCellArray()
    for low, high in zip(rings[:-1], rings[1:]):
        for i in range(SIDES):
            j = (i + 1) % SIDES
            for triangle in ((low[i], low[j], high[j]), (low[i], high[j], high[i])):
                if len({tuple(corner) for corner in triangle}) == 3:
                    cells.InsertNextCell(3, [points.InsertNextPoint(*corner) for corner in triangle])
    mesh = vtkPolyData()
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    return mesh


def spire():
    """A cylinder of radius 1 and height 2, on it a blunt cone; open below and above."""
    return turned([(1, 0), (1, 2), (0.5, 2.5)])


def ball():
    angles = np.pi * np.arange(1, SIDES // 2) / (SIDES // 2)
    return turned([(0, -1.5), *zip(1.5 * np.sin(angles), -1.5 * np.cos(angles)), (0, 1.5)])


def ring():
    angles = 2 * np.pi * np.arange(SIDES // 2) / (SIDES // 2)
    around = [*zip(2 + 0.5 * np.cos(angles), 0.5 * np.sin(angles))]
    return turned([*around, around[0]], x=6.0)


def recognized(mesh, **properties):
    filter = knotwork.vtkSurfaceRecognition()
    filter.SetInputDataObject(mesh)
    for name, value in properties.items():
        getattr(filter, "Set" + name)(value)
    filter.Update()
    assert filter.GetErrorCode() == 0
    table = filter.GetOutputDataObject(2)
    rows = [{table.GetColumnName(c): table.GetValue(r, c) for c in range(table.GetNumberOfColumns())}
            for r in range(table.GetNumberOfRows())]
    return filter, rows


def test_spire_is_a_cylinder_and_a_cone():
    filter, rows = recognized(spire())
    assert [row["Type"].ToString() for row in rows] == ["cylinder", "cone"]
    assert abs(rows[0]["Radius"].ToDouble() - 1) < 1e-9
    assert abs(rows[1]["Angle"].ToDouble() - 45) < 1e-7
    assert [row["Triangles"].ToInt() for row in rows] == [2 * SIDES, 2 * SIDES]
    edges = filter.GetOutputDataObject(1)
    assert edges.GetNumberOfLines() == SIDES
    ends = vtk_to_numpy(edges.GetPoints().GetData())[vtk_to_numpy(edges.GetLines().GetConnectivityArray())].reshape(-1, 2, 3)
    assert np.all(ends[:, :, 2] == 2)


def test_ball_and_ring_have_their_radii():
    both = vtkAppendPolyData()
    for mesh in (ball(), ring()):
        both.AddInputData(mesh)
    both.Update()
    filter, rows = recognized(both.GetOutput(), Tolerance=0.01)
    assert sorted(row["Type"].ToString() for row in rows) == ["sphere", "torus"], rows
    by_type = {row["Type"].ToString(): row for row in rows}
    assert abs(by_type["sphere"]["Radius"].ToDouble() - 1.5) < 1e-8
    assert abs(by_type["torus"]["Radius"].ToDouble() - 2) < 1e-8
    assert abs(by_type["torus"]["MinorRadius"].ToDouble() - 0.5) < 1e-8
    triangles = filter.GetOutputDataObject(0)
    types = vtk_to_numpy(triangles.GetCellData().GetArray("SurfaceType"))
    assert set(types) == {2, 4}
    assert filter.GetOutputDataObject(3).GetValueByName(0, "Tolerance").ToDouble() == 0.01


knotwork_testing.main(globals())
