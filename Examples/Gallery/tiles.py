# SPDX-License-Identifier: BSD-3-Clause
"""Noisy tiles that were fitted apart, before and after they are stitched, and what the stitching has changed (tiles.png); a cloud with a
hole and a bay, and the fitted surface trimmed to it (cropped.png).

usage: tiles.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkThreshold
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

import _scene as scene

GROUND = (0.62, 0.72, 0.80)


def cloud(points):
    """Points as polydata with vertices."""
    made, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    for i in range(len(points)):
        cells.InsertNextCell(1, [i])
    made.SetPoints(places)
    made.SetVerts(cells)
    return made


def height(x, y):
    return 0.25 * np.sin(2.2 * x) * np.cos(1.7 * y) + 0.3 * np.exp(-6 * (x - 1.05) ** 2 - 5 * (y - 0.95) ** 2)


def fitted(points, domain, tolerance):
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputData(cloud(points))
    fit.SetDomain(*domain)
    fit.SetTolerance(tolerance)
    return scene.updated(fit).GetOutputDataObject(0)


def tile(column, row):
    """A tile of a survey whose heights are off by a little of its own."""
    random = np.random.default_rng(2 * row + column)
    x, y = random.uniform(size=(2, 6000)) + np.array(((column,), (row,)))
    z = height(x, y) + 0.004 * random.normal(size=len(x)) + (-0.02, 0.015, 0.02, -0.01)[2 * row + column]
    return fitted(np.c_[x, y, z], (column, column + 1, row, row + 1), 0.02)


def tessellated(grid, tolerance):
    made = knotwork.vtkSplineTessellate()
    made.SetInputDataObject(grid)
    made.SetChordalTolerance(tolerance)
    return scene.updated(made).GetOutputDataObject(0)


def shining(polydata, colour=GROUND):
    result = scene.actor(polydata, colour, lighting=True)
    result.GetProperty().SetSpecular(0.7)
    result.GetProperty().SetSpecularPower(40)
    return result


def coloured(polydata, largest):
    """Blue to red by height, which is a difference."""
    table = vtkLookupTable()
    table.SetHueRange(0.66, 0.0)
    table.Build()
    z = numpy_to_vtk(np.ascontiguousarray(vtk_to_numpy(polydata.GetPoints().GetData())[:, 2]), deep=1)
    polydata.GetPointData().SetScalars(z)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(polydata)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(-largest, largest)
    made = vtkActor()
    made.SetMapper(mapper)
    made.SetScale(1, 1, 6)
    return made


def panel(actors, viewport, text, zoom=1.15):
    made = scene.renderer(actors, viewport, flat=False)
    camera = made.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + (-0.6, -1.7, 1.8)))
    camera.SetViewUp(0, 0, 1)
    made.ResetCamera()
    camera.Zoom(zoom)
    made.AddActor(scene.label(text, 0.04, 0.93, 20))
    return made


def tiles_picture(folder):
    stitch = knotwork.vtkSplineStitch()
    inputs = [tile(k % 2, k // 2) for k in range(4)]
    for grid in inputs:
        stitch.AddInputDataObject(grid)
    result = scene.updated(stitch).GetOutputDataObject(0)
    numbers = stitch.GetOutputDataObject(2)
    print(", ".join(f"{numbers.GetColumnName(i)} {numbers.GetValue(0, i).ToString()}"
                    for i in range(numbers.GetNumberOfColumns())))
    changes = []
    for k, grid in enumerate(inputs):
        after = stitched_patch(result, k)
        combine = knotwork.vtkSplineCombine()
        combine.SetInputDataObject(0, after)
        combine.SetInputDataObject(1, grid)
        changes.append(coloured(tessellated(scene.updated(combine).GetOutputDataObject(0), 1e-4), 0.02))
    before = [shining(tessellated(grid, 5e-4)) for grid in inputs]
    after = shining(tessellated(result, 5e-4))
    scene.save([panel(before, (0, 0, 0.34, 1), "fitted apart"), panel([after], (0.34, 0, 0.67, 1), "stitched, C1"),
                panel(changes, (0.67, 0, 1, 1), "what has changed, 6 x")],
               os.path.join(folder, "tiles.png"), (1260, 400))


def stitched_patch(grid, patch):
    """One patch of a spline grid."""
    made = vtkThreshold()
    made.SetInputData(grid)
    made.SetInputArrayToProcess(0, 0, 0, 1, "PatchId")
    made.SetLowerThreshold(patch)
    made.SetUpperThreshold(patch)
    return scene.updated(made).GetOutput()


def cropped_picture(folder):
    random = np.random.default_rng(4)
    x, y = random.uniform(0, 2, size=(2, 60000))
    lake = np.hypot((x - 1.3) / 0.32, (y - 0.75) / 0.22) < 1
    bay = np.hypot(x - 0.1, y - 1.7) < 0.55
    river = abs(y - 0.35 - 0.15 * np.sin(4 * x)) < 0.012  # narrower than the cells
    keep = ~lake & ~bay & ~river & (y < 1.85 + 0.1 * np.sin(5 * x))
    points = np.c_[x, y, height(x, y)][keep]
    surface = fitted(points, (0, 2, 0, 2), 0.002)
    crop = knotwork.vtkSplineTrimToPoints()
    crop.SetInputDataObject(0, surface)
    crop.SetPointsData(cloud(points))
    scene.updated(crop)
    numbers = crop.GetOutputDataObject(3)
    print(", ".join(f"{numbers.GetColumnName(i)} {numbers.GetValue(0, i).ToString()}"
                    for i in range(numbers.GetNumberOfColumns())))
    dots = scene.actor(cloud(points[::2]), scene.INK)
    dots.GetProperty().SetPointSize(1)
    curves = knotwork.vtkSplineTessellate()
    curves.SetInputDataObject(crop.GetOutputDataObject(2))
    curves.SetChordalTolerance(1e-3)
    rim = scene.actor(scene.updated(curves).GetOutputDataObject(0), (0.84, 0.37, 0.0), 3)
    scene.save([panel([dots], (0, 0, 0.5, 1), "the cloud"),
                panel([shining(crop.GetOutputDataObject(0)), rim], (0.5, 0, 1, 1), "its surface, trimmed to it")],
               os.path.join(folder, "cropped.png"), (1100, 420))


def main():
    folder = scene.output_folder()
    tiles_picture(folder)
    cropped_picture(folder)


if __name__ == "__main__":
    main()
