# SPDX-License-Identifier: BSD-3-Clause
"""Small template-mapping cases as files: a circle in the unit square, carried onto a lobed curve."""
import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

CORNERS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)


def curves(amplitude, lobes, samples, skew=0.0):
    """Four sides of the unit square and the closed curve r = 0.25 (1 + amplitude cos(lobes a)) about its centre, passed
    through with the speed of t + skew sin(2 pi t) / (2 pi)."""
    share = np.linspace(0, 1, samples)
    sides = [CORNERS[i] + np.outer(share, CORNERS[(i + 1) % 4] - CORNERS[i]) for i in range(4)]
    angle = 2 * np.pi * share + skew * np.sin(2 * np.pi * share)
    radius = 0.25 * (1 + amplitude * np.cos(lobes * angle))
    return sides + [0.5 + radius[:, None] * np.c_[np.cos(angle), np.sin(angle)]]


def polydata(lines, ids=None):
    """One polyline a curve with PatchId 0, 1, ... or the given ids."""
    result = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.vstack([np.c_[line, np.zeros(len(line))] for line in lines]), deep=1))
    result.SetPoints(points)
    cells = vtkCellArray()
    first = 0
    for line in lines:
        cells.InsertNextCell(len(line), list(range(first, first + len(line))))
        first += len(line)
    result.SetLines(cells)
    patch = numpy_to_vtk(np.array(range(len(lines)) if ids is None else ids, np.int32), deep=1)
    patch.SetName("PatchId")
    result.GetCellData().AddArray(patch)
    return result


def ball(resolution=16):
    """Sphere of radius 0.3 about (0.5, 0.5, 0.5) as triangles with PatchId 0."""
    sphere = vtkSphereSource()
    sphere.SetRadius(0.3)
    sphere.SetCenter(0.5, 0.5, 0.5)
    sphere.SetThetaResolution(resolution)
    sphere.SetPhiResolution(resolution)
    sphere.SetOutputPointsPrecision(1)
    sphere.Update()
    result = vtkPolyData()
    result.DeepCopy(sphere.GetOutput())
    result.GetPointData().Initialize()
    patch = numpy_to_vtk(np.zeros(result.GetNumberOfCells(), np.int32), deep=1)
    patch.SetName("PatchId")
    result.GetCellData().AddArray(patch)
    return result


def points(data):
    """The coordinates, to be changed in place."""
    return vtk_to_numpy(data.GetPoints().GetData())


def write(data, file):
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.SetFileName(file)
    assert writer.Write() == 1
    return file
