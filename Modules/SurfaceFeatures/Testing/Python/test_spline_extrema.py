# SPDX-License-Identifier: BSD-3-Clause
"""Summits, pits and passes of a fitted surface, from Python and by the program; errors."""
import json

import knotwork
import knotwork_testing
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridWriter

MINIMUM, MAXIMUM, SADDLE = range(3)
BOUNDARY = 3


def height(x, y):
    """On [0, 1]^2: inside four maxima and minima of +-1 in turn like on a chess board, a saddle between them."""
    return numpy.sin(2 * numpy.pi * x) * numpy.sin(2 * numpy.pi * y)


def fitted():
    random = numpy.random.default_rng(5)
    points = random.uniform(size=(20000, 2))
    cloud = vtkPolyData()
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(numpy.column_stack((points, height(*points.T))), deep=1))
    cloud.SetPoints(places)
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputData(cloud)
    fit.SetDomain(0, 1, 0, 1)
    fit.SetDegree(3)
    fit.SetTolerance(1e-3)
    fit.Update()
    assert fit.GetOutputDataObject(0).GetNumberOfCells() > 1
    return fit.GetOutputDataObject(0)


SURFACE = fitted()


def extrema(**properties):
    made = knotwork.vtkSplineExtrema()
    made.SetInputDataObject(SURFACE)
    for key, value in properties.items():
        getattr(made, "Set" + key)(value)
    made.Update()
    return made


def numbers(made):
    table = made.GetOutputDataObject(2)
    return {table.GetColumnName(i): table.GetValue(0, i).ToDouble() for i in range(table.GetNumberOfColumns())}


def test_the_chess_board():
    made = extrema()
    found = numbers(made)
    assert found["Proved"] == 1 and found["Clusters"] == 0, found
    assert found["IndexSum"] == found["EulerCharacteristic"] == 1, found
    points = made.GetOutputDataObject(0)
    places = vtk_to_numpy(points.GetPoints().GetData())
    kinds = vtk_to_numpy(points.GetPointData().GetArray("Kind"))
    inside = vtk_to_numpy(points.GetPointData().GetArray("Place")) < BOUNDARY
    for kind, expected in ((MAXIMUM, ((0.25, 0.25, 1), (0.75, 0.75, 1))), (MINIMUM, ((0.25, 0.75, -1), (0.75, 0.25, -1))),
                           (SADDLE, ((0.5, 0.5, 0),))):
        here = places[inside & (kinds == kind)]
        for place in expected:
            # the slope is off by some 1e-2 where the curvature is 40
            assert numpy.abs(here - place).max(axis=1).min() < 5e-3, (kind, place, here)


def test_program():
    surface, output, boxes, report = (knotwork_testing.output("extrema" + ending)
                                      for ending in (".vtu", ".vtp", "_boxes.vtp", ".json"))
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(SURFACE)
    writer.SetFileName(surface)
    writer.Write()
    done = knotwork_testing.run_program("extrema", surface, "--output", output, "--boxes", boxes, "--report", report)
    assert done.returncode == 0, done.stderr
    with open(report) as file:
        found = json.load(file)
    expected = numbers(extrema())
    for key, name in (("minima", "Minima"), ("maxima", "Maxima"), ("saddles", "Saddles"), ("boundary", "OnBoundary"),
                      ("clusters", "Clusters"), ("index_sum", "IndexSum")):
        assert found[key] == expected[name], key
    assert found["proved"] is True and found["seconds"] >= 0
    for file in (output, boxes):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(file)
        reader.Update()
        assert reader.GetOutput().GetNumberOfCells() == found["minima"] + found["maxima"] + found["saddles"]


def test_errors():
    made = knotwork.vtkSplineExtrema()
    made.SetInputDataObject(SURFACE)
    made.SetFieldName("Depth")
    with knotwork_testing.Errors(made) as errors:
        made.Update()
    assert errors and "no field 'Depth'" in errors[0], errors
    output = knotwork_testing.output("none.vtp")
    done = knotwork_testing.run_program("extrema", knotwork_testing.output("missing.vtu"), "--output", output)
    assert done.returncode == 1 and "missing.vtu" in done.stderr, done.stderr
    done = knotwork_testing.run_program("extrema", "--output", output)
    assert done.returncode == 2


knotwork_testing.main(globals())
