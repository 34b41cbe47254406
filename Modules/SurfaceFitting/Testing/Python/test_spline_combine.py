# SPDX-License-Identifier: BSD-3-Clause
"""Difference and average of two surfaces by the program; distances of both agree with it."""
import json

import knotwork
import knotwork_testing
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter

RANDOM = numpy.random.default_rng(11)


def cloud(points):
    made = vtkPolyData()
    places = vtkPoints()
    places.SetDataTypeToDouble()
    places.SetData(numpy_to_vtk(numpy.ascontiguousarray(points), deep=1))
    made.SetPoints(places)
    return made


def fitted(lift, name, space):
    xy = RANDOM.uniform(size=(3000, 2))
    z = 0.2 * numpy.sin(5 * xy[:, 0]) + lift * xy[:, 1]
    fit = knotwork.vtkSplineSurfaceFit()
    fit.SetInputData(cloud(numpy.column_stack((xy, z))))
    fit.SetDomain(0, 1, 0, 1)
    fit.SetTolerance(0.002)
    fit.SetSpace(space)
    fit.Update()
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputDataObject(fit.GetOutputDataObject(0))
    writer.SetFileName(knotwork_testing.output(name))
    writer.Write()
    return fit.GetOutputDataObject(0), knotwork_testing.output(name)


FIRST, FIRST_FILE = fitted(0.3, "combine_first.vtu", 0)
SECOND, SECOND_FILE = fitted(0.1, "combine_second.vtu", 1)


def heights(surface, xy):
    """z of a surface, as distances of points at 0."""
    made = knotwork.vtkSplinePointDistance()
    made.SetInputData(cloud(numpy.column_stack((xy, numpy.zeros(len(xy))))))
    made.SetSurfaceData(surface)
    made.Update()
    return -vtk_to_numpy(made.GetOutputDataObject(0).GetPointData().GetArray("Distance"))


def test_program():
    output, report = knotwork_testing.output("combined.vtu"), knotwork_testing.output("combined.json")
    xy = RANDOM.uniform(size=(500, 2))
    for mode, weights in (("difference", (1, -1)), ("average", (0.5, 0.5))):
        done = knotwork_testing.run_program("combine", FIRST_FILE, SECOND_FILE, "--mode", mode, "--output", output,
                                            "--report", report)
        assert done.returncode == 0, done.stderr
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(output)
        reader.Update()
        z = heights(reader.GetOutput(), xy)
        expected = weights[0] * heights(FIRST, xy) + weights[1] * heights(SECOND, xy)
        assert abs(z - expected).max() < 1e-12, mode
        with open(report) as file:
            found = json.load(file)
        assert found["mode"] == mode and found["patches"] == 1 and found["functions"] > 0
        assert found["min_bound"] <= z.min() + 1e-12 and z.max() - 1e-12 <= found["max_bound"]


def test_errors():
    output = knotwork_testing.output("uncombined.vtu")
    ring = knotwork_testing.output("combine_ring.vtu")
    done = knotwork_testing.run_program("source", "--shape", "annulus-sector", "--output", ring)
    assert done.returncode == 0, done.stderr
    done = knotwork_testing.run_program("combine", FIRST_FILE, ring, "--output", output)
    assert done.returncode == 1 and "rational" in done.stderr, done.stderr
    done = knotwork_testing.run_program("combine", FIRST_FILE, "--output", output)
    assert done.returncode == 2


knotwork_testing.main(globals())
