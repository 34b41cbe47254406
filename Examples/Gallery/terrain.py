# SPDX-License-Identifier: BSD-3-Clause
"""A real terrain as a spline surface (terrain.png).

A terrain of triangles (Debian's gmsh-doc), each divided into sixteen, whose corners are fitted within one metre: the points, coloured by
how far they are from the surface; the surface with the edges of its elements; the surface with contour lines every five metres, draped.
Heights are drawn three times as large. The surface is written beside the picture as terrain.g2.
"""
import gzip
import os
import tempfile

import _scene as scene
import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter
from vtkmodules.vtkIOGeometry import vtkSTLReader
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

TERRAIN = "/usr/share/doc/gmsh-doc/doc/gmsh/demos/api/terrain_stl_data.stl.gz"
TOLERANCE = 1.0
STEP = 5.0
EXAGGERATION = 3.0
CHORD = 0.1  # of triangles and contour lines, metres
BROWN, GREEN = (0.35, 0.22, 0.10), (0.80, 0.86, 0.74)


def read_terrain():
    if not os.path.exists(TERRAIN):
        scene.leave_out(f"{TERRAIN} is missing; install the package gmsh-doc")
    reader = vtkSTLReader()
    with tempfile.NamedTemporaryFile(suffix=".stl") as plain:
        with gzip.open(TERRAIN) as packed:
            plain.write(packed.read())
        plain.flush()
        reader.SetFileName(plain.name)
        divide = vtkLinearSubdivisionFilter()  # the large triangles of flat parts hold no points to fit to
        divide.SetInputConnection(reader.GetOutputPort())
        divide.SetNumberOfSubdivisions(2)
        return scene.updated(divide).GetOutput()


def fitted(mesh):
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputDataObject(mesh)
    fit.SetTolerance(TOLERANCE)
    return scene.updated(fit)


def contours(surface):
    """Lines of equal height, proved to be within CHORD of their level."""
    contour = knotwork.vtkSplineContour()
    contour.SetInputDataObject(surface)
    contour.SetTolerance(CHORD)
    heights = vtk_to_numpy(surface.GetPoints().GetData())[:, 2]
    for level in np.arange(STEP * np.ceil(heights.min() / STEP), heights.max(), STEP):
        contour.AddLevel(level)
    return scene.updated(contour).GetOutputDataObject(0)


def tall(actor):
    actor.SetScale(1, 1, EXAGGERATION)
    return actor


def distances(points):
    """Points from blue (below the surface) over white to red (above it)."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(255)
    for i in range(255):
        share = i / 127.0 - 1.0
        blue, red = (0.10, 0.30, 0.70), (0.80, 0.15, 0.10)
        end = red if share > 0 else blue
        table.SetTableValue(i, *(0.92 + (c - 0.92) * abs(share) for c in end), 1.0)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(points)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(-TOLERANCE, TOLERANCE)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("Distance")
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetRepresentationToPoints()
    actor.GetProperty().SetPointSize(2)
    actor.GetProperty().SetLighting(False)
    return tall(actor)


def view(actors, viewport):
    result = scene.renderer(actors, viewport, flat=False)
    camera = result.GetActiveCamera()
    camera.SetFocalPoint(1325, 1245, 100)
    camera.SetPosition(1325 - 1500, 1245 - 3600, 3300)
    camera.SetViewUp(0, 0, 1)
    result.ResetCamera()
    camera.Zoom(1.25)
    return result


def lifted(lines, by):
    """A little above the surface, so that lines are not buried in its triangles."""
    lines = tall(lines)
    lines.SetPosition(0, 0, by)
    return lines


def main():
    folder = scene.output_folder()
    mesh = read_terrain()
    fit = fitted(mesh)
    surface, points, table = (fit.GetOutputDataObject(port) for port in range(3))
    last = table.GetNumberOfRows() - 1
    numbers = {name: table.GetValueByName(last, name).ToDouble() for name in ("Functions", "MaxError", "PointsOutside")}
    assert numbers["PointsOutside"] == 0 and numbers["MaxError"] <= TOLERANCE, numbers
    writer = knotwork.vtkGoToolsG2Writer()
    writer.SetInputDataObject(surface)
    writer.SetFileName(os.path.join(folder, "terrain.g2"))
    assert writer.Write() == 1
    tessellate = knotwork.vtkSplineTessellate()
    tessellate.SetInputDataObject(surface)
    tessellate.SetChordalTolerance(CHORD)
    skin = scene.updated(tessellate).GetOutputDataObject(0)
    lines = contours(surface)
    third = 1 / 3
    renderers = [
        view([distances(points)], (0, 0, third, 1)),
        view([tall(scene.actor(skin, GREEN, lighting=True)),
              lifted(scene.actor(scene.element_edges(surface), scene.INK, 1), 3)], (third, 0, 2 * third, 1)),
        view([tall(scene.actor(skin, GREEN, lighting=True)), lifted(scene.actor(lines, BROWN, 1.5), 3)], (2 * third, 0, 1, 1))]
    texts = (f"{points.GetNumberOfPoints()} points, off by up to {numbers['MaxError']:.2f} m", f"{numbers['Functions']:.0f} LR functions",
             f"contour lines every {STEP:.0f} m")
    for renderer, text in zip(renderers, texts):
        renderer.AddActor2D(scene.label(text, 0.05, 0.90, 18))
    scene.save(renderers, os.path.join(folder, "terrain.png"), (1500, 420))


main()
