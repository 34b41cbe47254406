# SPDX-License-Identifier: BSD-3-Clause
"""A fitted surface trimmed to its points by the program: as STEP, as triangles; errors."""
import json

import knotwork
import knotwork_testing
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkMassProperties
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter


def ring(n=20000):
    """Points of a plane ring, density 5000 a unit of area."""
    xy = numpy.random.default_rng(3).uniform(-1, 1, size=(n, 2))
    r = numpy.hypot(xy[:, 0], xy[:, 1])
    xy = xy[(r <= 1) & (r >= 0.4)]
    made, places = vtkPolyData(), vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(numpy.column_stack((xy, 0.1 * xy[:, 0])), deep=1))
    made.SetPoints(places)
    return made


def write(writer, data, name):
    writer.SetInputDataObject(data)
    writer.SetFileName(knotwork_testing.output(name))
    writer.Write()
    return knotwork_testing.output(name)


FIT = knotwork.vtkSplineSurfaceFit()
FIT.SetInputData(ring())
FIT.SetTolerance(0.001)
FIT.Update()
SURFACE = write(vtkXMLUnstructuredGridWriter(), FIT.GetOutputDataObject(0), "ring_surface.vtu")
POINTS = write(vtkXMLPolyDataWriter(), ring(), "ring_points.vtp")


def test_program():
    output, triangles, report = (knotwork_testing.output("ring" + ending) for ending in (".step", ".vtp", ".json"))
    done = knotwork_testing.run_program("crop", SURFACE, POINTS, "--output", output, "--triangles", triangles, "--report",
                                        report)
    assert done.returncode == 0, done.stderr
    with open(report) as file:
        found = json.load(file)
    assert found["faces"] == 1 and found["loops"] == 2 and found["loops_proved"] and found["faces_regular"], found
    assert found["brep_valid"] and found["points_outside"] < 300, found
    tilt = numpy.sqrt(1.01)
    area = numpy.pi * (1 - 0.16) * tilt
    # cells stick out by half a cell on average, along 2 pi (1 + 0.4), and by two at most
    most = 8.8 * found["cell_size"] * tilt
    assert area - 0.2 * most < found["file_area"] < area + most, (area, found)
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(triangles)
    reader.Update()
    mass = vtkMassProperties()
    mass.SetInputData(reader.GetOutput())
    assert abs(mass.GetSurfaceArea() - found["file_area"]) < 0.01 * area


def test_errors():
    output = knotwork_testing.output("no_ring.step")
    done = knotwork_testing.run_program("crop", SURFACE, POINTS, "--output", output, "--cell-size", 1e-7)
    assert done.returncode == 1 and "larger cell size" in done.stderr, done.stderr
    done = knotwork_testing.run_program("crop", POINTS, POINTS, "--output", output)
    assert done.returncode == 1, done.stderr
    done = knotwork_testing.run_program("crop", SURFACE, "--output", output)
    assert done.returncode == 2


knotwork_testing.main(globals())
