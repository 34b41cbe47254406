# SPDX-License-Identifier: BSD-3-Clause
"""A sphere of six faces in ParaView: absent; two squares that cross: found."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import AppendDatasets, FaceIntersections, KnotworkSplineSource, OutputPort, Transform  # noqa: E402


def verdict(faces):
    found = FaceIntersections(Input=faces)
    found.UpdatePipeline()
    return found, found.GetClientSideObject().GetOutputDataObject(1).GetValueByName(0, "Verdict").ToString()


def test_sphere_and_squares():
    assert verdict(KnotworkSplineSource(Shape="Sphere Surface"))[1] == "absent"
    upright = Transform(Input=KnotworkSplineSource(Shape="Square"))
    upright.Transform.Rotate = (90, 0, 0)
    found, text = verdict(AppendDatasets(Input=[KnotworkSplineSource(Shape="Square"), upright]))
    assert text == "found"
    assert OutputPort(found, 0).GetPointDataInformation().GetArray("Faces").GetNumberOfComponents() == 2
    assert OutputPort(found, 0).GetDataInformation().GetNumberOfPoints() == 1


knotwork_testing.main(globals())
