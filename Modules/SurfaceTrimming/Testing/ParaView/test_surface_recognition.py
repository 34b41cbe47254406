# SPDX-License-Identifier: BSD-3-Clause
"""A cylinder of ParaView's is one cylinder and two planes; with a small sag its side is of no surface."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Cylinder, OutputPort, SurfaceRecognition  # noqa: E402


def test_cylinder():
    found = SurfaceRecognition(Input=Cylinder(Resolution=40))
    found.UpdatePipeline()

    def number(name):
        return found.GetClientSideObject().GetOutputDataObject(3).GetValueByName(0, name).ToInt()

    assert (number("Planes"), number("Cylinders")) == (2, 1)
    arrays = OutputPort(found, 0).GetCellDataInformation()
    assert arrays.GetArray("SurfaceType").GetRange(0) == (0, 1)
    assert arrays.GetArray("RegionId").GetRange(0) == (0, 2)
    assert OutputPort(found, 1).GetDataInformation().GetNumberOfCells() == 80
    assert OutputPort(found, 2).GetDataInformation().GetNumberOfRows() == 3
    found.Tolerance = 1e-3
    found.MaximumSag = 0.5
    found.UpdatePipeline()
    assert (number("Planes"), number("Cylinders"), number("FreeForms")) == (2, 0, 1)


knotwork_testing.main(globals())
