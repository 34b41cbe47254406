# SPDX-License-Identifier: BSD-3-Clause
"""A bumped quarter annulus from JSON through the parameterization to the validator, from Python."""
import json
import math

import knotwork
import knotwork_testing
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkUnstructuredGrid

HALF = math.sqrt(0.5)
boundary = {"curves": [
    {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "weights": [1, HALF, 1], "control_points": [[1, 0], [1, 1], [0, 1]]},
    {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "weights": [1, HALF, 1], "control_points": [[2, 0], [2, 2], [0, 2]]},
    {"degree": 1, "knots": [0, 0, 1, 1], "control_points": [[1, 0], [2, 0]]},
    {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "control_points": [[0, 1], [0.25, 1.5], [0, 2]]}]}
name = knotwork_testing.output("bumped_annulus.json")
with open(name, "w") as stream:
    json.dump(boundary, stream)

reader = knotwork.vtkDomainBoundaryReader()
reader.SetFileName(name)
domain = knotwork.vtkDomainParameterization()
domain.SetInputConnection(reader.GetOutputPort())
validator = knotwork.vtkJacobianValidator()
validator.SetInputConnection(domain.GetOutputPort())
validator.Update()
assert domain.GetVerdict() == 1 and validator.GetVerdict() == 1

# the area by the theorem of Green, from the map's proven measure and by hand: the quarter annulus less the bump
# int x dy over the bump's parabola x = 0.5 t (1 - t), y = 1 + t: 1 / 12
table = validator.GetOutputDataObject(2)
measure = table.GetValueByName(table.GetNumberOfRows() - 1, "Measure").ToDouble()
exact = math.pi * 3 / 4 - 1 / 12
assert abs(measure - exact) < 1e-12, (measure, exact)
field = domain.GetOutputDataObject(0).GetFieldData()
assert abs(field.GetArray("Area").GetTuple1(0) - exact) < 1e-12
history = domain.GetOutputDataObject(2)
assert history.GetNumberOfRows() > 1
assert history.GetValueByName(0, "Stage").ToString() == "initial"

# a ring of four patches: a mesh of quadrilaterals is the layout, arcs are its boundary
points = vtkPoints()
layout = vtkUnstructuredGrid()
layout.SetPoints(points)
arcs = []
for radius in 1, 2:
    for k in range(4):
        at = [math.pi / 4 * (2 * k + i) for i in range(3)]
        points.InsertNextPoint(radius * math.cos(at[0]), radius * math.sin(at[0]), 0)
        corners = [[radius * r * math.cos(a), radius * r * math.sin(a)] for a, r in zip(at, (1, math.sqrt(2), 1))]
        arcs.append({"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "weights": [1, HALF, 1], "control_points": corners})
for k in range(4):
    layout.InsertNextCell(VTK_QUAD, 4, [k, 4 + k, 4 + (k + 1) % 4, (k + 1) % 4])
name = knotwork_testing.output("ring_of_arcs.json")
with open(name, "w") as stream:
    json.dump({"curves": arcs}, stream)
reader.SetFileName(name)
domain.SetInputDataObject(1, layout)
domain.SetGapTolerance(1e-6)  # the mesh has single precision
validator.Update()
field = domain.GetOutputDataObject(0).GetFieldData()
assert domain.GetVerdict() == 1 and validator.GetVerdict() == 1
assert field.GetAbstractArray("Injective").GetValue(0) == "injective"
assert field.GetArray("Patches").GetTuple1(0) == 4
assert abs(field.GetArray("Area").GetTuple1(0) - 3 * math.pi) < 1e-12  # that of the arcs, not of the mesh
table = validator.GetOutputDataObject(2)
assert table.GetValueByName(table.GetNumberOfRows() - 1, "Injective").ToString() == "injective"
assert abs(table.GetValueByName(table.GetNumberOfRows() - 1, "Measure").ToDouble() - 3 * math.pi) < 1e-12
