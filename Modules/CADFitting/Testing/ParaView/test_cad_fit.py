# SPDX-License-Identifier: BSD-3-Clause
"""CAD Fit in ParaView: a box of quadrilaterals becomes a sphere by an implicit function, and lies on a box of triangles."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Box, CADFit, OutputPort, Triangulate  # noqa: E402


def numbers(fit):
    table = fit.GetClientSideObject().GetOutputDataObject(1)
    return {table.GetColumnName(i): table.GetValue(0, i) for i in range(table.GetNumberOfColumns())}


def quads(box):
    from paraview.simple import CleantoGrid
    return CleantoGrid(Input=box)


def test_box_onto_triangles():
    box = Box()
    fit = CADFit(Input=quads(box), Target=Triangulate(Input=Box()), Degree=2, SharpAngle=30)
    fit.UpdatePipeline()
    found = numbers(fit)
    assert found["Elements"].ToInt() == 6 and found["UnmatchedFeatures"].ToInt() == 0, found
    assert found["MaxDistance"].ToDouble() < 1e-6 and abs(found["Volume"].ToDouble() - 1) < 1e-6, found
    assert OutputPort(fit, 3).GetDataInformation().GetNumberOfPoints() >= 20000


def test_implicit_function():
    fit = CADFit(Input=quads(Box()), TargetType="Implicit Function", ImplicitFunction="Sphere", Policy="Full")
    fit.ImplicitFunction.Radius = 0.8
    fit.ImplicitFunction.Center = [0, 0, 0]
    fit.UpdatePipeline()
    assert numbers(fit)["MaxDistance"].ToDouble() < 0.2


knotwork_testing.main(globals())
