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

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

long double Power(long double x, int n)
{
  long double result = 1.0L;
  for (int i = 0; i < n; ++i)
  {
    result *= x;
  }
  return result;
}

long double Factorial(int n)
{
  long double result = 1.0L;
  for (int i = 2; i <= n; ++i)
  {
    result *= i;
  }
  return result;
}

/// Exponents of the Bernstein polynomials of a simplex with `parameters` parameters, in the order
/// of BernsteinCells; the last is that of 1 - sum.
std::vector<std::array<int, 4>> Exponents(int parameters, int p)
{
  std::vector<std::array<int, 4>> all;
  for (int k = 0; k <= (parameters > 2 ? p : 0); ++k)
  {
    for (int j = 0; j <= (parameters > 1 ? p - k : 0); ++j)
    {
      for (int i = 0; i <= p - j - k; ++i)
      {
        all.push_back({ i, j, k, p - i - j - k });
      }
    }
  }
  return all;
}

/// Values of a simplex' Bernstein polynomials (columns) at the nodes exponents / p (rows).
Matrix Collocation(int parameters, int p)
{
  const auto exponents = Exponents(parameters, p);
  const auto n = static_cast<Eigen::Index>(exponents.size());
  Matrix values(n, n);
  for (Eigen::Index r = 0; r < n; ++r)
  {
    const auto& node = exponents[static_cast<std::size_t>(r)];
    for (Eigen::Index c = 0; c < n; ++c)
    {
      long double value = Factorial(p);
      for (std::size_t d = 0; d < 4; ++d)
      {
        const int e = exponents[static_cast<std::size_t>(c)][d];
        value *= Power(static_cast<long double>(node[d]) / p, e) / Factorial(e);
      }
      values(r, c) = value;
    }
  }
  return values;
}

/// The simplices whose product the cell is: parameters and degree of each, the fastest first.
std::vector<std::array<int, 2>> SimplicesOf(CellShape shape, const CellDegree& degree)
{
  switch (shape)
  {
    case CellShape::Triangle:
      return { { 2, degree[0] } };
    case CellShape::Tetrahedron:
      return { { 3, degree[0] } };
    case CellShape::Wedge:
      return { { 2, degree[0] }, { 1, degree[2] } };
    default:
    {
      std::vector<std::array<int, 2>> lines;
      for (int d = 0; d < NumParameters(shape); ++d)
      {
        lines.push_back({ 1, degree[static_cast<std::size_t>(d)] });
      }
      return lines;
    }
  }
}

/// Kronecker product of the factors (the first fastest) times x.
Matrix Apply(const std::vector<Matrix>& factors, Matrix x)
{
  Eigen::Index inner = 1;
  for (const Matrix& factor : factors)
  {
    const Eigen::Index n = factor.rows();
    Matrix y = Matrix::Zero(x.rows(), x.cols());
    for (Eigen::Index row = 0; row < x.rows(); ++row)
    {
      const Eigen::Index i = row / inner % n;
      for (Eigen::Index j = 0; j < n; ++j)
      {
        y.row(row) += factor(i, j) * x.row(row + (j - i) * inner);
      }
    }
    x = std::move(y);
    inner *= n;
  }
  return x;
}

std::vector<Matrix> Absolute(std::vector<Matrix> factors)
{
  for (Matrix& factor : factors)
  {
    factor = factor.cwiseAbs().eval();
  }
  return factors;
}

/// VTK's shape functions (columns) at the lattice of the Bernstein polynomials (rows).
Matrix ShapeFunctions(int cellType, CellShape shape, const CellDegree& degree, vtkIdType numPoints)
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

  const auto lines = SimplicesOf(shape, degree);
  Matrix values(NumCellCoefficients(shape, degree), numPoints);
  std::vector<double> weights(static_cast<std::size_t>(numPoints));
  for (Eigen::Index row = 0; row < values.rows(); ++row)
  {
    double at[3] = {};
    Eigen::Index rest = row;
    int d = 0;
    for (const auto& [parameters, p] : lines)
    {
      const auto exponents = Exponents(parameters, p);
      const auto n = static_cast<Eigen::Index>(exponents.size());
      for (int k = 0; k < parameters; ++k, ++d)
      {
        at[d] = static_cast<double>(
                  exponents[static_cast<std::size_t>(rest % n)][static_cast<std::size_t>(k)]) /
          p;
      }
      rest /= n;
    }
    cell->InterpolateFunctions(at, weights.data());
    for (Eigen::Index i = 0; i < numPoints; ++i)
    {
      values(row, i) = weights[static_cast<std::size_t>(i)];
    }
  }
  return values;
}

/// Takes numbers within 1e-9 of multiples of a step as such. @return whether all were.
bool Snap(Matrix& values, long double step)
{
  Matrix snapped = (values / step).unaryExpr([](long double x) { return std::round(x); }) * step;
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

  std::vector<Matrix> collocation;
  std::vector<Matrix> inverse;
  for (const auto& [parameters, p] : SimplicesOf(shape, degree))
  {
    collocation.push_back(Collocation(parameters, p));
    inverse.push_back(collocation.back().fullPivLu().inverse());
  }
  Matrix shapeFunctions = ShapeFunctions(cellType, shape, degree, numPoints);
  if (!shapeFunctions.allFinite())
  {
    return unknown;
  }
  // At the lattice the shape functions of nodal cells are 0 or 1, those of serendipity cells
  // multiples of 1/8; Bezier cells are a permutation once converted.
  const bool bezier = IsBezier(cellType);
  if (!bezier && !Snap(shapeFunctions, 1.0L / 64.0L))
  {
    return unknown;
  }
  Matrix matrix = Apply(inverse, shapeFunctions);
  if (bezier && !Snap(matrix, 1.0L))
  {
    return unknown;
  }

  bool permutes = matrix.rows() == matrix.cols();
  for (Eigen::Index k = 0; k < matrix.rows() && permutes; ++k)
  {
    Eigen::Index point = 0;
    permutes = matrix.row(k).maxCoeff(&point) == 1.0L && matrix.row(k).cwiseAbs().sum() == 1.0L;
    result.Permutation.push_back(static_cast<int>(point));
  }
  if (permutes)
  {
    return result;
  }
  if (bezier)
  {
    return unknown;
  }
  result.Permutation.clear();
  // what should be zero is some 1e-19 here; the bound below knows what is dropped
  result.Matrix =
    matrix.unaryExpr([](long double m) { return std::fabs(m) < 1e-15L ? 0.0L : m; }).cast<double>();
  // M - exact = B^-1 (B M - W) for the matrix M that is used; the residual in long double is off by
  // less than 64 of its roundings times |B| |M|. Then one rounding a product and one a sum.
  const Matrix used = result.Matrix.cast<long double>();
  constexpr long double longRounding = std::numeric_limits<long double>::epsilon();
  const Matrix residual = (Apply(collocation, used) - shapeFunctions).cwiseAbs() +
    64.0L * longRounding * Apply(Absolute(collocation), used.cwiseAbs());
  const long double sums = static_cast<long double>(numPoints + 2) * 0x1p-53L;
  result.Bound =
    (1.0625L * (Apply(Absolute(inverse), residual) + sums * used.cwiseAbs())).cast<double>();
  return result;
}
}
