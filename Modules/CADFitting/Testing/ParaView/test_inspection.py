# SPDX-License-Identifier: BSD-3-Clause
"""Datum Alignment and Deviation Map in ParaView with their defaults, on boxes."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Box, DatumAlignment, DeviationMap, OutputPort, Triangulate  # noqa: E402


def test_datums():
    found = DatumAlignment(Input=Triangulate(Input=Box(XLength=3, YLength=2)), DatumPlane=0, DatumAxis=2, DatumPoint="4", Inward=1)
    found.UpdatePipeline()
    bounds = found.GetDataInformation().GetBounds()
    assert abs(bounds[4]) < 1e-6 and abs(bounds[5] - 1) < 1e-6 and abs(bounds[1] - 2) < 1e-6, bounds


def test_deviations():
    found = DeviationMap(Input=Triangulate(Input=Box(XLength=1.2, YLength=1.2, ZLength=1.2)), Model=Triangulate(Input=Box()))
    found.UpdatePipeline()
    model = OutputPort(found, 1)
    low, high = model.PointData["Distance"].GetRange()
    assert abs(low - 0.1) < 1e-6 and abs(high - 0.1) < 1e-6, (low, high)
    assert model.GetDataInformation().GetNumberOfPoints() >= 20000
    assert OutputPort(found, 2).GetDataInformation().GetNumberOfRows() == 6


knotwork_testing.main(globals())
