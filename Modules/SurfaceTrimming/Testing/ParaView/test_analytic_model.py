# SPDX-License-Identifier: BSD-3-Clause
"""A cylinder of ParaView's becomes a cylinder and two planes with two circles; ParaView writes them as STEP and opens them again."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import AnalyticModel, Cylinder, OpenDataFile, OutputPort, SaveData  # noqa: E402


def test_cylinder():
    model = AnalyticModel(Input=Cylinder(Resolution=40))
    model.UpdatePipeline()

    def number(name):
        return model.GetClientSideObject().GetOutputDataObject(3).GetValueByName(0, name).ToInt()

    names = ("Faces", "Planes", "Cylinders", "Edges", "Circles", "Vertices", "Loops", "WithinTolerance", "LoopsProved")
    assert [number(name) for name in names] == [3, 2, 1, 2, 2, 2, 0, 1, 1]
    assert OutputPort(model, 3).GetDataInformation().GetNumberOfRows() == 1
    assert OutputPort(model, 0).GetCellDataInformation().GetArray("FaceId").GetRange(0) == (0, 2)
    assert OutputPort(model, 0).GetCellDataInformation().GetArray("SurfaceType").GetRange(0) == (0, 1)
    assert OutputPort(model, 1).GetCellDataInformation().GetArray("SurfaceType").GetRange(0) == (0, 1)
    assert OutputPort(model, 2).GetDataInformation().GetNumberOfCells() > 0
    file = knotwork_testing.output("surface_trimming/paraview_cylinder.step")
    SaveData(file, proxy=OutputPort(model, 1))
    with open(file) as stream:
        text = stream.read()
    assert "CYLINDRICAL_SURFACE" in text and "B_SPLINE_SURFACE" not in text
    read = OpenDataFile(file)
    read.UpdatePipeline()
    assert OutputPort(read, 0).GetCellDataInformation().GetArray("SurfaceType").GetRange(0) == (0, 1)
    model.Tolerance = 1e-3
    model.MaximumSag = 30
    model.CornerAngle = 30
    model.UpdatePipeline()
    assert number("Cylinders") == 1


knotwork_testing.main(globals())
