# SPDX-License-Identifier: BSD-3-Clause
"""A bumped quarter annulus from JSON through the parameterization to the validator, from Python."""
import json
import math

import knotwork
import knotwork_testing

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
