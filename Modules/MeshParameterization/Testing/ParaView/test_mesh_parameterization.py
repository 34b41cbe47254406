# SPDX-License-Identifier: BSD-3-Clause
"""Half a sphere through Mesh Parameterization in ParaView: every method, the loops and the summary."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import MeshParameterization, Sphere  # noqa: E402


def half_sphere():
    return Sphere(ThetaResolution=24, PhiResolution=12, EndPhi=90)


def summary(mesh, column):
    mesh.UpdatePipeline()
    return mesh.GetClientSideObject().GetOutputDataObject(2).GetValueByName(0, column)


def test_methods():
    for method, name in (("HLLE", "hlle"), ("Isomap", "isomap"), ("Laplacian Eigenmaps", "laplacian"), ("LSCM", "lscm"),
                         ("ARAP", "arap"), ("Injective", "injective")):
        mesh = MeshParameterization(Input=half_sphere(), Method=method, Fallback=0)
        assert summary(mesh, "Method").ToString() == name
        assert summary(mesh, "Loops").ToInt() == 1
        assert summary(mesh, "FlippedTriangles").ToInt() == 0, name


def test_flat_output_and_loops():
    mesh = MeshParameterization(Input=half_sphere(), FlatOutput=1)
    mesh.UpdatePipeline()
    bounds = mesh.GetDataInformation().GetBounds()
    assert bounds[4] == bounds[5] == 0
    loops = mesh.GetClientSideObject().GetOutputDataObject(1)
    assert loops.GetNumberOfCells() == 1 and loops.GetNumberOfPoints() == 24
    assert loops.GetPointData().GetArray("UV") is not None
    assert mesh.PointData["UV"].GetNumberOfComponents() == 2


def test_closed_mesh_gets_charts():
    mesh = MeshParameterization(Input=Sphere(ThetaResolution=24, PhiResolution=24), MaximumStretch=2, MaximumCharts=10,
                                CreaseAngle=60)
    assert summary(mesh, "Charts").ToInt() == 2
    assert summary(mesh, "MaxStretch").ToDouble() <= 2
    assert mesh.CellData["ChartId"].GetRange() == (0, 1)
    assert mesh.PointData["CutPointId"] is not None


knotwork_testing.main(globals())
