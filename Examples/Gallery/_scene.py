# SPDX-License-Identifier: BSD-3-Clause
"""What the gallery scripts share: the command line, pictures of spline grids, colours."""
import argparse
import os

import knotwork
import vtkmodules.vtkRenderingFreeType  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.vtkFiltersCore import vtkTubeFilter
from vtkmodules.vtkCommonDataModel import vtkPolyData
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
