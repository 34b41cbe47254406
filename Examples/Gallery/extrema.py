# SPDX-License-Identifier: BSD-3-Clause
"""All summits, pits and passes of a terrain that is fitted to scattered points, with the boxes that hold one each.

usage: extrema.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkGlyph3D
from vtkmodules.vtkFiltersSources import vtkSphereSource

import _scene as scene

KINDS = ((0.00, 0.45, 0.70), (0.84, 0.20, 0.10), (0.95, 0.85, 0.20))  # pits, summits, passes


def terrain(n=60000):
    """Hills of four sizes at random points of the unit square."""
    random = np.random.default_rng(11)
    x, y = random.uniform(size=(2, n))
    z = np.zeros(n)
    for k in range(1, 5):
        turn, first, second = random.uniform(0, 2 * np.pi, 3)
        along, across = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
        z += 0.16 / 1.9 ** k * np.sin(2.6 * 1.7 ** k * along + first) * np.cos(2.6 * 1.7 ** k * across + second)
    cloud, points = vtkPolyData(), vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.c_[x, y, z], deep=1))
    cloud.SetPoints(points)
    return cloud


def balls(points, kind, radius):
    """A ball at every critical point of a kind."""
    kinds = vtk_to_numpy(points.GetPointData().GetArray("Kind"))
    chosen, places = vtkPolyData(), vtkPoints()
    places.SetData(numpy_to_vtk(vtk_to_numpy(points.GetPoints().GetData())[kinds == kind], deep=1))
    chosen.SetPoints(places)
    ball = vtkSphereSource()
    ball.SetRadius(radius)
    ball.SetThetaResolution(24)
    ball.SetPhiResolution(24)
    made = vtkGlyph3D()
    made.SetInputData(chosen)
    made.SetSourceConnection(ball.GetOutputPort())
    made.Update()
    return scene.actor(made.GetOutput(), KINDS[kind], lighting=True)


def outlines(boxes):
    """Edges of the boxes in the plane of the parameters."""
    lines = []
    for u0, u1, v0, v1 in vtk_to_numpy(boxes.GetCellData().GetArray("ParametricBounds")):
        lines.append(np.array(((u0, v0, 0), (u1, v0, 0), (u1, v1, 0), (u0, v1, 0), (u0, v0, 0))))
    return scene.polylines(lines)


def main():
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputData(terrain())
    fit.SetDomain(0, 1, 0, 1)
    fit.SetDegree(3)
    fit.SetTolerance(1e-3)
    surface = scene.updated(fit).GetOutputDataObject(0)
    panels = []
    for lifted, viewport in ((True, (0.0, 0.0, 0.6, 1.0)), (False, (0.6, 0.0, 1.0, 1.0))):
        extrema = knotwork.vtkSplineExtrema()
        extrema.SetInputDataObject(surface)
        extrema.SetOnSurface(lifted)
        points = scene.updated(extrema).GetOutputDataObject(0)
        if lifted:
            mesh = knotwork.vtkSplineTessellate()
            mesh.SetInputDataObject(surface)
            mesh.SetChordalTolerance(3e-4)
            ground = scene.actor(scene.updated(mesh).GetOutputDataObject(0), (0.62, 0.72, 0.62), lighting=True)
            panel = scene.renderer([ground] + [balls(points, kind, 0.011) for kind in range(3)], viewport, flat=False)
            camera = panel.GetActiveCamera()
            camera.SetPosition(*(np.array(camera.GetFocalPoint()) + (0.9, -1.6, 1.5)))
            camera.SetViewUp(0, 0, 1)
            panel.ResetCamera()
            camera.Zoom(1.2)
        else:
            elements = knotwork.vtkSplineParametricMesh()
            elements.SetInputDataObject(surface)
            grid = scene.updated(elements).GetOutputDataObject(0)
            corners = vtk_to_numpy(grid.GetPoints().GetData())
            cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
            mesh = scene.actor(scene.polylines([corners[[*cell, cell[0]]] for cell in cells]), (0.80, 0.83, 0.86), 1.0)
            boxes = scene.actor(outlines(extrema.GetOutputDataObject(1)), scene.INK, 1.5)
            panel = scene.renderer([mesh, boxes] + [balls(points, kind, 0.009) for kind in range(3)], viewport, 1.3)
            numbers = extrema.GetOutputDataObject(2)
            print(", ".join(f"{numbers.GetColumnName(i)} {numbers.GetValue(0, i).ToString()}"
                            for i in range(numbers.GetNumberOfColumns())))
        panels.append(panel)
    scene.save(panels, os.path.join(scene.output_folder(), "extrema.png"), (1050, 430))


if __name__ == "__main__":
    main()
