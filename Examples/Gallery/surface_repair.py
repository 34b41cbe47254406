# SPDX-License-Identifier: BSD-3-Clause
"""Meshes whose triangles meet, of Debian's libcgal-demo: where they do (left), and the walls that stay within what is repaired (right).

usage: surface_repair.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkConnectivityFilter, vtkGlyph3D
from vtkmodules.vtkFiltersSources import vtkSphereSource

import _scene as scene

# a mesh, where it is looked at from, what is up, how near
PARTS = (("cow", (0.35, 0.25, 1.0), (0, 1, 0), 1.3), ("man", (0.3, -1.0, 0.2), (0, 0, 1), 0.9))
RED, BLUE, GREY = (0.85, 0.15, 0.1), (0.15, 0.35, 0.8), (0.8, 0.8, 0.78)
INTERSECTION = 6  # its RepairKind


def balls(actions, kind, radius):
    """A ball at the place of every action of a kind."""
    kinds = vtk_to_numpy(actions.GetCellData().GetArray("Kind"))
    points = vtk_to_numpy(actions.GetPoints().GetData())[kinds == kind]
    places = vtkPolyData()
    places.SetPoints(scene.triangle_mesh(points, np.zeros((0, 3), int)).GetPoints())
    ball = vtkSphereSource()
    ball.SetRadius(radius)
    glyphs = vtkGlyph3D()
    glyphs.SetInputData(places)
    glyphs.SetSourceConnection(ball.GetOutputPort())
    glyphs.SetScaleModeToDataScalingOff()
    return scene.updated(glyphs).GetOutput()


def parts(surface):
    """The largest part, and all others."""
    connected = vtkConnectivityFilter()
    connected.SetInputData(surface)
    connected.SetExtractionModeToAllRegions()
    connected.ColorRegionsOn()
    scene.updated(connected)
    ids = vtk_to_numpy(connected.GetOutput().GetPointData().GetArray("RegionId"))
    points = vtk_to_numpy(surface.GetPoints().GetData())
    triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    largest = ids[triangles[:, 0]] == np.argmax(np.bincount(ids))
    return scene.triangle_mesh(points, triangles[largest]), scene.triangle_mesh(points, triangles[~largest])


def main():
    views = []
    for row, (name, direction, up, zoom) in enumerate(PARTS):
        repair = knotwork.vtkSurfaceRepair()
        mesh = scene.triangle_mesh(*scene.read_off(name + ".off"))
        repair.SetInputDataObject(mesh)
        scene.updated(repair)
        numbers = repair.GetOutputDataObject(2)
        number = lambda column: numbers.GetValueByName(0, column)  # noqa: E731
        print(name, ", ".join(f"{numbers.GetColumnName(i)} {numbers.GetValue(0, i).ToString()}" for i in range(numbers.GetNumberOfColumns())))
        radius = 0.006 * number("Diagonal").ToDouble()
        solid, walls = parts(repair.GetOutputDataObject(0))
        shown = ([scene.actor(mesh, GREY, lighting=True, opacity=0.45), scene.actor(balls(repair.GetOutputDataObject(1), INTERSECTION, radius), RED, lighting=True)],
                 [scene.actor(solid, GREY, lighting=True, opacity=0.3), scene.actor(walls, BLUE, lighting=True)])
        largest = max(number("DistanceFromInput").ToDouble(), number("DistanceToInput").ToDouble()) / number("Diagonal").ToDouble()
        words = (f"{name}: {number('Intersections').ToInt()} pairs of triangles meet",
                 f"{number('InnerWalls').ToInt()} inner walls; at most {largest:.1e} of the diagonal off")
        for column in range(2):
            view = scene.renderer(shown[column], (column / 2, 1 - (row + 1) / 2, (column + 1) / 2, 1 - row / 2), flat=False)
            camera = view.GetActiveCamera()
            camera.SetPosition(*(np.array(camera.GetFocalPoint()) + direction))
            camera.SetViewUp(*up)
            view.ResetCamera()
            camera.Zoom(zoom)
            view.AddViewProp(scene.label(words[column], 0.05, 0.02, 18))
            views.append(view)
    scene.save(views, os.path.join(scene.output_folder(), "surface_repair.png"), (1200, 900))


if __name__ == "__main__":
    main()
