// SPDX-License-Identifier: BSD-3-Clause
#include "CellConversion.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
/// VTK's parameters of a place in a cell of ours. The shape functions of pyramids of 5 and 13 nodes
/// are polynomials of degree 1 and 2 in parameters of the unit cube, whose upper side is the apex.
/// Those of 19 nodes are over a pyramid with its base at t = 1/2 and its apex at (1/2, 1/2, 1), and
/// rational; in (u, v, w) of the cube, r = 1/2 + (u - 1/2) (1 - w), s alike, t = (1 + w) / 2, they
/// are polynomials of degree (2, 2, 3).
std::array<double, 3> VtkParameters(int cellType, const std::array<double, 3>& at)
{
  if (cellType != VTK_TRIQUADRATIC_PYRAMID)
  {
    return at;
  }
  const double width = 1.0 - at[2];
  return { 0.5 + (at[0] - 0.5) * width, 0.5 + (at[1] - 0.5) * width, 0.5 + 0.5 * at[2] };
}

/// VTK's shape functions (columns) at the lattice of the Bernstein polynomials (rows).
LongMatrix ShapeFunctions(
  int cellType, CellShape shape, const CellDegree& degree, vtkIdType numPoints)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < numPoints; ++i)
  {
    points->InsertNextPoint(static_cast<double>(i), 0.0, 0.0);
    ids->InsertNextId(i);
  }
  grid->SetPoints(points);
  grid->Allocate(1);
  grid->InsertNextCell(cellType, ids);
  vtkNew<vtkDoubleArray> degrees;
  degrees->SetName("HigherOrderDegrees");
  degrees->SetNumberOfComponents(3);
  degrees->InsertNextTuple3(degree[0], degree[1], degree[2]);
  grid->GetCellData()->SetHigherOrderDegrees(degrees);
  vtkNew<vtkGenericCell> cell;
  grid->GetCell(0, cell);

  const auto lattice = LatticeParameters(shape, degree);
  LongMatrix values(static_cast<Eigen::Index>(lattice.size()), numPoints);
  std::vector<double> weights(static_cast<std::size_t>(numPoints));
  for (Eigen::Index row = 0; row < values.rows(); ++row)
  {
    const auto at = VtkParameters(cellType, lattice[static_cast<std::size_t>(row)]);
    cell->InterpolateFunctions(at.data(), weights.data());
    for (Eigen::Index i = 0; i < numPoints; ++i)
    {
      values(row, i) = weights[static_cast<std::size_t>(i)];
    }
  }
  return values;
}

/// Takes numbers within 1e-9 of multiples of 1 / parts as such. @return whether all were.
bool Snap(LongMatrix& values, long double parts)
{
  LongMatrix snapped =
    (values * parts).unaryExpr([](long double x) { return std::round(x); }) / parts;
  const bool all = (snapped - values).cwiseAbs().maxCoeff() < 1e-9L;
  values = std::move(snapped);
  return all;
}

bool IsBezier(int cellType)
{
  return cellType >= VTK_BEZIER_CURVE && cellType <= VTK_BEZIER_WEDGE;
}
}

