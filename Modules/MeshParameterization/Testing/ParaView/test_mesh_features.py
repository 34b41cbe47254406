# SPDX-License-Identifier: BSD-3-Clause
"""A cylinder of ParaView's has two closed edges; a line across it and a region array are features, too."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Cylinder, Line, MeshFeatures, OutputPort  # noqa: E402


def number(found, name):
    found.UpdatePipeline()
    return found.GetClientSideObject().GetOutputDataObject(3).GetValueByName(0, name).ToDouble()


def test_cylinder():
    found = MeshFeatures(Input=Cylinder(Resolution=40))
    assert (number(found, "Chains"), number(found, "ClosedChains"), number(found, "Regions")) == (2, 2, 3)
    assert OutputPort(found, 0).GetCellDataInformation().GetArray("RegionId").GetRange(0) == (0, 2)
    lines = OutputPort(found, 1)
    assert lines.GetDataInformation().GetNumberOfCells() == 2
    assert abs(lines.GetCellDataInformation().GetArray("Angle").GetRange(0)[0] - 90) < 1e-3
    found.SharpAngle = 100
    assert number(found, "Regions") == 1


def test_edges_and_regions():
    cylinder = Cylinder(Resolution=40)  # about y, from -0.5 to 0.5
    upright = Line(Point1=(0.5, -0.5, 0), Point2=(0.5, 0.5, 0), Resolution=1)
    found = MeshFeatures(Input=cylinder, Edges=upright, Mode="Replace")
    assert (number(found, "SharpEdges"), number(found, "Regions")) == (1, 1)
    found.Mode = "Extend"
    assert (number(found, "Chains"), number(found, "Corners")) == (3, 2)
    again = MeshFeatures(Input=OutputPort(MeshFeatures(Input=cylinder), 0), RegionArray="RegionId", Mode="Replace")
    assert number(again, "Regions") == 3


knotwork_testing.main(globals())
