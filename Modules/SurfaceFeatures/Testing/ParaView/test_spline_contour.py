# SPDX-License-Identifier: BSD-3-Clause
"""Spline Contour in ParaView: levels, outputs, coordinates."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import KnotworkSplineSource, OutputPort, SplineContour  # noqa: E402


def test_levels_of_a_coordinate():
    square = KnotworkSplineSource(Shape="Square", Degree=2, Elements=(4, 4, 1))
    contour = SplineContour(Input=square, Component=0, Curves=1)
    contour.Levels = [-0.25, 0.125]
    contour.UpdatePipeline()
    lines = contour.GetClientSideObject().GetOutputDataObject(0)
    assert lines.GetNumberOfLines() == 2
    for i in range(lines.GetNumberOfPoints()):
        x = lines.GetPoint(i)[0]
        assert min(abs(x + 0.25), abs(x - 0.125)) < 1e-12, x
    assert OutputPort(contour, 1).GetCellDataInformation().GetArray("Level") is not None
    table = contour.GetClientSideObject().GetOutputDataObject(2)
    assert [table.GetValueByName(i, "Components").ToInt() for i in range(2)] == [1, 1]


def test_a_torus_has_closed_contours():
    contour = SplineContour(Input=KnotworkSplineSource(Shape="Torus Surface", Angle=360), NumberOfLevels=4)
    contour.UpdatePipeline()
    table = contour.GetClientSideObject().GetOutputDataObject(2)
    assert [table.GetValueByName(i, "Closed").ToInt() for i in range(4)] == [2] * 4


knotwork_testing.main(globals())
