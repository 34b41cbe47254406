# SPDX-License-Identifier: BSD-3-Clause
"""What the gallery scripts share: the command line, pictures of spline grids, colours."""
import argparse
import os
import sys
import tarfile

import knotwork
import numpy as np
import vtkmodules.vtkRenderingFreeType  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTextActor,
                                         vtkWindowToImageFilter)

ARCHIVE = "/usr/share/doc/libcgal-dev/data.tar.gz"
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


def leave_out(reason):
    """Ends the script with a status of its own: its pictures cannot be drawn here."""
    print(reason, file=sys.stderr)
    sys.exit(77)


def read_off(name):
    """Vertices and triangles of an OFF mesh in CGAL's archive of data (Debian's libcgal-demo)."""
    if not os.path.exists(ARCHIVE):
        leave_out(f"{ARCHIVE} is missing; install the package libcgal-demo")
    with tarfile.open(ARCHIVE) as archive:
        text = archive.extractfile("data/meshes/" + name).read().decode()
    words = " ".join(line for line in text.splitlines() if not line.startswith("#")).split()
    vertices, faces = int(words[1]), int(words[2])
    numbers = words[4:]
    points = np.array(numbers[:3 * vertices], float).reshape(-1, 3)
    return points, np.array(numbers[3 * vertices:3 * vertices + 4 * faces], int).reshape(-1, 4)[:, 1:]


def triangle_mesh(points, triangles):
    """Polydata of triangles, points in double precision."""
    mesh = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=1))
    cells = vtkCellArray()
    for triangle in triangles:
        cells.InsertNextCell(3, [int(i) for i in triangle])
    mesh.SetPoints(vertices)
    mesh.SetPolys(cells)
    return mesh


def polylines(lines):
    """Polydata with a polyline for every n x 3 array of points."""
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.vstack(lines), deep=1))
    cells = vtkCellArray()
    first = 0
    for line in lines:
        cells.InsertNextCell(len(line), list(range(first, first + len(line))))
        first += len(line)
    polydata = vtkPolyData()
    polydata.SetPoints(points)
    polydata.SetLines(cells)
    return polydata


# Errors of any algorithm, also of those upstream: the scripts must not draw what is left after a failure.
errors = []


def _record(caller, event, text=""):
    errors.append(text)


_record.CallDataType = "string0"
vtkOutputWindow.GetInstance().AddObserver("ErrorEvent", _record)


def updated(algorithm):
    """Runs an algorithm and what it needs, and raises with the first message when something fails."""
    algorithm.Update()
    if errors:
        raise RuntimeError(errors[0].strip())
    return algorithm


def soften(item):
    """Light that leaves no black corners."""
    item.GetProperty().SetAmbient(0.35)
    item.GetProperty().SetDiffuse(0.75)


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
    if lighting:
        soften(result)
    if line_width:
        properties.SetLineWidth(line_width)
        properties.SetRenderLinesAsTubes(False)
    return result


def patches(surface, by="PatchId", lighting=False):
    """An actor of tessellated patches, each (or each value of another cell array) in a colour of its own."""
    ids = vtk_to_numpy(surface.GetCellData().GetArray(by))
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
    result.GetProperty().SetLighting(lighting)
    if lighting:
        soften(result)
    return result


def element_edges(grid, samples=12):
    """Polylines along the edges of the elements of a planar spline grid, evaluated on the spline."""
    return edges_of_boxes(grid, vtk_to_numpy(grid.GetCellData().GetArray("ParametricBounds")),
                          vtk_to_numpy(grid.GetCellData().GetArray("PatchId")), samples)


def patch_edges(grid, samples=100):
    """The same along the edges of the patches."""
    bounds = vtk_to_numpy(grid.GetCellData().GetArray("ParametricBounds"))
    patch = vtk_to_numpy(grid.GetCellData().GetArray("PatchId"))
    ids = np.unique(patch)
    boxes = [np.c_[bounds[patch == p][:, ::2].min(0), bounds[patch == p][:, 1::2].max(0)].ravel() for p in ids]
    return edges_of_boxes(grid, np.array(boxes), ids, samples)


def edges_of_boxes(grid, bounds, patch, samples):
    """Polylines along the edges of parametric boxes of patches."""
    corners = np.linspace(0, 1, samples)
    zero, one = np.zeros(samples), np.ones(samples)
    sides = np.vstack([np.c_[corners, zero], np.c_[corners, one], np.c_[zero, corners], np.c_[one, corners]])
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


def coloured_cells(polydata, array, colours):
    """Flat facets in the colours, each of three shares, that a cell array of whole numbers picks; they begin again after the last."""
    numbers = vtk_to_numpy(polydata.GetCellData().GetArray(array)).astype(int) % len(colours)
    table = (255 * np.asarray(colours)).round().astype(np.uint8)
    polydata.GetCellData().SetScalars(numpy_to_vtk(table[numbers], deep=1))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(polydata)
    result = vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().SetInterpolationToFlat()
    result.GetProperty().SetAmbient(0.55)
    result.GetProperty().SetDiffuse(0.5)
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
    if errors:
        raise RuntimeError(errors[0].strip())
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.SetFileName(file)
    writer.Write()
    print("picture", file)
