# SPDX-License-Identifier: BSD-3-Clause
"""usage: compare_examples.py CXX.vtp PYTHON.vtp: both languages run the same filters and write the same disc."""
import sys

import knotwork_testing
import numpy
from vtkmodules.numpy_interface import dataset_adapter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def read(name):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(name)
    reader.Update()
    assert reader.GetErrorCode() == 0, name
    return dataset_adapter.WrapDataObject(reader.GetOutput())


def test_both_files_are_the_same():
    first, second = map(read, sys.argv[1:3])
    assert first.GetNumberOfPolys() == second.GetNumberOfPolys() > 100
    assert (first.Points == second.Points).all() and (first.Polygons == second.Polygons).all()
    assert list(first.PointData.keys()) == list(second.PointData.keys())
    for name in first.PointData.keys():
        assert (first.PointData[name] == second.PointData[name]).all(), name


def test_it_is_a_disc_of_four_levels():
    mesh = read(sys.argv[1])
    assert set(mesh.CellData["Level"]) == {0, 1, 2, 3}
    bound = mesh.FieldData["ChordalBound"][0]
    assert bound <= 1e-3 * 2 * 2 ** 0.5 * 1.2  # the Bezier points' box is a little larger than the disc's
    # area of the polygons: that of the disc, less than a rim of the bound's width missing
    corners = numpy.array(mesh.Polygons)
    area, at = 0.0, 0
    while at < len(corners):
        ring = mesh.Points[corners[at + 1:at + 1 + corners[at]]]
        area += 0.5 * numpy.sum(ring[:, 0] * numpy.roll(ring[:, 1], -1) - ring[:, 1] * numpy.roll(ring[:, 0], -1))
        at += corners[at] + 1
    assert numpy.pi - 2 * numpy.pi * bound <= area < numpy.pi, area


knotwork_testing.main(globals())
