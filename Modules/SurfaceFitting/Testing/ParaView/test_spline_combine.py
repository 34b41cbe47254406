# SPDX-License-Identifier: BSD-3-Clause
"""Spline Combine in ParaView: the difference and a weighted sum of two fitted surfaces, and domains that differ."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Plane, SplineCombine, SplineSurfaceFit, Transform  # noqa: E402


def survey(height, x=0.0):
    moved = Transform(Input=Plane(XResolution=12, YResolution=12))
    moved.Transform.Translate = [x, 0, height]
    return SplineSurfaceFit(Input=moved, Tolerance=0.001)


def bounds(combine):
    combine.UpdatePipeline()
    table = combine.GetClientSideObject().GetOutputDataObject(1)
    assert table.GetNumberOfRows() == 1
    return [table.GetValueByName(0, name).ToDouble() for name in ("MinBound", "MaxBound")]


def test_modes():
    for options, height in (({}, 0.5), ({"Mode": "Average"}, 0.25),
                            ({"Mode": "Weighted", "FirstWeight": 2, "SecondWeight": 3}, 1.0)):
        combine = SplineCombine(Input=survey(0.5), Second=survey(0), **options)
        assert max(abs(value - height) for value in bounds(combine)) < 1e-9, (options, bounds(combine))
        z = combine.GetDataInformation().GetBounds()[4:]
        assert max(abs(value - height) for value in z) < 1e-9, z


def test_common_domain():
    combine = SplineCombine(Input=survey(0.5), Second=survey(0, 0.25), CommonDomain=1)
    bounds(combine)
    x = combine.GetDataInformation().GetBounds()[:2]
    assert abs(x[0] + 0.25) < 1e-9 and abs(x[1] - 0.5) < 1e-9, x


knotwork_testing.main(globals())
