# SPDX-License-Identifier: BSD-3-Clause
"""What examples share: skeletons for template mapping, runs of the map, files, the plot of convergence."""
import knotwork
import numpy as np
import vtkmodules.vtkRenderingContextOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkChartsCore import vtkChart, vtkChartLegend, vtkChartXY, vtkPlotLine
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkRectf, vtkTable
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter
from vtkmodules.vtkRenderingContext2D import vtkContextActor, vtkPen
from vtkmodules.vtkRenderingCore import vtkRenderer

import _scene as scene

CORNERS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)


class Patch:
    """A curve (cells None) or a triangle mesh with its id; points n x d, parameters n or n x 2, normals n x d."""

    def __init__(self, identifier, points, parameters=None, normals=None, triangles=None):
        self.id, self.points, self.triangles = identifier, np.asarray(points, float), triangles
        self.parameters, self.normals = parameters, normals


def named(array, name, dtype=float):
    result = numpy_to_vtk(np.ascontiguousarray(array, dtype), deep=1)
    result.SetName(name)
    return result


def in_space(vectors):
    """n x 3; a plane's vectors get z = 0."""
    vectors = np.asarray(vectors, float)
    return vectors if vectors.shape[1] == 3 else np.c_[vectors, np.zeros(len(vectors))]


def cell_array(cells):
    """Cells that are rows of equally many points, as vtkCellArray."""
    cells = np.asarray(cells, np.int64)
    result = vtkCellArray()
    result.SetData(named(np.arange(len(cells) + 1) * cells.shape[1], "", np.int64),
                   named(cells.ravel(), "", np.int64))
    return result


def skeleton(patches):
    """Polydata of patches with PatchId, and Parameter and Normals where all patches have them."""
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(named(np.vstack([in_space(patch.points) for patch in patches]), "Points"))
    result = vtkPolyData()
    result.SetPoints(points)
    firsts = np.cumsum([0] + [len(patch.points) for patch in patches])
    if patches[0].triangles is None:
        lines = vtkCellArray()
        for patch, first in zip(patches, firsts):
            lines.InsertNextCell(len(patch.points), list(range(first, first + len(patch.points))))
        result.SetLines(lines)
        ids = [patch.id for patch in patches]
    else:
        result.SetPolys(cell_array(np.vstack([first + patch.triangles for patch, first in zip(patches, firsts)])))
        ids = np.concatenate([np.full(len(patch.triangles), patch.id) for patch in patches])
    result.GetCellData().AddArray(named(ids, "PatchId", np.int32))
    if all(patch.parameters is not None for patch in patches):
        result.GetPointData().AddArray(named(np.concatenate([patch.parameters for patch in patches]), "Parameter"))
    if all(patch.normals is not None for patch in patches):
        result.GetPointData().SetNormals(
            named(np.vstack([in_space(patch.normals) for patch in patches]), "Normals"))
    return result


def write(data, file):
    """Polydata or a grid as XML file."""
    writer = vtkXMLPolyDataWriter() if data.IsA("vtkPolyData") else vtkXMLUnstructuredGridWriter()
    writer.SetInputData(data)
    writer.SetFileName(file)
    writer.SetDataModeToBinary()  # which every ParaView reads
    if writer.Write() != 1:
        raise RuntimeError("cannot write " + file)
    print("file", file)


def segment(start, end, count, identifier):
    """A straight patch from start to end; its normals are to the right of the way."""
    share = np.linspace(0, 1, count)
    along = np.subtract(end, start).astype(float)
    normal = np.array([along[1], -along[0]]) / np.hypot(*along)
    return Patch(identifier, start + np.outer(share, along), share, np.tile(normal, (count, 1)))


def box_sides(low, high, count, first_id=0):
    """The four sides of a rectangle, counter-clockwise from its lower side, ids from first_id."""
    corners = np.asarray(low) + CORNERS * np.subtract(high, low)
    return [segment(corners[i], corners[(i + 1) % 4], count, first_id + i) for i in range(4)]


def circle(centre, radius, count, identifier, start=0.0):
    """A circle, counter-clockwise from the angle `start`, outward normals."""
    share = np.linspace(0, 1, count)
    angle = start + 2 * np.pi * share
    normals = np.c_[np.cos(angle), np.sin(angle)]
    return Patch(identifier, centre + radius * normals, share, normals)


def mapped(template, target, **properties):
    """The template mapping of two skeletons after its run; properties by their names."""
    mapping = knotwork.vtkTemplateMapping()
    mapping.SetInputDataObject(0, template)
    mapping.SetInputDataObject(1, target)
    for name, value in properties.items():
        getattr(mapping, "Set" + name)(value)
    return scene.updated(mapping)


def column(mapping, name):
    """A column of the convergence table."""
    return vtk_to_numpy(mapping.GetOutputDataObject(2).GetColumnByName(name))


def certificate(grid):
    """Verdict and injectivity of a spline grid as the validator's words."""
    validator = knotwork.vtkJacobianValidator()
    validator.SetInputDataObject(grid)
    table = scene.updated(validator).GetOutputDataObject(2)
    last = table.GetNumberOfRows() - 1
    return tuple(table.GetValueByName(last, name).ToString() for name in ("Verdict", "Injective"))


def require(claim, text):
    """An example that does not hold what it says stops here."""
    if not claim:
        raise RuntimeError(text)


