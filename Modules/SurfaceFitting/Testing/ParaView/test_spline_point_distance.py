# SPDX-License-Identifier: BSD-3-Clause
"""Spline Point Distance in ParaView: classes of points over a fitted surface, and closest points of a torus."""
import math

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import (  # noqa: E402
    KnotworkSplineSource, OutputPort, Plane, Sphere, SplinePointDistance, SplineSurfaceFit, Transform)


def number(distance, column):
    distance.UpdatePipeline()
    return distance.GetClientSideObject().GetOutputDataObject(2).GetValueByName(0, column)


def test_points_above_a_height_field():
    ground = Plane(XResolution=12, YResolution=12)
    above = Transform(Input=ground)
    above.Transform.Translate = [0, 0, 0.25]
    surface = SplineSurfaceFit(Input=ground, Tolerance=0.001)
    distance = SplinePointDistance(Input=above, Surface=surface, Tolerances=[0.1, 0.2, 0.3])
    assert number(distance, "Kind").ToString() == "vertical"
    points = distance.GetPointDataInformation()
    for name, value in (("Distance", 0.25), ("DistanceClass", 2), ("SurfacePatchId", 0)):
        lowest, highest = points.GetArray(name).GetRange()
        assert abs(lowest - value) < 1e-12 and abs(highest - value) < 1e-12, (name, lowest, highest)
    assert OutputPort(distance, 1).GetDataInformation().GetNumberOfRows() == 7


def test_closest_points_of_a_torus():
    torus = KnotworkSplineSource(Shape="Torus Surface", Angle=360)
    distance = SplinePointDistance(Input=Sphere(Radius=1e-3), Surface=torus, Kind="Closest")
    assert number(distance, "Kind").ToString() == "closest"
    hole = abs(number(distance, "Mean").ToDouble())
    assert hole > 0 and math.isclose(hole, abs(number(distance, "Max").ToDouble()), rel_tol=0.01), hole


knotwork_testing.main(globals())
