# SPDX-License-Identifier: BSD-3-Clause
"""Spline Contour in ParaView: levels, outputs, coordinates."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Calculator, KnotworkSplineSource, OutputPort, SplineContour, SplineExtrema  # noqa: E402


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


def test_fields_are_a_choice_of_the_arrays():
    """Arrays of the input and None, which is chosen first, are offered; contours of a field that is x are those of x."""
    square = KnotworkSplineSource(Shape="Square", Degree=2, Elements=(4, 4, 1))
    with_field = Calculator(Input=square, ResultArrayName="Depth", Function="coordsX")
    with_field.UpdatePipeline()
    for made in (SplineContour(Input=with_field), SplineExtrema(Input=with_field)):
        assert made.FieldName == "None", made.FieldName
        offered = list(made.GetProperty("FieldName").GetAvailable())
        assert {"None", "Depth"} <= set(offered), offered
    lines = {}
    for name, settings in {"field": {"FieldName": "Depth"}, "x": {"Component": 0}, "no field": {"FieldName": "", "Component": 0}}.items():
        contour = SplineContour(Input=with_field, **settings)
        contour.Levels = [0.125]
        contour.UpdatePipeline()
        made = contour.GetClientSideObject().GetOutputDataObject(0)
        lines[name] = [made.GetPoint(i) for i in range(made.GetNumberOfPoints())]
    assert lines["x"] and lines["x"] == lines["no field"]
    assert all(abs(point[0] - 0.125) < 1e-6 for point in lines["field"]) and lines["field"]  # Calculator makes floats


knotwork_testing.main(globals())
