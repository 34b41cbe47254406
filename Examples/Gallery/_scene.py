# SPDX-License-Identifier: BSD-3-Clause
"""What the gallery scripts share: the command line, pictures of spline grids, colours."""
import argparse
import os

import knotwork
import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTextActor,
                                         vtkWindowToImageFilter)

INK = (0.12, 0.14, 0.18)
# Okabe and Ito's palette: told apart by everybody.
COLOURS = ((0.34, 0.71, 0.91), (0.90, 0.62, 0.00), (0.00, 0.62, 0.45), (0.95, 0.90, 0.25), (0.00, 0.45, 0.70),
           (0.84, 0.37, 0.00), (0.80, 0.47, 0.65))


def output_folder():
    """The folder that `--output DIR` names; made when it is not there."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--output", default=".", help="folder for pictures and files")
    folder = parser.parse_args().output
    os.makedirs(folder, exist_ok=True)
    return folder


def updated(algorithm):
    """Runs an algorithm and raises with its own message when it fails."""
    messages = []

    def record(caller, event, text=""):
        messages.append(text)

    record.CallDataType = "string0"
    algorithm.AddObserver("ErrorEvent", record)
    algorithm.Update()
    if messages:
        raise RuntimeError(messages[0].strip())
    return algorithm


def actor(polydata, colour, line_width=None, opacity=1.0, lighting=False):
    """A flat actor of polydata in one colour."""
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(polydata)
    mapper.ScalarVisibilityOff()
    result = vtkActor()
    result.SetMapper(mapper)
    properties = result.GetProperty()
    properties.SetColor(*colour)
    properties.SetOpacity(opacity)
    properties.SetLighting(lighting)
    if line_width:
        properties.SetLineWidth(line_width)
        properties.SetRenderLinesAsTubes(False)
    return result


def patches(surface):
    """An actor of tessellated patches, each in a colour of its own."""
    ids = vtk_to_numpy(surface.GetCellData().GetArray("PatchId"))
    table = (255 * np.array(COLOURS)).round().astype(np.uint8)
    colours = numpy_to_vtk(table[ids % len(table)], deep=1)
    coloured = vtkPolyData()
    coloured.ShallowCopy(surface)
    coloured.GetCellData().SetScalars(colours)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(coloured)
    mapper.SetScalarModeToUseCellData()
    result = vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().LightingOff()
    return result


def element_edges(grid, samples=12):
    """Polylines along the edges of the elements of a planar spline grid, evaluated on the spline."""
    corners = np.linspace(0, 1, samples)
    zero, one = np.zeros(samples), np.ones(samples)
    sides = np.vstack([np.c_[corners, zero], np.c_[corners, one], np.c_[zero, corners], np.c_[one, corners]])
    bounds = vtk_to_numpy(grid.GetCellData().GetArray("ParametricBounds"))
    patch = vtk_to_numpy(grid.GetCellData().GetArray("PatchId"))
    parameters = (bounds[:, None, (0, 2)] + sides[None] * (bounds[:, None, (1, 3)] - bounds[:, None, (0, 2)]))
    parameters = parameters.reshape(-1, 2)
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.c_[parameters, np.zeros(len(parameters))], deep=1))
    lines = vtkCellArray()
    for first in range(0, len(parameters), samples):
        lines.InsertNextCell(samples, list(range(first, first + samples)))
    polydata = vtkPolyData()
    polydata.SetPoints(points)
    polydata.SetLines(lines)
    ids = numpy_to_vtk(np.repeat(patch, len(sides)).astype(np.int32), deep=1)
    ids.SetName("PatchId")
    polydata.GetPointData().AddArray(ids)
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputDataObject(0, grid)
    evaluate.SetInputDataObject(1, polydata)
    return updated(evaluate).GetOutputDataObject(0)


def label(text, x, y, size=22):
    """A line of text at a position of the renderer, in shares of its size."""
    result = vtkTextActor()
    result.SetInput(text)
    result.GetTextProperty().SetFontSize(size)
    result.GetTextProperty().SetColor(*INK)
    coordinate = result.GetPositionCoordinate()
    coordinate.SetCoordinateSystemToNormalizedViewport()
    coordinate.SetValue(x, y)
    return result


def renderer(actors, viewport=(0, 0, 1, 1), zoom=1.0, flat=True):
    """A renderer on white that shows all actors, from above when flat."""
    result = vtkRenderer()
    result.SetBackground(1, 1, 1)
    result.SetViewport(*viewport)
    for item in actors:
        result.AddActor(item)
    if flat:
        result.GetActiveCamera().ParallelProjectionOn()
    result.ResetCamera()
    result.GetActiveCamera().Zoom(zoom)
    return result


def save(renderers, file, size):
    """Renders side by side and writes a PNG."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*size)
    for item in renderers:
        window.AddRenderer(item)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(file)
    writer.Write()
    print("picture", file)
