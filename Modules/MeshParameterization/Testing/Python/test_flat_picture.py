# SPDX-License-Identifier: BSD-3-Clause
"""The S on a cone in the plane, as a picture."""
import math

import knotwork
import knotwork_testing
import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401: before the first renderer is made
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer


def s_on_cone(edge=0.1):
    """A stroke in the shape of an S, drawn on a cone without distortion."""
    nx, ny = round(3 / edge), round(5 / edge)
    x, y = np.meshgrid(np.linspace(1.5, 4.5, nx + 1), np.linspace(-2.5, 2.5, ny + 1))
    flat = np.c_[x.ravel(), y.ravel()]
    first = (np.arange(ny)[:, None] * (nx + 1) + np.arange(nx)).ravel()
    triangles = np.vstack([np.c_[first, first + 1, first + nx + 2], np.c_[first, first + nx + 2, first + nx + 1]])
    centres = flat[triangles].mean(1)

    def arc(centre, start):
        to = centres - centre
        angle = (np.arctan2(to[:, 1], to[:, 0]) - start) % (2 * math.pi)
        return (angle < 1.5 * math.pi) & (abs(np.hypot(*to.T) - 1) < 0.3)

    triangles = triangles[arc((3, 1), 0) | arc((3, -1), math.pi)]
    used, cells = np.unique(triangles, return_inverse=True)
    radius, turn = np.hypot(*flat[used].T), 2 * np.arctan2(flat[used, 1], flat[used, 0])
    points = np.c_[0.5 * radius * np.cos(turn), 0.5 * radius * np.sin(turn), -math.sqrt(0.75) * radius]
    mesh = vtkPolyData()
    vertices = vtkPoints()
    vertices.SetDataTypeToDouble()
    vertices.SetData(numpy_to_vtk(points, deep=1))
    faces = vtkCellArray()
    for cell in cells.reshape(-1, 3):
        faces.InsertNextCell(3, [int(i) for i in cell])
    mesh.SetPoints(vertices)
    mesh.SetPolys(faces)
    return mesh


def actor(data, colour, width=1):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    result = vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().SetColor(*colour)
    result.GetProperty().SetLighting(False)
    result.GetProperty().SetLineWidth(width)
    return result


def draw(method):
    parameterization = knotwork.vtkMeshParameterization()
    parameterization.SetInputDataObject(s_on_cone())
    parameterization.SetMethod(method)
    parameterization.FlatOutputOn()
    parameterization.Update()
    renderer = vtkRenderer()
    renderer.AddActor(actor(parameterization.GetOutputDataObject(0), (1, 0.9, 0.3)))
    renderer.AddActor(actor(parameterization.GetOutputDataObject(1), (0.1, 0.1, 0.4), 2))
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(0, 0, 5)
    camera.SetFocalPoint(0, 0, 0)
    camera.SetParallelScale(2.8)
    return renderer


def test_hlle_draws_the_letter():
    knotwork_testing.render_and_compare(draw(knotwork.vtkMeshParameterization.HLLE), "FlatLetter")


def test_isomap_does_not():
    try:
        knotwork_testing.render_and_compare(draw(knotwork.vtkMeshParameterization.ISOMAP), "FlatLetter")
    except AssertionError:
        return
    raise AssertionError("the picture of the folded letter passes")


knotwork_testing.main(globals())
