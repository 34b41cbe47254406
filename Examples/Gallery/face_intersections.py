# SPDX-License-Identifier: BSD-3-Clause
"""Linked rings that are proved not to meet, rings that do, with a point of both, and a sheet that passes through itself.

usage: face_intersections.py [--output DIR]
"""
import os

import knotwork
import numpy as np
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkAppendFilter
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource

import _scene as scene

COLOURS = ((0.55, 0.70, 0.85), (0.93, 0.75, 0.45))
RED = (0.84, 0.20, 0.10)


def ring(tube, turned):
    """A torus about z, or one about x that passes through it."""
    source = knotwork.vtkSplineSource()
    source.SetShapeName("TorusSurface")
    source.SetAngle(360)
    source.SetOuterRadius(2)
    source.SetInnerRadius(tube)
    place = vtkTransform()
    if turned:
        place.Translate(0, 2, 0)
        place.RotateY(90)
    moved = vtkTransformFilter()
    moved.SetTransform(place)
    moved.SetInputConnection(source.GetOutputPort())
    return scene.updated(moved).GetOutput()


def sheet():
    """A cubic sheet that passes through itself: the control points of one element are moved."""
    source = knotwork.vtkSplineSource()
    source.SetShapeName("Square")
    source.SetDegree(3)
    grid = scene.updated(source).GetOutputDataObject(0)
    points = grid.GetPoints()
    profile = ((-3, -2), (7, 3), (-7, 3), (3, -2))
    for i in range(points.GetNumberOfPoints()):
        x, y, _ = points.GetPoint(i)
        along, height = profile[round(3 * (x + 0.5))]
        points.SetPoint(i, along, 3 * y, height)
    return grid


def panel(grids, viewport, place):
    both = vtkAppendFilter()
    actors = []
    for k, grid in enumerate(grids):
        both.AddInputData(grid)
        mesh = knotwork.vtkSplineTessellate()
        mesh.SetInputDataObject(grid)
        mesh.SetChordalTolerance(2e-3)
        actors.append(scene.actor(scene.updated(mesh).GetOutputDataObject(0), COLOURS[k], opacity=0.5, lighting=True))
    intersections = knotwork.vtkFaceIntersections()
    intersections.SetInputConnection(both.GetOutputPort())
    points = scene.updated(intersections).GetOutputDataObject(0)
    table = intersections.GetOutputDataObject(1)
    verdict = table.GetValueByName(0, "Verdict").ToString()
    print(verdict, ", ".join(f"{table.GetColumnName(i)} {table.GetValue(0, i).ToString()}"
                             for i in range(1, table.GetNumberOfColumns())))
    for i in range(points.GetNumberOfPoints()):
        ball = vtkSphereSource()
        ball.SetCenter(points.GetPoint(i))
        ball.SetRadius(0.16)
        ball.SetThetaResolution(32)
        ball.SetPhiResolution(32)
        actors.append(scene.actor(scene.updated(ball).GetOutput(), RED, lighting=True))
    view = scene.renderer(actors, viewport, flat=False)
    view.AddViewProp(scene.label(verdict, 0.05, 0.04))
    camera = view.GetActiveCamera()
    camera.SetPosition(*(np.array(camera.GetFocalPoint()) + place))
    camera.SetViewUp(0, 0, 1)
    view.ResetCamera()
    camera.Zoom(1.3 if len(grids) > 1 else 0.95)
    return view


def main():
    panels = [panel([ring(0.9, False), ring(0.9, True)], (0, 0, 0.36, 1), (5, -6, 5)),
              panel([ring(1.1, False), ring(1.1, True)], (0.36, 0, 0.72, 1), (5, -6, 5)),
              panel([sheet()], (0.72, 0, 1, 1), (3, -9, 2))]
    scene.save(panels, os.path.join(scene.output_folder(), "face_intersections.png"), (1200, 380))


if __name__ == "__main__":
    main()
