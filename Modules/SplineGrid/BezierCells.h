// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkSplineGridModule.h" // for export macro
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include "vtkType.h"

#include <array>
#include <map>
#include <string>
#include <vector>

class vtkDataArray;
class vtkUnstructuredGrid;

namespace knotwork
{
/// What the Bezier cells of one grid are, cell by cell: degrees and weights by the rules of the
/// module's page (attribute, array of its name, copy; whichever passes the test of whole numbers).
/// Keeps the grid's arrays, which must not change meanwhile.
class VTKKNOTWORKSPLINEGRID_EXPORT BezierCells
{
public:
  explicit BezierCells(vtkUnstructuredGrid* grid);

  /// Point ids of a curve, quadrilateral or hexahedron in the order of its Bernstein coefficients,
  /// first direction fastest.
  /// @param where     opens the error's sentence ("patch 3, "); may be empty.
  /// @param expected  degree the cell must have; null for any.
  /// @return InvalidDegree naming the cell.
  template <int Dim>
  Status Read(const std::string& where, vtkIdType cell, const IntArray<Dim>* expected,
    IntArray<Dim>& degree, std::vector<vtkIdType>& points) const;

  /// (x, y, z, w) of a point; w = 1 where the grid has no weights.
  /// @return NonFiniteInput, InvalidWeight.
  Status ReadPoint(
    const std::string& where, vtkIdType cell, vtkIdType point, double* coordinates) const;

  bool HasWeights() const { return this->Weights != nullptr; }
  /// Whether a weight differs from 1.
  bool IsRational() const;

  /// What the arrays say of a cell's degrees, in the order of priority: whole numbers in
  /// [1, MaxDegree], 0 for components an array does not have.
  std::vector<std::array<int, 3>> DegreesOf(vtkIdType cell) const;

private:
  template <int Dim>
  Status ReadDegree(const std::string& where, vtkIdType cell, vtkIdType numPoints,
    const IntArray<Dim>* expected, IntArray<Dim>& degree) const;

  vtkUnstructuredGrid* Grid;
  std::vector<vtkDataArray*> Degrees; // in the order of priority
  vtkDataArray* Weights = nullptr;
  /// VtkPointOrder by degree; the degree of directions that a cell does not have is 0.
  mutable std::map<std::array<int, 3>, std::vector<int>> Orders;
};

/// "cell 12", as all messages name cells.
VTKKNOTWORKSPLINEGRID_EXPORT std::string CellName(vtkIdType cell);

/// 1, 2, 3 for VTK's Bezier curves, quadrilaterals and hexahedra, 0 for all other cell types.
VTKKNOTWORKSPLINEGRID_EXPORT int BezierCellDimension(int cellType);
}
