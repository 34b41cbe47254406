# SPDX-License-Identifier: BSD-3-Clause
"""A sphere's cap as a height field in ParaView: all outputs, arrays and boxes set as the panel does."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Calculator, OutputPort, Sphere, SplineSurfaceFit  # noqa: E402


def cap():
    sphere = Sphere(ThetaResolution=48, PhiResolution=24, EndPhi=60)
    return Calculator(Input=sphere, ResultArrayName="Limit", Function="0.01 + 0*coordsX")


def number(fit, column):
    fit.UpdatePipeline()
    table = fit.GetClientSideObject().GetOutputDataObject(2)
    return table.GetValueByName(table.GetNumberOfRows() - 1, column).ToDouble()


def test_spaces_and_outputs():
    for space in ("LR", "THB"):
        fit = SplineSurfaceFit(Input=cap(), Space=space, Tolerance=0.001, FeatureGridSize=6)
        assert number(fit, "PointsOutside") == 0 and number(fit, "MaxError") <= 0.001
        assert OutputPort(fit, 0).GetCellDataInformation().GetArray("ParametricBounds") is not None
        assert OutputPort(fit, 1).GetPointDataInformation().GetArray("Distance") is not None
        assert OutputPort(fit, 3).GetDataInformation().GetNumberOfCells() == 36


def test_arrays_fitted_along_are_a_choice_and_none_is_chosen_first():
    points = cap()
    points.UpdatePipeline()
    fit = SplineSurfaceFit(Input=points)
    assert list(fit.FieldArrays) == []
    offered = fit.GetProperty("FieldArrays").SMProperty.FindDomain("vtkSMArrayListDomain")
    assert {"Normals", "Limit"} <= {offered.GetString(i) for i in range(offered.GetNumberOfStrings())}
    fit.UpdatePipeline()
    assert OutputPort(fit, 0).GetPointDataInformation().GetArray("Normals") is None


def test_arrays_fields_and_boxes():
    fit = SplineSurfaceFit(Input=cap(), FieldArrays=["Normals"], ToleranceArray=["POINTS", "Limit"])
    assert number(fit, "PointsOutside") == 0
    assert OutputPort(fit, 0).GetPointDataInformation().GetArray("Normals").GetNumberOfComponents() == 3
    ranges = OutputPort(fit, 1).GetPointDataInformation().GetArray("Tolerance").GetRange()
    assert abs(ranges[0] - 0.01) < 1e-12, ranges
    boxed = SplineSurfaceFit(Input=cap(), Tolerance=0.01, ToleranceBoxes=[-1, 0, -1, 1, 0.001])
    number(boxed, "MaxError")
    ranges = OutputPort(boxed, 1).GetPointDataInformation().GetArray("Tolerance").GetRange()
    assert abs(ranges[0] - 0.001) < 1e-12 and abs(ranges[1] - 0.01) < 1e-12, ranges


def test_elements_have_features():
    fit = SplineSurfaceFit(Input=cap(), Tolerance=0.001, ElementFeatures=1, FeatureIterations=1)
    number(fit, "MaxError")
    assert OutputPort(fit, 0).GetCellDataInformation().GetArray("DeviationAbove") is not None
    last = OutputPort(fit, 4).GetCellDataInformation().GetArray("Iteration").GetRange()
    assert last == (0, number(fit, "Iteration")), last


def test_a_start_is_updated():
    first = SplineSurfaceFit(Input=cap(), Tolerance=0.01)
    update = SplineSurfaceFit(Input=cap(), Start=first, Tolerance=0.001, HoldEdges="Values", HeldSides=[1, 1, 0, 0])
    assert number(update, "MaxError") < number(first, "MaxError")
    assert number(update, "Functions") > number(first, "Functions")


knotwork_testing.main(globals())
