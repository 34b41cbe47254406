# SPDX-License-Identifier: BSD-3-Clause
"""The picture of the contours: a fitted surface with a cliff, a pass and loops smaller than its elements.

usage: contours.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkTubeFilter

import _scene as scene

GROUND, CLOSED, OPEN = (0.86, 0.88, 0.83), (0.84, 0.37, 0.0), (0.0, 0.35, 0.6)


def height(x, y):
    hills = 0.10 * np.sin(9 * x + 0.5) * np.sin(8 * y) + 0.04 * np.sin(23 * x) * np.cos(21 * y + 0.3)
    cliff = 0.09 * np.tanh((y - 0.45 - 0.1 * np.sin(6 * x)) / 0.02)
    return hills + cliff


def fitted(points=40000, tolerance=2e-3):
    xy = np.random.default_rng(3).uniform(size=(points, 2))
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(np.c_[xy, height(*xy.T)], deep=1))
    cloud = vtkPolyData()
    cloud.SetPoints(places)
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputData(cloud)
    fit.SetDomain(0, 1, 0, 1)
    fit.SetTolerance(tolerance)
    return scene.updated(fit).GetOutputDataObject(0)


def contoured(surface, levels, **properties):
    made = knotwork.vtkSplineContour()
    made.SetInputData(surface)
    for level in levels:
        made.AddLevel(level)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    return scene.updated(made).GetOutputDataObject(0)


def tubes(lines, radius, colour, closed):
    """The closed or the open lines as tubes."""
    chosen = vtk_to_numpy(lines.GetCellData().GetArray("Closed")) == closed
    runs = []
    points = vtk_to_numpy(lines.GetPoints().GetData())
    for cell in np.flatnonzero(chosen):
        ids = lines.GetCell(int(cell)).GetPointIds()
        runs.append(points[[ids.GetId(i) for i in range(ids.GetNumberOfIds())]])
    made = vtkTubeFilter()
    made.SetInputData(scene.polylines(runs))
    made.SetRadius(radius)
    made.SetNumberOfSides(10)
    made.Update()
    return scene.actor(made.GetOutput(), colour, lighting=True)


def samples(surface, axes):
    """Heights at a grid of parameters."""
    x, y = np.meshgrid(*axes, indexing="ij")
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(np.c_[x.ravel(), y.ravel(), 0 * x.ravel()], deep=1))
    wanted = vtkPolyData()
    wanted.SetPoints(places)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, surface)
    evaluate.SetPointsData(wanted)
    points = scene.updated(evaluate).GetOutputDataObject(0).GetPoints()
    return vtk_to_numpy(points.GetData())[:, 2].reshape(x.shape)


def landmarks(surface):
    """The highest summit away from the border: where and how high; and the height of the pass nearest to it."""
    low, high = np.array((0.2, 0.2)), np.array((0.8, 0.8))
    for _ in range(7):
        axes = [np.linspace(low[d], high[d], 101) for d in range(2)]
        heights = samples(surface, axes)
        at = np.unravel_index(heights.argmax(), heights.shape)
        summit = np.array([axes[d][at[d]] for d in range(2)])
        low, high = summit - 3 * (high - low) / 100, summit + 3 * (high - low) / 100
    axes = [np.linspace(c - 0.12, c + 0.12, 481) for c in summit]
    z = samples(surface, axes)
    ring = np.stack([np.roll(z, shift, (0, 1)) for shift in
                     ((1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))]) > z
    passes = ((ring != np.roll(ring, 1, 0)).sum(0) == 4)[1:-1, 1:-1]
    where = np.argwhere(passes) + 1
    nearest = where[((where - 240) ** 2).sum(1).argmin()] if len(where) else (0, 0)
    return summit, heights.max(), z[tuple(nearest)]


def main():
    folder = scene.output_folder()
    surface = fitted()
    tessellate = knotwork.vtkSplineTessellate()
    tessellate.SetInputData(surface)
    tessellate.SetChordalTolerance(3e-4)
    ground = scene.updated(tessellate).GetOutputDataObject(0)
    lines = contoured(surface, np.arange(-0.22, 0.221, 0.02), Tolerance=1e-5)
    number = lines.GetNumberOfLines()
    left = scene.renderer([scene.actor(ground, GROUND, lighting=True), tubes(lines, 1.6e-3, CLOSED, 1),
                           tubes(lines, 1.6e-3, OPEN, 0)], (0, 0, 0.62, 1), flat=False)
    camera = left.GetActiveCamera()
    camera.SetFocalPoint(0.5, 0.5, 0)
    camera.SetPosition(0.5, -1.0, 1.4)
    camera.SetViewUp(0, 0, 1)
    left.ResetCamera()
    camera.Zoom(1.35)
    left.AddActor(scene.label(f"{number} contours, closed ones orange", 0.04, 0.03, 14))

    # from above with the elements: around a summit and a pass, levels a millionth and more below and beside them
    summit, top, pass_height = landmarks(surface)
    levels = [*np.arange(-0.22, 0.221, 0.01), *(top - 1e-6 * 10.0 ** np.arange(4)), pass_height - 1e-6, pass_height + 1e-6]
    flat = contoured(surface, levels, Tolerance=1e-8, ProjectToLevel=True)
    vtk_to_numpy(flat.GetPoints().GetData())[:, 2] = 0.01
    edges = scene.element_edges(surface)
    vtk_to_numpy(edges.GetPoints().GetData())[:, 2] = 0
    right = scene.renderer([scene.actor(edges, (0.7, 0.7, 0.7), 1), tubes(flat, 3e-4, CLOSED, 1),
                            tubes(flat, 3e-4, OPEN, 0)], (0.62, 0, 1, 1), flat=False)
    camera = right.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*summit, 0)
    camera.SetPosition(*summit, 5)
    camera.SetViewUp(0, 1, 0)
    camera.SetParallelScale(0.09)
    right.ResetCameraClippingRange()
    scene.save([left, right], os.path.join(folder, "contours.png"), (1200, 560))


if __name__ == "__main__":
    main()
