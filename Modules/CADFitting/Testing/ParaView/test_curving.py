# SPDX-License-Identifier: BSD-3-Clause
"""Element Curving in ParaView: the quadrilaterals of a box onto a box of triangles, and onto a sphere of a spline."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Box, CleantoGrid, ElementCurving, KnotworkSplineSource, Triangulate  # noqa: E402


def numbers(curving):
    table = curving.GetClientSideObject().GetOutputDataObject(1)
    return {table.GetColumnName(i): table.GetValue(0, i) for i in range(table.GetNumberOfColumns())}


def test_a_box_stays_a_box():
    curving = ElementCurving(Input=CleantoGrid(Input=Box()), Target=Triangulate(Input=Box()), Order=3)
    curving.UpdatePipeline()
    found = numbers(curving)
    assert found["Elements"].ToInt() == found["CertifiedElements"].ToInt() == 6, found
    assert abs(found["Area"].ToDouble() - 6) < 1e-6 and found["MaxDistance"].ToDouble() < 1e-6, found


def test_a_box_becomes_a_sphere():
    sphere = KnotworkSplineSource(Shape="Sphere Surface", OuterRadius=0.75**0.5)
    curving = ElementCurving(Input=CleantoGrid(Input=Box()), Target=sphere, Order=4, Basis="Bezier")
    curving.UpdatePipeline()
    assert numbers(curving)["MaxDistance"].ToDouble() < 0.05


knotwork_testing.main(globals())
