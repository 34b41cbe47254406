# SPDX-License-Identifier: BSD-3-Clause
"""Half a sphere as a trimmed face in ParaView: every method, all outputs, moved by Transform."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import (  # noqa: E402
    IntegrateVariables, MeshParameterization, OpenDataFile, OutputPort, SaveData, Sphere, Transform, TrimmedSurface)


def half_sphere():
    return MeshParameterization(Input=Sphere(ThetaResolution=24, PhiResolution=12, EndPhi=90))


def number(trimmed, column):
    trimmed.UpdatePipeline()
    return trimmed.GetClientSideObject().GetOutputDataObject(4).GetValueByName(0, column).ToDouble()


def test_methods():
    flat = half_sphere()
    for method in ("NURBS", "RBF", "Hybrid", "Penalized", "Continued Lines"):
        trimmed = TrimmedSurface(Input=OutputPort(flat, 0), Method=method, Tolerance=0.01)
        trimmed.Elements = 12 if method in ("NURBS", "Continued Lines") else 0  # extrapolation on fine nets is wild
        assert number(trimmed, "Faces") == 1 and number(trimmed, "Loops") == 1, method
        assert number(trimmed, "MaxDeviation") > 0, method


def test_outputs():
    trimmed = TrimmedSurface(Input=OutputPort(half_sphere(), 0))
    assert number(trimmed, "WithinTolerance") == 1
    for port, cells in ((0, "FaceId"), (1, "FaceId"), (2, "EdgeId"), (3, "DeviationBound")):
        information = OutputPort(trimmed, port).GetCellDataInformation()
        assert information.GetArray(cells) is not None, port
    assert OutputPort(trimmed, 2).GetPointDataInformation().GetArray("UV").GetNumberOfComponents() == 2


def test_transform_moves_surfaces_and_curves():
    trimmed = TrimmedSurface(Input=OutputPort(half_sphere(), 0))
    for port in (1, 2):
        moved = Transform(Input=OutputPort(trimmed, port))
        moved.Transform.Translate = (0, 0, 5)
        moved.Transform.Rotate = (0, 0, 30)
        moved.UpdatePipeline()
        before, after = (source.GetDataInformation().GetBounds() for source in (OutputPort(trimmed, port), moved))
        assert abs(after[4] - before[4] - 5) < 1e-5, (before, after)


def area(proxy):
    integral = IntegrateVariables(Input=proxy)
    integral.UpdatePipeline()
    return integral.GetClientSideObject().GetOutputDataObject(0).GetCellData().GetArray("Area").GetValue(0)


def test_saved_surfaces_keep_their_trims():
    trimmed = TrimmedSurface(Input=OutputPort(half_sphere(), 0))
    shrunk = Transform(Input=OutputPort(trimmed, 1))
    shrunk.Transform.Scale = (0.5, 0.5, 0.5)
    shrunk.Transform.Translate = (1, 2, 3)
    for source, factor in ((OutputPort(trimmed, 1), 1), (shrunk, 0.25)):
        for ending in ("step", "iges"):
            file = knotwork_testing.output("saved_trims." + ending)
            SaveData(file, proxy=source)
            again = OpenDataFile(file)
            again.UpdatePipeline()
            assert OutputPort(again, 1).GetDataInformation().GetNumberOfCells() > 0
            # within the trim's tolerance, and the reader's chordal one: the margin around it is larger
            faces = area(OutputPort(trimmed, 0)) * factor
            assert abs(area(OutputPort(again, 2)) / faces - 1) < 0.01, (ending, factor)


knotwork_testing.main(globals())
