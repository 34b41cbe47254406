# SPDX-License-Identifier: BSD-3-Clause
"""Spline Extrema in ParaView: the points and boxes of a coordinate on a torus."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import KnotworkSplineSource, OutputPort, SplineExtrema  # noqa: E402


def test_a_torus():
    torus = KnotworkSplineSource(Shape="Torus Surface", Angle=270)
    extrema = SplineExtrema(Input=torus, Component=0)
    extrema.UpdatePipeline()
    numbers = extrema.GetClientSideObject().GetOutputDataObject(2)
    points = sum(numbers.GetValueByName(0, name).ToInt() for name in ("Minima", "Maxima", "Saddles"))
    assert points > 0
    assert extrema.GetDataInformation().GetNumberOfPoints() == points
    boxes = OutputPort(extrema, 1).GetCellDataInformation()
    assert boxes.GetArray("Unique") is not None and boxes.GetArray("ParametricBounds") is not None


knotwork_testing.main(globals())
