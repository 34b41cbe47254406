# SPDX-License-Identifier: BSD-3-Clause
"""Spline Trim To Points in ParaView: a fitted ring of points becomes a face with a hole."""
import math

import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Disk, OutputPort, SplineSurfaceFit, SplineTrimToPoints  # noqa: E402

CELL = 0.06
RIM = CELL * (math.sqrt(2) + 1 / 3)  # a cell's diagonal, and the tolerance of the curves



def test_a_ring():
    ring = Disk(InnerRadius=0.5, OuterRadius=1, RadialResolution=20, CircumferentialResolution=150)
    surface = SplineSurfaceFit(Input=ring, Tolerance=0.001)
    crop = SplineTrimToPoints(Input=surface, Points=ring, CellSize=CELL)
    crop.UpdatePipeline()
    numbers = crop.GetClientSideObject().GetOutputDataObject(3)
    counts = [numbers.GetValueByName(0, name).ToInt() for name in ("Faces", "Loops", "LoopsProved")]
    assert counts == [1, 2, 1], counts
    x = crop.GetDataInformation().GetBounds()[:2]
    assert max(abs(x[0] + 1), abs(x[1] - 1)) < RIM, x
    assert OutputPort(crop, 1).GetDataInformation().GetNumberOfCells() > 0
    assert OutputPort(crop, 2).GetDataInformation().GetNumberOfCells() > 0
    faces = crop.GetClientSideObject().GetOutputDataObject(0)
    nearest = min(math.hypot(*faces.GetPoint(i)[:2]) for i in range(faces.GetNumberOfPoints()))
    assert abs(nearest - 0.5) < RIM, nearest


def test_without_triangles():
    ring = Disk(InnerRadius=0.5, OuterRadius=1, RadialResolution=20, CircumferentialResolution=150)
    crop = SplineTrimToPoints(Input=SplineSurfaceFit(Input=ring, Tolerance=0.001), Points=ring, CellSize=CELL, Triangulation=0)
    crop.UpdatePipeline()
    assert crop.GetDataInformation().GetNumberOfCells() == 0
    assert OutputPort(crop, 1).GetDataInformation().GetNumberOfCells() > 0


knotwork_testing.main(globals())
