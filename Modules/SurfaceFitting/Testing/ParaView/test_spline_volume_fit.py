# SPDX-License-Identifier: BSD-3-Clause
"""A field on the points of a wavelet in ParaView: LR and THB within the tolerance."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import OutputPort, PointSource, Calculator, SplineVolumeFit  # noqa: E402


def test_spaces_and_outputs():
    points = Calculator(Input=PointSource(NumberOfPoints=3000), ResultArrayName="Field", Function="coordsX*coordsY + coordsZ")
    for space in ("LR", "THB"):
        fit = SplineVolumeFit(Input=points, ValueArray=["POINTS", "Field"], Space=space, Tolerance=0.001)
        fit.UpdatePipeline()
        table = fit.GetClientSideObject().GetOutputDataObject(2)
        assert table.GetValueByName(table.GetNumberOfRows() - 1, "PointsOutside").ToInt() == 0
        assert OutputPort(fit, 0).GetPointDataInformation().GetArray("Field") is not None
        assert OutputPort(fit, 1).GetPointDataInformation().GetArray("Distance") is not None


knotwork_testing.main(globals())
