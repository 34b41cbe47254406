# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's own filters with their defaults between a source and a filter of ours: the control points are the moved ones.

The control net decodes its input: one point a control point, with weights and patches.
"""
import math

import knotwork_testing

knotwork_testing.load_plugin()
from paraview import servermanager  # noqa: E402
from paraview.simple import (  # noqa: E402
    AppendDatasets, GroupDatasets, KnotworkSplineSource, SaveData, SplineControlNet, SplineRefine, Threshold, Transform,
    XMLUnstructuredGridReader)
from vtkmodules.numpy_interface import dataset_adapter  # noqa: E402

import numpy  # noqa: E402

EPS = numpy.finfo(float).eps
SHAPES = ["Arc", "Annulus Sector", "Disc", "Solid Tube", "Ball Sector"]


def source(shape):
    """A spline grid of three elements a direction, one corner of it refined (THB)."""
    made = KnotworkSplineSource(Shape=shape, Elements=[3, 3, 3], Degree=3)
    return SplineRefine(Input=made, Mode="Cell Array", Array=["CELLS", "ElementId"], LowerThreshold=0,
                        UpperThreshold=0)


def fetch(proxy):
    return dataset_adapter.WrapDataObject(servermanager.Fetch(proxy))


def net(proxy):
    """Points, weights and patches of the control points, ordered as in the model."""
    data = fetch(SplineControlNet(Input=proxy))
    assert data.GetNumberOfPoints() > 0
    return tuple(numpy.array(a) for a in (data.Points, data.PointData["Weight"], data.PointData["PatchId"]))


def moved(points):
    """What Transform of transformed() does: rotation by 90 degrees about z and 30 about x, scale, translation."""
    turn = math.radians(30)
    scaled = points * [2, 1, 0.5]
    x, y, z = scaled.T  # VTK turns about z, then x, then y, applied to the point in the order y, x, z
    y, z = math.cos(turn) * y - math.sin(turn) * z, math.sin(turn) * y + math.cos(turn) * z
    x, y = -y, x
    return numpy.stack([x + 1, y - 2, z + 3], axis=1)


def transformed(proxy):
    result = Transform(Input=proxy)
    result.Transform.Translate = [1, -2, 3]
    result.Transform.Rotate = [30, 0, 90]
    result.Transform.Scale = [2, 1, 0.5]
    return result


def assert_near(found, expected):
    # rounding of the points times the amplification of the dual functionals (below 100 up to degree 3)
    assert found.shape == expected.shape, (found.shape, expected.shape)
    tolerance = 64 * EPS * 100 * abs(expected).max()
    assert abs(found - expected).max() <= tolerance, abs(found - expected).max()


def test_transform_moves_control_points():
    for shape in SHAPES:
        original = source(shape)
        result = transformed(original)
        points, weights, patches = net(original)
        found, found_weights, found_patches = net(result)
        assert_near(found, moved(points))
        assert_near(found_weights, weights)
        assert (found_patches == patches).all()
        # what makes this hard: the three-component degrees were turned as vectors
        degrees = numpy.array(fetch(result).CellData["HigherOrderDegrees"])
        assert (degrees != numpy.array(fetch(original).CellData["HigherOrderDegrees"])).any(), shape


def test_threshold_by_patch():
    original = source("Disc")
    points, weights, patches = net(original)
    for patch in sorted(set(patches)):
        kept = Threshold(Input=original, Scalars=["CELLS", "PatchId"])  # resets the range to that of the array
        kept.LowerThreshold = kept.UpperThreshold = patch
        found, found_weights, found_patches = net(kept)
        assert (found == points[patches == patch]).all()
        assert (found_weights == weights[patches == patch]).all()
        assert (found_patches == patch).all()


def test_append():
    original = source("Solid Tube")
    points, weights, _ = net(original)
    found, found_weights, found_patches = net(AppendDatasets(Input=[original, transformed(original)]))
    assert list(found_patches) == [0] * len(points) + [1] * len(points)
    assert (found[:len(points)] == points).all()
    assert_near(found[len(points):], moved(points))
    assert_near(found_weights, numpy.concatenate([weights, weights]))


def test_files():
    original = source("Disc")
    points, weights, _ = net(original)
    name = knotwork_testing.output("ParaViewSpline.vtu")
    # not appended, which is ParaView's default: ParaView 5.11 cannot read it back with Debian's present libexpat
    SaveData(name, proxy=original, DataMode="Binary")
    found, found_weights, _ = net(XMLUnstructuredGridReader(FileName=[name]))
    assert (found == points).all() and (found_weights == weights).all()


def test_groups_are_accepted():
    first, second = source("Disc"), source("Solid Tube")
    refined = SplineRefine(Input=GroupDatasets(Input=[first, second], OutputType="vtkPartitionedDataSetCollection"))
    refined.UpdatePipeline()
    output = refined.GetClientSideObject().GetOutputDataObject(0)
    assert output.IsA("vtkPartitionedDataSetCollection"), output.GetClassName()
    assert output.GetNumberOfPartitionedDataSets() == 2
    for i, original in enumerate((first, second)):
        before = servermanager.Fetch(original)
        after = output.GetPartition(i, 0)
        dimension = before.GetCell(0).GetCellDimension()
        # every element is halved in all directions, and the map stays: elements' corners are points of the Bezier
        # cells, so those of the input are among those of the output
        assert after.GetNumberOfCells() == 2**dimension * before.GetNumberOfCells()
        corners = {tuple(numpy.round(before.GetPoint(before.GetCell(c).GetPointId(k)), 12) + 0.0)
                   for c in range(before.GetNumberOfCells()) for k in range(2**dimension)}
        found = {tuple(numpy.round(after.GetPoint(j), 12) + 0.0) for j in range(after.GetNumberOfPoints())}
        assert corners <= found, corners - found
        assert set(dataset_adapter.WrapDataObject(after).CellData["PatchId"]) == set(
            dataset_adapter.WrapDataObject(before).CellData["PatchId"])


knotwork_testing.main(globals())
