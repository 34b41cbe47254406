// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkKnotworkJacobianValidationModule.h" // for export macro
#include <knotwork/SplineCore/LatticeInterpolation.h>

#include "vtkType.h"

#include <vector>

namespace knotwork
{
/// How the points of a VTK cell become the Bernstein coefficients of the same geometry.
struct CellConversion
{
  CellShape Shape = CellShape::Quadrilateral;
  CellDegree Degree{};
  /// Coefficient k is point Points[k]; empty when Matrix is needed.
  std::vector<int> Points;
  /// Coefficients x points; more digits than doubles have, so that the collapsed sides of pyramids
  /// are exact and what is beside them is known to far less than the points are.
  LongMatrix Matrix;
  /// Coefficients x points, times |points|: what the conversion may be off by, all of it: rounding
  /// of the matrix' entries, of the products and of the sums.
  Eigen::MatrixXd Bound;
};

/// Shape and degree of a cell type that is not of higher order; degree 0 in the first direction for
/// every other type.
CellConversion FixedCellShape(int cellType);

/// The change of basis between VTK's shape functions of a cell, as the cell class itself evaluates
/// them at the nodes of the Bernstein lattice, and Bernstein polynomials. Serendipity cells become
/// cells of the full space, pyramids hexahedra whose upper side (w = 1) is the apex: det J of these
/// is (1 - w)^2 times that of the pyramid over a pyramid, as x - apex has the factor 1 - w.
/// @param cellType   linear, quadratic, Lagrange or Bezier cell.
/// @param degree     of a higher-order cell.
/// @return InvalidTopology when the cell class is not of this kind.
/// @complexity a dense inverse of one direction's (simplex') collocation matrix.
VTKKNOTWORKJACOBIANVALIDATION_EXPORT Result<CellConversion> MakeCellConversion(
  int cellType, CellShape shape, const CellDegree& degree, vtkIdType numPoints);
}
