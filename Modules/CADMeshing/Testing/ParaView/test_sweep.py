# SPDX-License-Identifier: BSD-3-Clause
"""A plane of ParaView's swept with its defaults."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Line, OutputPort, Plane, SweepToHexahedra  # noqa: E402


def test_with_and_without_a_path():
    sweep = SweepToHexahedra(Input=Plane(XResolution=3, YResolution=2), Layers=5)
    sweep.UpdatePipeline()
    assert OutputPort(sweep, 0).GetDataInformation().GetNumberOfCells() == 30
    sweep.Path = Line(Point1=(0, 0, 0), Point2=(0, 0, 7))
    sweep.UpdatePipeline()
    assert OutputPort(sweep, 0).GetDataInformation().GetBounds()[5] == 7


knotwork_testing.main(globals())
