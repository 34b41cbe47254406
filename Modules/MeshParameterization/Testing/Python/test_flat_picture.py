# SPDX-License-Identifier: BSD-3-Clause
"""The S on a cone in the plane, as a picture."""
import pathlib
import sys

import knotwork
import knotwork_testing
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401: before the first renderer is made
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[4] / "Examples/Gallery"))
from flat_meshes import s_on_cone  # noqa: E402


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
