# SPDX-License-Identifier: BSD-3-Clause
"""A torus: the triangles of its boundary (left), and curved tetrahedra of order 2 within them, cut open (right).

usage: tetrahedra.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkFiltersCore import vtkThreshold
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter

import _scene as scene

GREY, BLUE, INK = (0.8, 0.8, 0.78), (0.45, 0.62, 0.85), (0.15, 0.15, 0.2)


def half(grid):
    """Cells whose corners' mean has y > 0, with curved faces."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 10)
    behind = numpy_to_vtk((points[cells[:, :4]].mean(1)[:, 1] > 0).astype(float), deep=1)
    behind.SetName("Behind")
    grid.GetCellData().AddArray(behind)
    threshold = vtkThreshold()
    threshold.SetInputData(grid)
    threshold.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "Behind")
    threshold.SetUpperThreshold(0.5)
    threshold.SetThresholdFunction(vtkThreshold.THRESHOLD_UPPER)
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputConnection(threshold.GetOutputPort())
    surface.SetNonlinearSubdivisionLevel(3)
    return scene.updated(surface).GetOutput(), scene.updated(threshold).GetOutput()


def edges(grid, samples=9):
    """The curved edges of quadratic tetrahedra as lines."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 10)
    ends = np.array(((0, 4, 1), (1, 5, 2), (2, 6, 0), (0, 7, 3), (1, 8, 3), (2, 9, 3)))
    a, m, b = (points[cells[:, ends[:, i]].ravel()] for i in range(3))
    t = np.linspace(0, 1, samples)[None, :, None]
    lines = (1 - t) * (1 - 2 * t) * a[:, None] + 4 * t * (1 - t) * m[:, None] + t * (2 * t - 1) * b[:, None]
    return scene.polylines(list(lines))


def main():
    source = knotwork.vtkSplineSource()
    source.SetShape(knotwork.vtkSplineSource.SOLID_TORUS)
    source.SetAngle(360)
    source.SetInnerRadius(0.45)
    boundary = knotwork.vtkSplineBoundary()
    boundary.SetInputConnection(source.GetOutputPort())
    boundary.SetChordalTolerance(0.02)
    mesher = knotwork.vtkTetGenMesher()
    mesher.SetInputConnection(boundary.GetOutputPort())
    mesher.SetTargetConnection(source.GetOutputPort())
    mesher.SetOrder(2)
    scene.updated(mesher)
    numbers = mesher.GetOutputDataObject(2)
    number = lambda column: numbers.GetValueByName(0, column)  # noqa: E731
    print(", ".join(f"{numbers.GetColumnName(i)} {numbers.GetValue(0, i).ToString()}" for i in range(numbers.GetNumberOfColumns())))
    triangles = scene.actor(boundary.GetOutputDataObject(0), GREY, lighting=True)
    triangles.GetProperty().EdgeVisibilityOn()
    triangles.GetProperty().SetEdgeColor(*INK)
    surface, cells = half(mesher.GetOutputDataObject(0))
    words = (f"{number('BoundaryTriangles').ToInt()} triangles, at most {number('StraightToTarget').ToDouble():.1e} off",
             f"{number('Tetrahedra').ToInt()} tetrahedra of order 2, at most {number('CurvedToTarget').ToDouble():.1e} off")
    shown = ([triangles], [scene.actor(surface, BLUE, lighting=True), scene.actor(edges(cells), INK, 1.2)])
    views = []
    for column in range(2):
        view = scene.renderer(shown[column], (column / 2, 0, (column + 1) / 2, 1), flat=False)
        camera = view.GetActiveCamera()
        camera.SetPosition(*(np.array(camera.GetFocalPoint()) + (0.2, -1.0, 0.8)))
        camera.SetViewUp(0, 0, 1)
        view.ResetCamera()
        camera.Zoom(1.25)
        view.AddViewProp(scene.label(words[column], 0.05, 0.04, 18))
        views.append(view)
    scene.save(views, os.path.join(scene.output_folder(), "tetrahedra.png"), (1200, 450))


if __name__ == "__main__":
    main()
