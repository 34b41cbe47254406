# SPDX-License-Identifier: BSD-3-Clause
"""Spline Stitch in ParaView: several inputs, sides found by geometry, tables."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import KnotworkSplineSource, SplineStitch  # noqa: E402


def square(x):
    return KnotworkSplineSource(Shape="Square", Degree=2, Elements=(4, 4, 1), Center=(x, 0, 0))


def test_two_squares_as_two_inputs():
    stitch = SplineStitch(Input=[square(0), square(1)], Matching="Geometry")
    stitch.UpdatePipeline()
    numbers = stitch.GetClientSideObject().GetOutputDataObject(2)
    assert numbers.GetValueByName(0, "Edges").ToInt() == 1
    assert numbers.GetValueByName(0, "MaxChange").ToDouble() < 1e-14
    assert stitch.GetClientSideObject().GetOutputDataObject(1).GetColumnByName("JumpBefore") is not None


def test_pairs():
    stitch = SplineStitch(Input=[square(0), square(3)], Matching="Pairs", Continuity=0)
    stitch.Pairs = [0, 1, 1, 0, 0]
    stitch.UpdatePipeline()
    numbers = stitch.GetClientSideObject().GetOutputDataObject(2)
    assert abs(numbers.GetValueByName(0, "MaxChange").ToDouble() - 1) < 1e-12
    assert numbers.GetValueByName(0, "MaxJump").ToDouble() < 1e-13


knotwork_testing.main(globals())
