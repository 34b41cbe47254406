# SPDX-License-Identifier: BSD-3-Clause
"""A bumped quarter annulus from JSON through the parameterization to the validator, from Python."""
import json
import math

import knotwork
import knotwork_testing
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_QUAD, vtkPolyData, vtkUnstructuredGrid

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

# z^2 on a stretched rectangle has a harmonic inverse: the variational harmonic map is that map, the harmonic one another
QUADRATIC = {"degree": 2, "knots": [0, 0, 0, 1, 1, 1]}
A, B = 1.6, 0.7  # z = 1 + A u + i B v


def squared(i, j):
    """Bernstein coefficient of z^2 over the unit square."""
    u, v, uu, vv = i / 2, j / 2, float(i == 2), float(j == 2)
    return [1 + 2 * A * u + A * A * uu - B * B * vv, 2 * B * v + 2 * A * B * u * v]


sides = ([[squared(i, j) for j in range(3)] for i in (0, 2)] + [[squared(i, j) for i in range(3)] for j in (0, 2)])
name = knotwork_testing.output("square_of_z.json")
with open(name, "w") as stream:
    json.dump({"curves": [dict(QUADRATIC, control_points=side) for side in sides]}, stream)
reader.SetFileName(name)
middles = {}
for initial in (domain.HARMONIC, domain.VARIATIONAL_HARMONIC):
    domain.SetInitialMap(initial)
    domain.Update()
    evaluate = knotwork.vtkSplineEvaluate()
    evaluate.SetInputConnection(0, domain.GetOutputPort(1))
    at = vtkPoints()
    at.InsertNextPoint(0.5, 0.5, 0)
    place = vtkPolyData()
    place.SetPoints(at)
    evaluate.SetInputDataObject(1, place)
    evaluate.Update()
    middles[initial] = evaluate.GetOutput().GetPoint(0)
middle = (1 + A / 2) ** 2 - (B / 2) ** 2, 2 * (1 + A / 2) * B / 2
assert math.dist(middles[domain.VARIATIONAL_HARMONIC][:2], middle) < 1e-8
assert math.dist(middles[domain.HARMONIC][:2], middle) > 1e-2
domain.SetInitialMap(domain.INITIAL_AUTOMATIC)

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
