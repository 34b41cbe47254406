# SPDX-License-Identifier: BSD-3-Clause
"""Values in space by the class and by the program: the same numbers; the volume is refined and evaluated like others."""
import json

import knotwork
import knotwork_testing
import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

RANDOM = numpy.random.default_rng(5)


def samples():
    xyz = RANDOM.uniform(size=(8000, 3))
    values = numpy.exp(-30 * ((xyz - 0.5) ** 2).sum(axis=1))
    data = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(xyz, deep=1))
    data.SetPoints(points)
    array = numpy_to_vtk(values, deep=1)
    array.SetName("Temperature")
    data.GetPointData().AddArray(array)
    return data


def test_class_and_program_agree():
    data = samples()
    fit = knotwork.vtkSplineVolumeFit()
    fit.SetInputData(data)
    fit.SetInputArrayToProcess(0, 0, 0, 0, "Temperature")
    fit.SetTolerance(0.02)
    fit.Update()
    distances = vtk_to_numpy(fit.GetOutputDataObject(1).GetPointData().GetArray("Distance"))
    assert distances.max() <= 0.02
    table = fit.GetOutputDataObject(2)
    functions = table.GetValueByName(table.GetNumberOfRows() - 1, "Functions").ToInt()
    cloud, output, report = (knotwork_testing.output(name) for name in ("cloud.vtp", "field.vtu", "field.json"))
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(data)
    writer.SetFileName(cloud)
    writer.Write()
    knotwork_testing.run_program("approximate", cloud, "--values", "Temperature", "--tolerance", "0.02", "--output", output, "--report", report)
    with open(report) as file:
        numbers = json.load(file)
    assert numbers["functions"] == functions and numbers["within_tolerance"] is True
    assert numbers["max_error"] == distances.max()


knotwork_testing.main(globals())
