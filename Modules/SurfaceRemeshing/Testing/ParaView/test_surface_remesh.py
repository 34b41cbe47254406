# SPDX-License-Identifier: BSD-3-Clause
"""A box and a ball of ParaView's remeshed."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Box, OutputPort, Sphere, SurfaceRemesh  # noqa: E402


def test_box_and_ball():
    fine = SurfaceRemesh(Input=Box(), Size=0.2)
    fine.UpdatePipeline()
    assert OutputPort(fine, 0).GetDataInformation().GetNumberOfCells() > 200
    numbers = fine.GetClientSideObject().GetOutputDataObject(2)
    assert abs(numbers.GetValueByName(0, "VolumeAfter").ToDouble() - 1) < 1e-6  # ParaView's points are of single precision
    curved = SurfaceRemesh(Input=Sphere(ThetaResolution=40, PhiResolution=40), Sizing="Curvature")
    curved.UpdatePipeline()
    assert curved.GetClientSideObject().GetOutputDataObject(2).GetValueByName(0, "EulerAfter").ToInt() == 2


knotwork_testing.main(globals())
