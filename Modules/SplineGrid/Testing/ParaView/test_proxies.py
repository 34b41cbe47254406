# SPDX-License-Identifier: BSD-3-Clause
"""Every way of refining, the control net, the parametric mesh and the spline of a mesh through ParaView's proxies."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import (  # noqa: E402
    GroupDatasets, IDSelectionSource, KnotworkSplineSource, MeshPatches, OutputPort, Plane, SplineControlNet, SplineParametricMesh,
    SplineRefine, UnstructuredSpline)


def cells(proxy):
    proxy.UpdatePipeline()
    return proxy.GetDataInformation().GetNumberOfCells()


def disc():
    source = KnotworkSplineSource(Shape="Disc", Degree=2, Elements=[3, 3, 1])
    assert cells(source) == 45
    return source


def test_refine_uniform_and_by_function():
    refine = SplineRefine(Input=disc())
    assert cells(refine) == 180
    refine.Mode = "Implicit Function"
    refine.ImplicitFunction = "Sphere"
    refine.ImplicitFunction.Center = [1, 0, 0]
    refine.ImplicitFunction.Radius = 0.2
    assert 45 < cells(refine) < 180


def test_refine_by_array():
    refine = SplineRefine(Input=disc(), Mode="Cell Array")
    refine.Array = ["CELLS", "PatchId"]
    refine.LowerThreshold = 4
    assert cells(refine) == 36 + 4 * 9


def test_refine_selected_cells():
    selection = IDSelectionSource(IDs=[-1, 0, -1, 1], FieldType="CELL")  # pairs of rank (all) and cell
    refine = SplineRefine(Input=disc(), Mode="Selection", Extension=0)
    refine.Selection = selection
    assert cells(refine) == 43 + 2 * 4


def test_net_and_mesh_of_a_group():
    group = GroupDatasets(Input=[disc(), KnotworkSplineSource(Shape="Cube")])
    group.UpdatePipeline()
    assert cells(SplineParametricMesh(Input=group)) == 46
    # five nets of 5 x 5 points, and the cube's
    points_and_lines = 5 * (25 + 2 * 5 * 4) + 8 + 12
    assert cells(SplineControlNet(Input=group)) == points_and_lines


def test_spline_of_a_mesh():
    plane = Plane(XResolution=4, YResolution=3)
    spline = UnstructuredSpline(Input=plane, Degree=2, Policy="Minimal", Construction="Control Cage")
    assert cells(spline) == 12
    assert OutputPort(spline, 1).GetDataInformation().GetNumberOfRows() == 1
    patches = MeshPatches(Input=plane, Layout="Motorcycle Graph")
    assert cells(patches) == 12
    assert OutputPort(patches, 2).GetDataInformation().GetNumberOfRows() == 1


knotwork_testing.main(globals())
