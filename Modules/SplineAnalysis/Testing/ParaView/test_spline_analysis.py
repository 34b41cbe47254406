# SPDX-License-Identifier: BSD-3-Clause
"""A heated disc in ParaView: the solution's largest value is the square of the radius."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import KnotworkSplineSource, SplineAnalysis  # noqa: E402


def test_disc():
    disc = KnotworkSplineSource(Shape="Disc", Degree=3, Elements=[4, 4, 1])
    analysis = SplineAnalysis(Input=disc, Problem='{"source": 4, "conditions": [{"on": "boundary", "value": 0}]}')
    analysis.UpdatePipeline()
    bounds = disc.GetDataInformation().GetBounds()
    radius = (bounds[1] - bounds[0]) / 2
    numbers = analysis.GetClientSideObject().GetOutputDataObject(3)
    assert abs(numbers.GetValueByName(0, "LargestValue").ToDouble() - radius ** 2) < 0.01 * radius ** 2
    names = [array.GetName() for array in analysis.PointData]
    assert "Solution" in names and "Flux" in names, names


knotwork_testing.main(globals())