CellConversion FixedCellShape(int cellType)
{
  CellConversion result;
  const auto is = [&](CellShape shape, const CellDegree& degree)
  {
    result.Shape = shape;
    result.Degree = degree;
  };
  switch (cellType)
  {
    case VTK_LINE:
      is(CellShape::Curve, { 1, 0, 0 });
      break;
    case VTK_QUADRATIC_EDGE:
      is(CellShape::Curve, { 2, 0, 0 });
      break;
    case VTK_QUAD:
    case VTK_PIXEL:
      is(CellShape::Quadrilateral, { 1, 1, 0 });
      break;
    case VTK_QUADRATIC_LINEAR_QUAD:
      is(CellShape::Quadrilateral, { 2, 1, 0 });
      break;
    case VTK_QUADRATIC_QUAD:
    case VTK_BIQUADRATIC_QUAD:
      is(CellShape::Quadrilateral, { 2, 2, 0 });
      break;
    case VTK_HEXAHEDRON:
    case VTK_VOXEL:
      is(CellShape::Hexahedron, { 1, 1, 1 });
      break;
    case VTK_QUADRATIC_HEXAHEDRON:
    case VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON:
    case VTK_TRIQUADRATIC_HEXAHEDRON:
      is(CellShape::Hexahedron, { 2, 2, 2 });
      break;
    case VTK_TRIANGLE:
      is(CellShape::Triangle, { 1, 1, 0 });
      break;
    case VTK_QUADRATIC_TRIANGLE:
      is(CellShape::Triangle, { 2, 2, 0 });
      break;
    case VTK_TETRA:
      is(CellShape::Tetrahedron, { 1, 1, 1 });
      break;
    case VTK_QUADRATIC_TETRA:
      is(CellShape::Tetrahedron, { 2, 2, 2 });
      break;
    case VTK_WEDGE:
      is(CellShape::Wedge, { 1, 1, 1 });
      break;
    case VTK_QUADRATIC_LINEAR_WEDGE:
      is(CellShape::Wedge, { 2, 2, 1 });
      break;
    case VTK_QUADRATIC_WEDGE:
    case VTK_BIQUADRATIC_QUADRATIC_WEDGE:
      is(CellShape::Wedge, { 2, 2, 2 });
      break;
    // hexahedra with one side in one place: see VtkParameters
    case VTK_PYRAMID:
      is(CellShape::Hexahedron, { 1, 1, 1 });
      break;
    case VTK_QUADRATIC_PYRAMID:
      is(CellShape::Hexahedron, { 2, 2, 2 });
      break;
    case VTK_TRIQUADRATIC_PYRAMID:
      is(CellShape::Hexahedron, { 2, 2, 3 });
      break;
    default:
      break;
  }
  return result;
}

Result<CellConversion> MakeCellConversion(
  int cellType, CellShape shape, const CellDegree& degree, vtkIdType numPoints)
{
  CellConversion result;
  result.Shape = shape;
  result.Degree = degree;
  const Status unknown{ ErrorCode::InvalidTopology,
    "the shape functions of cell type " + std::to_string(cellType) + " with " +
      std::to_string(numPoints) + " points are not those of its degree" };

  const LatticeInterpolation interpolation(shape, degree);
  LongMatrix shapeFunctions = ShapeFunctions(cellType, shape, degree, numPoints);
  if (!shapeFunctions.allFinite())
  {
    return unknown;
  }
  // At the lattice the shape functions of nodal cells are 0 or 1, those of serendipity cells
  // multiples of 1/8, those of triquadratic pyramids of 1/54; Bezier cells are a permutation once
  // converted.
  const bool bezier = IsBezier(cellType);
  if (!bezier && !Snap(shapeFunctions, 64.0L * 27.0L))
  {
    return unknown;
  }
  LongMatrix matrix = interpolation.Coefficients(shapeFunctions);
  if (bezier && !Snap(matrix, 1.0L))
  {
    return unknown;
  }

  bool selects = true; // pyramids: the apex several times
  for (Eigen::Index k = 0; k < matrix.rows() && selects; ++k)
  {
    Eigen::Index point = 0;
    selects = matrix.row(k).maxCoeff(&point) == 1.0L && matrix.row(k).cwiseAbs().sum() == 1.0L;
    result.Points.push_back(static_cast<int>(point));
  }
  if (selects)
  {
    return result;
  }
  if (bezier)
  {
    return unknown;
  }
  result.Points.clear();
  // what should be zero is some 1e-19 here; the bound below knows what is dropped
  result.Matrix = matrix.unaryExpr([](long double m) { return std::fabs(m) < 1e-15L ? 0.0L : m; });
  result.Bound = interpolation.Bound(
    shapeFunctions, result.Matrix, 0.5L * std::numeric_limits<long double>::epsilon());
  return result;
}
}
