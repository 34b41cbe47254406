# SPDX-License-Identifier: BSD-3-Clause
"""Rigid Alignment in ParaView with its defaults: a box that was moved lies on itself in four poses."""
import knotwork_testing

knotwork_testing.load_plugin()
from paraview.simple import Box, RigidAlignment, Transform, Triangulate  # noqa: E402


def moved(data):
    result = Transform(Input=data)
    result.Transform.Translate = [5, -2, 1]
    result.Transform.Rotate = [20, 50, -70]
    return result


def aligned(target):
    found = RigidAlignment(Input=moved(target), Target=target)
    found.UpdatePipeline()
    table = found.GetClientSideObject().GetOutputDataObject(1)
    return {table.GetColumnName(i): table.GetValue(0, i) for i in range(table.GetNumberOfColumns())}, found


def test_box():
    numbers, found = aligned(Triangulate(Input=Box(XLength=3, YLength=2)))
    assert numbers["EqualPoses"].ToInt() == 4 and numbers["Rms"].ToDouble() < 1e-6, numbers
    assert found.PointData["Distance"].GetRange()[1] < 1e-6


knotwork_testing.main(globals())
