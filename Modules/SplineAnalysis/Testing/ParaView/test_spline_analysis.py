# SPDX-License-Identifier: BSD-3-Clause
"""A heated disc in ParaView, alone and against another one: the solution's largest value is the square of the radius."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import KnotworkSplineSource, SplineAnalysis, SplineVersusMesh  # noqa: E402


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


def test_two_discs():
    discs = [KnotworkSplineSource(Shape="Disc", Degree=2, Elements=[n, n, 1]) for n in (2, 4, 8)]
    both = SplineVersusMesh(Input=discs[0], Mesh=discs[1], Reference=discs[2], Equation="Poisson",
                            Problem='{"source": "4 + x", "conditions": [{"on": "boundary", "value": 0}]}')
    both.UpdatePipeline()
    numbers = both.GetClientSideObject().GetOutputDataObject(2)
    errors = [numbers.GetValueByName(row, "EnergyError").ToDouble() for row in range(3)]
    assert errors[0] > 3 * errors[1] > 0 and errors[2] == 0, errors


knotwork_testing.main(globals())
