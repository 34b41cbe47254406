# SPDX-License-Identifier: BSD-3-Clause
"""A ball: its boundary, and curved tetrahedra that follow it."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import KnotworkSplineSource, OutputPort, SplineBoundary, TetGenMesher, VolumeComparison  # noqa: E402


def test_ball():
    ball = KnotworkSplineSource(Shape="Ball")
    boundary = SplineBoundary(Input=ball, ChordalTolerance=0.02)
    boundary.UpdatePipeline()
    numbers = boundary.GetClientSideObject().GetOutputDataObject(1)
    assert numbers.GetValueByName(0, "Closed").ToInt() == 1
    mesher = TetGenMesher(Input=OutputPort(boundary, 0), Target=ball, Order=2)
    mesher.UpdatePipeline()
    numbers = mesher.GetClientSideObject().GetOutputDataObject(2)
    assert numbers.GetValueByName(0, "Verdict").ToString() == "valid"
    assert abs(numbers.GetValueByName(0, "Volume").ToDouble() - 4.18879) < 0.01
    comparison = VolumeComparison(Input=ball, Mesh=OutputPort(mesher, 0), Samples=1000)
    comparison.UpdatePipeline()
    numbers = comparison.GetClientSideObject().GetOutputDataObject(3)
    assert numbers.GetNumberOfRows() == 2
    assert abs(numbers.GetValueByName(0, "Volume").ToDouble() - 4.18879) < 1e-5


knotwork_testing.main(globals())