def plot(series, pixels, viewport, titles, log_x=False, log_y=True, legend=True):
    """A renderer with curves: series are (name, x, y) or (name, x, y, style), a style being (colour, dashed).

    The legend is in the upper right corner (True), half way down ("middle"), or missing (False).
    """
    axes = vtkChartXY()
    axes.SetShowLegend(bool(legend))
    if legend == "middle":
        axes.GetLegend().SetVerticalAlignment(vtkChartLegend.CENTER)
    axes.SetAutoSize(False)
    axes.SetSize(vtkRectf(10, 10, pixels[0] - 20, pixels[1] - 20))
    for number, (name, x, y, *style) in enumerate(series):
        colour, dashed = style[0] if style else (4 + number if number < 3 else number - 3, False)
        table = vtkTable()
        for title, values in (("x" + str(number), x), (name, y)):
            array = vtkFloatArray()
            array.SetName(title)
            for value in values:
                array.InsertNextValue(float(value))
            table.AddColumn(array)
        line = axes.AddPlot(vtkChart.LINE)
        line.SetInputData(table, 0, 1)
        red, green, blue = (int(255 * c) for c in scene.COLOURS[colour])
        line.SetColor(red, green, blue, 255)
        line.SetWidth(2.5)
        line.SetMarkerStyle(vtkPlotLine.CIRCLE if number % 2 == 0 else vtkPlotLine.SQUARE)
        line.SetMarkerSize(9)
        if dashed:
            line.GetPen().SetLineType(vtkPen.DASH_LINE)
            line.SetMarkerSize(6)
    for axis, title, logarithmic in ((1, titles[0], log_x), (0, titles[1], log_y)):
        axis = axes.GetAxis(axis)
        axis.SetTitle(title)
        axis.SetLogScale(logarithmic)
        axis.GetTitleProperties().SetFontSize(15)
        axis.GetTitleProperties().BoldOff()
        axis.GetLabelProperties().SetFontSize(14)
    axes.GetLegend().GetLabelProperties().SetFontSize(14)
    actor = vtkContextActor()
    actor.GetScene().AddItem(axes)
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetViewport(*viewport)
    renderer.AddActor(actor)
    actor.GetScene().SetRenderer(renderer)
    return renderer


def chart(series, file, size, x_title, y_title, log_x=False):
    """A picture of one plot with logarithmic ordinate: all x, y > 0."""
    scene.save([plot(series, size, (0, 0, 1, 1), (x_title, y_title), log_x)], file, size)


def sheet(across, along):
    """A triangulated grid over the unit square: its points, the first coordinate fastest, and its triangles."""
    u, v = np.meshgrid(np.linspace(0, 1, across + 1), np.linspace(0, 1, along + 1))
    first = (np.arange(along)[:, None] * (across + 1) + np.arange(across)).ravel()
    right, up, both = first + 1, first + across + 1, first + across + 2
    return np.c_[u.ravel(), v.ravel()], np.vstack([np.c_[first, right, both], np.c_[first, both, up]])


def basis(count, at, order=0):
    """Cubic B-splines on uniform clamped knots over [0, 1]: rows are places, columns the `count` functions."""
    knots = np.r_[[0.0] * 3, np.linspace(0, 1, count - 2), [1.0] * 3]
    at = np.atleast_1d(at)
    span = np.clip(np.searchsorted(knots, at, "right") - 1, 3, count - 1)
    values = np.zeros((len(at), len(knots) - 1))
    values[np.arange(len(at)), span] = 1
    for degree in range(1, 4):
        raised = np.zeros((len(at), len(knots) - 1 - degree))
        for i in range(raised.shape[1]):
            rise, fall = knots[i + degree] - knots[i], knots[i + degree + 1] - knots[i + 1]
            left = 1 / rise if rise > 0 else 0
            right = 1 / fall if fall > 0 else 0
            if degree > 3 - order:
                raised[:, i] = degree * (left * values[:, i] - right * values[:, i + 1])
            else:
                raised[:, i] = (left * (at - knots[i]) * values[:, i] +
                                right * (knots[i + degree + 1] - at) * values[:, i + 1])
        values = raised
    return values


def interpolated(file, functions, counts):
    """Cubic B-splines that interpolate functions of two or three parameters in [0, 1], each at its own Greville points.

    A function takes arrays of its parameters and returns n x 2 or n x 3 points; counts are the control points a
    direction. The splines go through a GoTools file and come back as a grid with a patch a function.
    """
    knots = [np.r_[[0.0] * 3, np.linspace(0, 1, count - 2), [1.0] * 3] for count in counts]
    places = [(k[1:-3] + k[2:-2] + k[3:-1]) / 3 for k in knots]
    parameters = [a.ravel() for a in np.meshgrid(*places[::-1], indexing="ij")][::-1]
    text = []
    for function in functions:
        values = function(*parameters)
        text += [f"{200 if len(counts) == 2 else 700} 1 0 0", f"{values.shape[1]} 0"]
        text += [f"{count} 4\n" + " ".join(f"{x:.17g}" for x in k) for count, k in zip(counts, knots)]
        values = values.reshape(*counts[::-1], -1)
        for axis, (count, at) in enumerate(zip(counts[::-1], places[::-1])):
            values = np.moveaxis(np.tensordot(np.linalg.inv(basis(count, at)), values, (1, axis)), 0, axis)
        text += [" ".join(f"{x:.17g}" for x in row) for row in values.reshape(-1, values.shape[-1])]
    with open(file, "w") as stream:
        stream.write("\n".join(text) + "\n")
    print("file", file)
    reader = knotwork.vtkGoToolsG2Reader()
    reader.SetFileName(file)
    return scene.updated(reader).GetOutputDataObject(0)
