# SPDX-License-Identifier: BSD-3-Clause
"""Values at scattered points in space that become a field on an LR B-spline volume (volume_field.png): the points; the field on three
sections of the volume, with the elements that they cut.

usage: volume_field.py [--output DIR]
"""
import os

import _scene as scene
import knotwork
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

NAME, TOLERANCE, LATTICE = "Temperature", 0.01, 160
# Sections: the direction that is constant, and its value.
SECTIONS = ((2, 0.35), (1, 0.65), (0, 0.3))


def temperature(p):
    """A gentle wave with two peaks."""
    peaks = [np.exp(-((p - centre)**2).sum(1) / width**2) for centre, width in (((0.3, 0.65, 0.35), 0.09), ((0.7, 0.4, 0.35), 0.13))]
    return 0.3 * np.sin(3 * p[:, 0] + 2 * p[:, 1]) + 0.2 * p[:, 2] + sum(peaks)


def cloud(points, values):
    made = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    made.SetPoints(vertices)
    if values is not None:
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=1)
        array.SetName(NAME)
        made.GetPointData().SetScalars(array)
    return made


def coloured(polydata, span, size=1.0):
    table = vtkLookupTable()
    table.SetHueRange(0.66, 0.0)
    table.SetSaturationRange(0.75, 0.75)
    table.Build()
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(polydata)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(*span)
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(2, 40)  # behind the edges of elements
    result = vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().SetLighting(False)
    result.GetProperty().SetPointSize(size)
    return result


def placed(direction, value, first, second):
    """Points whose coordinate in a direction is constant."""
    points = np.full((len(first), 3), value)
    points[:, [d for d in range(3) if d != direction]] = np.c_[first, second]
    return points


def section(volume, direction, value, span):
    """The field, evaluated on a lattice; its elements' edges."""
    boxes = vtk_to_numpy(volume.GetCellData().GetArray("ParametricBounds")).reshape(-1, 3, 2)
    rest = [d for d in range(3) if d != direction]
    a, b = (m.ravel() for m in np.meshgrid(*(np.linspace(boxes[:, d, 0].min(), boxes[:, d, 1].max(), LATTICE) for d in rest)))
    points = placed(direction, value, a, b)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, volume)
    evaluate.SetInputDataObject(1, cloud(points, None))
    found = scene.updated(evaluate).GetOutputDataObject(0)
    surface = cloud(points, vtk_to_numpy(found.GetPointData().GetArray(NAME)))
    k = (np.arange(LATTICE - 1)[:, None] * LATTICE + np.arange(LATTICE - 1)).ravel()
    cells = vtkCellArray()
    cells.SetData(4, numpy_to_vtk(np.c_[k, k + 1, k + LATTICE + 1, k + LATTICE].ravel().astype(np.int64), deep=1,
                                  array_type=cells.GetConnectivityArray().GetDataType()))
    surface.SetPolys(cells)
    boxes = boxes[(boxes[:, direction, 0] <= value) & (boxes[:, direction, 1] > value)]
    lines = [placed(direction, value, box[rest[0]][[0, 1, 1, 0, 0]], box[rest[1]][[0, 0, 1, 1, 0]]) for box in boxes]
    return [coloured(surface, span), scene.actor(scene.polylines(lines), (0.15, 0.15, 0.15), 1)]


def seen(shown):
    camera = shown.GetActiveCamera()
    camera.SetFocalPoint(0.5, 0.5, 0.5)
    camera.SetPosition(3.2, -3.4, 2.9)
    camera.SetViewUp(0, 0, 1)
    shown.ResetCamera(0, 1, 0, 1, 0, 1)
    camera.Zoom(1.25)
    return shown


def main():
    points = np.random.default_rng(3).uniform(size=(60000, 3))
    values = temperature(points)
    span = values.min(), values.max()
    samples = cloud(points, values)
    fit = knotwork.vtkSplineVolumeFit()
    fit.SetInputDataObject(samples)
    fit.SetTolerance(TOLERANCE)
    volume = scene.updated(fit).GetOutputDataObject(0)
    table = fit.GetOutputDataObject(2)
    functions = table.GetValueByName(table.GetNumberOfRows() - 1, "Functions").ToInt()

    vertices = vtkCellArray()
    chosen = range(0, len(points), 6)
    for i in chosen:
        vertices.InsertNextCell(1, [i])
    samples.SetVerts(vertices)
    panels = [seen(scene.renderer([coloured(samples, span, 3)], (0, 0, 0.5, 1), flat=False))]
    items = [item for direction, value in SECTIONS for item in section(volume, direction, value, span)]
    panels.append(seen(scene.renderer(items, (0.5, 0, 1, 1), flat=False)))
    panels[0].AddActor(scene.label(f"{len(points)} values in space (every sixth is drawn)", 0.04, 0.03, 14))
    panels[1].AddActor(scene.label(f"LR volume of {functions} functions, within {TOLERANCE}", 0.04, 0.03, 14))
    scene.save(panels, os.path.join(scene.output_folder(), "volume_field.png"), (1100, 520))


if __name__ == "__main__":
    main()
