# SPDX-License-Identifier: BSD-3-Clause
"""Hexahedra near a part, and the spline on them that was fitted to it: sharp edges are sharp, and every element is proved valid (cad_fit.png).

usage: cad_fit.py [--output DIR]
"""
import os

import _scene as scene
import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter


def grid_of(points, cells):
    grid = vtkUnstructuredGrid()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    grid.SetPoints(vertices)
    for cell in cells:
        grid.InsertNextCell(VTK_HEXAHEDRON, 8, [int(i) for i in cell])
    return grid


def bricks(n):
    """n[0] x n[1] x n[2] hexahedra of the unit cube."""
    index = np.arange(np.prod(np.array(n) + 1)).reshape(np.array(n) + 1, order="F")
    points = np.stack(np.unravel_index(np.arange(index.size), index.shape, order="F"), -1) / np.array(n, float)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [[index[i + a, j + b, k + c] for a, b, c in corners] for k in range(n[2]) for j in range(n[1]) for i in range(n[0])]
    return points, cells


def part(n):
    """Triangles of a block whose top bulges up and whose front bends in: smooth faces, twelve sharp edges."""
    numbers, points, triangles = {}, [], []

    def number(key):
        if key not in numbers:
            numbers[key] = len(points)
            points.append(bent(np.array(key) / n))
        return numbers[key]

    for axis in range(3):
        for end in (0, n):
            a, b = (axis + 1) % 3, (axis + 2) % 3
            for i, j in np.ndindex(n, n):
                quad = []
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    key = [0, 0, 0]
                    key[axis], key[a], key[b] = end, i + u, j + v
                    quad.append(number(tuple(key)))
                quad = quad if end else quad[::-1]
                triangles += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    mesh = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(np.array(points), deep=1))
    mesh.SetPoints(vertices)
    polys = vtkCellArray()
    for triangle in triangles:
        polys.InsertNextCell(3, [int(i) for i in triangle])
    mesh.SetPolys(polys)
    return mesh


def bent(x):
    u, v, w = x
    return np.array([2 * u, v + 0.35 * (1 - v) * np.sin(np.pi * u), 0.8 * w + 0.25 * w * np.sin(np.pi * u) * np.sin(np.pi * v)])


def fit(mesh, target, **properties):
    made = knotwork.vtkCADFit()
    made.SetInputDataObject(mesh)
    made.SetTargetData(target)
    for name, value in properties.items():
        getattr(made, "Set" + name)(value)
    return scene.updated(made)


def drawn(splines):
    made = knotwork.vtkSplineTessellate()
    made.SetInputDataObject(splines)
    made.SetChordalTolerance(1e-3)
    made.NormalsOn()
    made.SplittingOn()
    return scene.updated(made).GetOutputDataObject(0)


def boundary(splines):
    made = knotwork.vtkSplineExtract()
    made.SetInputDataObject(splines)
    made.BoundaryOn()
    return scene.updated(made).GetOutputDataObject(0)


def panel(items, k, count, text, position):
    shown = scene.renderer(items, (k / count, 0, (k + 1) / count, 1), 1.0, False)
    camera = shown.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*position)
    camera.SetViewUp(0, 0, 1)
    shown.ResetCamera()
    camera.Zoom(0.92)
    shown.AddActor(scene.label(text, 0.04, 0.03, 14))
    return shown


def edged(data, colour):
    faces = vtkGeometryFilter()
    faces.SetInputDataObject(data)
    made = scene.actor(scene.updated(faces).GetOutputDataObject(0), colour, lighting=True)
    made.GetProperty().SetEdgeVisibility(1)
    made.GetProperty().SetEdgeColor(*scene.INK)
    return made


def number(made, column):
    return made.GetOutputDataObject(1).GetValueByName(0, column).ToDouble()


def main():
    folder = scene.output_folder()
    points, cells = bricks((6, 3, 3))
    # as a mesher leaves it: straight, and near the part only
    shift = 0.02 * np.random.default_rng(5).uniform(-1, 1, points.shape)
    mesh = grid_of(np.array([bent(x) for x in points]) + shift, cells)
    target = part(24)
    made = fit(mesh, target, Degree=2)
    verdict = made.GetOutputDataObject(1).GetValueByName(0, "Verdict").ToString()
    view = (-2.0, -4.0, 2.6)
    scene.save([
        panel([edged(target, (0.95, 0.93, 0.88))], 0, 3, f"target: {target.GetNumberOfCells()} triangles", view),
        panel([edged(mesh, (0.95, 0.93, 0.88))], 1, 3, f"mesh: {mesh.GetNumberOfCells()} hexahedra, {number(made, 'MeshRmsDistance'):.3f} off", view),
        panel([scene.actor(drawn(boundary(made.GetOutputDataObject(0))), scene.COLOURS[0], lighting=True)], 2, 3,
              f"spline, {verdict}: {number(made, 'Functions'):.0f} functions, {number(made, 'RmsDistance'):.4f} off", view)],
        os.path.join(folder, "cad_fit.png"), (1200, 420))
    distances = made.GetOutputDataObject(3)
    assert vtk_to_numpy(distances.GetPointData().GetArray("Distance")).max() < 0.05


if __name__ == "__main__":
    main()
