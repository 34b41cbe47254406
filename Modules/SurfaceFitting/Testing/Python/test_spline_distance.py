# SPDX-License-Identifier: BSD-3-Clause
"""Distances of points from a fitted surface, from Python and by the program."""
import json

import knotwork
import knotwork_testing
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter


def cloud(points):
    made = vtkPolyData()
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=1))
    made.SetPoints(places)
    return made


def write(writer, data, name):
    writer.SetInputDataObject(data)
    writer.SetFileName(knotwork_testing.output(name))
    writer.Write()
    return knotwork_testing.output(name)


RANDOM = numpy.random.default_rng(5)
XY = RANDOM.uniform(size=(3000, 2))
POINTS = numpy.column_stack((XY, 0.3 * numpy.sin(4 * XY[:, 0]) * XY[:, 1]))
FIT = knotwork.vtkSplineSurfaceFit()
FIT.SetInputData(cloud(POINTS))
FIT.SetTolerance(0.002)
FIT.Update()
LIFTED = POINTS + numpy.array([0, 0, 1.0]) * RANDOM.choice([-0.1, 0.0, 0.03], size=(3000, 1))


def test_distances_of_the_fit_are_its_own():
    made = knotwork.vtkSplinePointDistance()
    made.SetInputData(cloud(POINTS))
    made.SetSurfaceData(FIT.GetOutputDataObject(0))
    made.Update()
    own = vtk_to_numpy(FIT.GetOutputDataObject(1).GetPointData().GetArray("Distance"))
    found = vtk_to_numpy(made.GetOutputDataObject(0).GetPointData().GetArray("Distance"))
    assert abs(found - own).max() < 1e-12


def test_program():
    points = write(vtkXMLPolyDataWriter(), cloud(LIFTED), "lifted.vtp")
    surface = write(vtkXMLUnstructuredGridWriter(), FIT.GetOutputDataObject(0), "distance_surface.vtu")
    output, report, table = (knotwork_testing.output("distance" + ending) for ending in (".vtp", ".json", ".csv"))
    done = knotwork_testing.run_program("distance", points, surface, "--output", output, "--report", report,
                                        "--class-table", table, "--tolerances", 0.01, 0.05)
    assert done.returncode == 0, done.stderr
    with open(report) as file:
        found = json.load(file)
    expected = LIFTED[:, 2] - POINTS[:, 2]
    assert found["kind"] == "vertical" and found["points_measured"] == 3000 and found["points_without"] == 0
    assert found["classes"] == [-2, -1, 0, 1, 2]
    assert found["class_points"] == [(expected < -0.05).sum(), 0, (expected == 0).sum(), (expected > 0.02).sum(), 0]
    assert abs(found["mean_distance"] - expected.mean()) < 0.002
    assert found["max_distance"] - 0.03 < 0.002 and abs(found["min_distance"] + 0.1) < 0.002
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(output)
    reader.Update()
    distance = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("Distance"))
    assert abs(distance - expected).max() < 0.0021
    with open(table) as file:
        assert len(file.read().splitlines()) == 6
    for bad, words in ((["--tolerances", 2, 1], "ascend"), (["--kind", "sideways"], "")):
        done = knotwork_testing.run_program("distance", points, surface, "--output", output, *bad)
        assert done.returncode in (1, 2) and words in done.stderr, done.stderr
    done = knotwork_testing.run_program("distance", points, points, "--output", output)
    assert done.returncode == 1 and "lifted.vtp" in done.stderr, done.stderr


def test_points_beside_the_surface_are_written_as_text_and_read_again():
    beside = LIFTED[:20] + numpy.where(numpy.arange(20) % 2 == 0, 5.0, 0.0)[:, None] * (1, 0, 0)
    points = write(vtkXMLPolyDataWriter(), cloud(beside), "beside.vtp")
    surface = write(vtkXMLUnstructuredGridWriter(), FIT.GetOutputDataObject(0), "distance_surface.vtu")
    text, again = knotwork_testing.output("beside.csv"), knotwork_testing.output("beside_again.vtp")
    done = knotwork_testing.run_program("distance", points, surface, "--kind", "vertical", "--output", text)
    assert done.returncode == 0, done.stderr
    done = knotwork_testing.run_program("convert", text, "--output", again)
    assert done.returncode == 0, done.stderr
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(again)
    reader.Update()
    distance = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("Distance"))
    assert numpy.array_equal(numpy.isnan(distance), beside[:, 0] > 1)


knotwork_testing.main(globals())
