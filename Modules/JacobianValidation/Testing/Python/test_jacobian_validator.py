# SPDX-License-Identifier: BSD-3-Clause
"""The validator from Python: a plate with a hole is valid; moving a point of it folds a cell, which is named."""
import knotwork
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

source = knotwork.vtkSplineSource()
source.SetShape(knotwork.vtkSplineSource.ANNULUS_SECTOR)
source.SetElements(4, 4, 1)
validator = knotwork.vtkJacobianValidator()
validator.SetInputConnection(source.GetOutputPort())
validator.Update()
assert validator.GetVerdict() == 1
verdicts = vtk_to_numpy(validator.GetOutputDataObject(0).GetCellData().GetArray("JacobianVerdict"))
assert (verdicts == 1).all() and len(verdicts) == 16

folded = vtkUnstructuredGrid()
folded.DeepCopy(source.GetOutputDataObject(0))
points = vtk_to_numpy(folded.GetPoints().GetData())
corner = folded.GetCell(5).GetPointId(0)
points[corner] += [0.3, 0.3, 0]
validator.SetInputData(folded)
validator.Update()
assert validator.GetVerdict() == -1
verdicts = vtk_to_numpy(validator.GetOutputDataObject(0).GetCellData().GetArray("JacobianVerdict"))
assert -1 in verdicts and 1 in verdicts
table = validator.GetOutputDataObject(2)
last = table.GetNumberOfRows() - 1
assert table.GetValueByName(last, "InvalidCells").ToInt() == (verdicts == -1).sum()
witnesses = validator.GetOutputDataObject(1)
cells = vtk_to_numpy(witnesses.GetCellData().GetArray("CellId"))
assert set(cells) == set((verdicts == -1).nonzero()[0])
