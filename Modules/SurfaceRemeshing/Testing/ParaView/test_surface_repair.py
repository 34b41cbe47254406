# SPDX-License-Identifier: BSD-3-Clause
"""A box of ParaView's, whose corners are three points each, is welded."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Box, OutputPort, SurfaceRepair  # noqa: E402


def test_box():
    repaired = SurfaceRepair(Input=Box())
    repaired.UpdatePipeline()
    assert OutputPort(repaired, 0).GetDataInformation().GetNumberOfPoints() == 8
    assert OutputPort(repaired, 0).GetDataInformation().GetNumberOfCells() == 12
    numbers = repaired.GetClientSideObject().GetOutputDataObject(2)
    assert numbers.GetValueByName(0, "MergedPoints").ToInt() == 16
    assert numbers.GetValueByName(0, "Closed").ToInt() == 1


knotwork_testing.main(globals())
