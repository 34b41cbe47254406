# SPDX-License-Identifier: BSD-3-Clause
"""Two rings that are linked without touching, and two that meet: what is found is held against the tori's equations."""
import knotwork
import knotwork_testing
import numpy as np
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkAppendFilter
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter

RADIUS = 2.0


def rings(tube, shift):
    """A torus about z, and one about x that is shifted along y, so that each passes through the other."""
    source = knotwork.vtkSplineSource()
    source.SetShapeName("TorusSurface")
    source.SetAngle(360)
    source.SetOuterRadius(RADIUS)
    source.SetInnerRadius(tube)
    both = vtkAppendFilter()
    both.AddInputConnection(source.GetOutputPort())
    turn = vtkTransform()
    turn.Translate(0, shift, 0)
    turn.RotateY(90)
    moved = vtkTransformFilter()
    moved.SetTransform(turn)
    moved.SetInputConnection(source.GetOutputPort())
    both.AddInputConnection(moved.GetOutputPort())
    return both


def run(tube, shift):
    both = rings(tube, shift)
    intersections = knotwork.vtkFaceIntersections()
    intersections.SetInputConnection(both.GetOutputPort())
    intersections.Update()
    assert intersections.GetErrorCode() == 0
    return intersections.GetOutputDataObject(0), intersections.GetOutputDataObject(1)


def distance(point, tube):
    """Of a point from the torus about z."""
    return np.hypot(np.hypot(point[0], point[1]) - RADIUS, point[2]) - tube


def test_linked_rings_do_not_touch():
    _, table = run(0.9, 2.0)
    assert table.GetValueByName(0, "Verdict").ToString() == "absent"
    assert table.GetValueByName(0, "Faces").ToInt() == 2


def test_thick_rings_meet():
    points, table = run(1.1, 2.0)
    assert table.GetValueByName(0, "Verdict").ToString() == "found"
    x, y, z = points.GetPoint(0)
    assert abs(distance((x, y, z), 1.1)) < 1e-8
    assert abs(distance((z, y - 2.0, x), 1.1)) < 1e-8


knotwork_testing.main(globals())
