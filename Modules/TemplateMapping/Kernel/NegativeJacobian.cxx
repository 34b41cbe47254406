// SPDX-License-Identifier: BSD-3-Clause
#include "NegativeJacobian.h"

#include <knotwork/JacobianValidation/JacobianCertificate.h>
#include <knotwork/SplineCore/Bernstein.h>
#include <knotwork/SplineCore/Parallel.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace knotwork
{
namespace
{
/// Bernstein coefficients of det J with respect to the element's own parameters in [0, 1]^2, degree
/// (2p - 1, 2q - 1), first parameter fastest.
/// @param magnitude  the largest of the two products whose difference it is: rounding is relative
/// to it.
std::vector<double> DeterminantCoefficients(
  const IntArray<2>& degree, const double* block, double& magnitude)
{
  const std::size_t n = static_cast<std::size_t>(NumTensorFunctions<2>(degree));
  const std::vector<double> x(block, block + n);
  const std::vector<double> y(block + n, block + 2 * n);
  const IntArray<2> degreeU{ degree[0] - 1, degree[1] };
  const IntArray<2> degreeV{ degree[0], degree[1] - 1 };
  std::vector<double> det = BernsteinProduct<2>(
    degreeU, BernsteinDerivative<2>(degree, x, 0), degreeV, BernsteinDerivative<2>(degree, y, 1));
  const std::vector<double> minus = BernsteinProduct<2>(
    degreeV, BernsteinDerivative<2>(degree, x, 1), degreeU, BernsteinDerivative<2>(degree, y, 0));
  magnitude = 0.0;
  for (std::size_t i = 0; i < det.size(); ++i)
  {
    magnitude = std::max({ magnitude, std::abs(det[i]), std::abs(minus[i]) });
    det[i] -= minus[i];
  }
  return det;
}

/// First grid point at or beyond a break; the grid is begin + (end - begin) i / (n - 1).
int FirstPointFrom(const std::vector<double>& grid, double value)
{
  return static_cast<int>(std::lower_bound(grid.begin(), grid.end(), value) - grid.begin());
}

/// (degree + 1) x points: Bernstein values at grid points [first, last) of an element's interval.
Eigen::MatrixXd BernsteinTable(
  int degree, const std::vector<double>& grid, int first, int last, double lower, double upper)
{
  Eigen::MatrixXd table(degree + 1, last - first);
  for (int i = first; i < last; ++i)
  {
    const double t = (grid[static_cast<std::size_t>(i)] - lower) / (upper - lower);
    BernsteinValues(degree, t, table.col(i - first).data());
  }
  return table;
}

template <int Dim>
using Grid = std::array<std::vector<double>, Dim>;

/// Points of a grid's part in an element with det J < 0.
long long NegativePoints(const BezierForm<2>& form, int e, const Grid<2>& grid,
  const IntArray<2>& first, const IntArray<2>& last)
{
  const auto& element = form.Space->Elements[static_cast<std::size_t>(e)];
  double magnitude = 0.0;
  const std::vector<double> det = DeterminantCoefficients(element.Degree, form.Block(e), magnitude);
  const auto [low, high] = std::minmax_element(det.begin(), det.end());
  // Rounding of the products and of convex combinations of up to 18 x 18 of them.
  const double zero = 64.0 * std::numeric_limits<double>::epsilon() * magnitude;
  if (*low >= -zero)
  {
    return 0;
  }
  if (*high < -zero)
  {
    return static_cast<long long>(last[0] - first[0]) * (last[1] - first[1]);
  }
  const int du = 2 * element.Degree[0] - 1;
  const int dv = 2 * element.Degree[1] - 1;
  const Eigen::Map<const Eigen::MatrixXd> coefficients(det.data(), du + 1, dv + 1);
  const Eigen::MatrixXd tableU =
    BernsteinTable(du, grid[0], first[0], last[0], element.Box.Lower[0], element.Box.Upper[0]);
  const Eigen::MatrixXd tableV =
    BernsteinTable(dv, grid[1], first[1], last[1], element.Box.Lower[1], element.Box.Upper[1]);
  const Eigen::MatrixXd values = tableU.transpose() * (coefficients * tableV);
  return (values.array() < -zero).count();
}

/// In space most elements of a map are proved positive by their certificate; in the others det J is
/// evaluated at the points.
long long NegativePoints(const BezierForm<3>& form, int e, const Grid<3>& grid,
  const IntArray<3>& first, const IntArray<3>& last)
{
  const auto& element = form.Space->Elements[static_cast<std::size_t>(e)];
  BernsteinCells cell;
  cell.NumComponents = 3;
  cell.Add(CellShape::Hexahedron, { element.Degree[0], element.Degree[1], element.Degree[2] });
  std::copy_n(form.Block(e), cell.Data.size(), cell.Block(0));
  JacobianParams params;
  params.MaxBoxes = 1;
  params.Threads = 1;
  const auto certificate = ValidateJacobian(cell, params);
  if (certificate && certificate->Verdict == Verdict::Valid)
  {
    return 0;
  }
  const Eigen::Index count =
    Eigen::Index(last[0] - first[0]) * (last[1] - first[1]) * (last[2] - first[2]);
  PointMatrix local(count, 3);
  Eigen::Index row = 0;
  IntArray<3> i;
  for (i[2] = first[2]; i[2] < last[2]; ++i[2])
  {
    for (i[1] = first[1]; i[1] < last[1]; ++i[1])
    {
      for (i[0] = first[0]; i[0] < last[0]; ++i[0], ++row)
      {
        for (std::size_t d = 0; d < 3; ++d)
        {
          local(row, static_cast<Eigen::Index>(d)) =
            (grid[d][static_cast<std::size_t>(i[d])] - element.Box.Lower[d]) /
            (element.Box.Upper[d] - element.Box.Lower[d]);
        }
      }
    }
  }
  EvaluationBatch batch;
  EvaluateElements(
    form, std::vector<int>(static_cast<std::size_t>(count), e), local, { 1, 1 }, batch);
  long long negative = 0;
  for (row = 0; row < count; ++row)
  {
    const Eigen::Map<const Eigen::Matrix3d> jacobian(batch.First.row(row).data());
    const double size = jacobian.col(0).norm() * jacobian.col(1).norm() * jacobian.col(2).norm();
    negative += jacobian.determinant() < -64.0 * std::numeric_limits<double>::epsilon() * size;
  }
  return negative;
}
}

template <int Dim>
Result<double> NegativeJacobianShare(
  const BezierForm<Dim>& form, int pointsPerDirection, int threads)
{
  constexpr int most = Dim == 2 ? 100000 : 2000;
  if (!form.Space || !form.Space->HasDomain() || form.NumComponents != Dim || form.Rational)
  {
    return { ErrorCode::DimensionMismatch,
      "the share of negative Jacobians needs a polynomial map of a parameter domain with as many "
      "components as parameters" };
  }
  if (pointsPerDirection < 2 || pointsPerDirection > most)
  {
    return { ErrorCode::InvalidParameter,
      "points per direction must be in [2, " + std::to_string(most) + "], not " +
        std::to_string(pointsPerDirection) };
  }
  const SplineSpace<Dim>& space = *form.Space;
  const ParametricBox<Dim> domain = space.Domain();
  Grid<Dim> grid;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    grid[d].resize(static_cast<std::size_t>(pointsPerDirection));
    for (int i = 0; i < pointsPerDirection; ++i)
    {
      grid[d][static_cast<std::size_t>(i)] =
        domain.Lower[d] + (domain.Upper[d] - domain.Lower[d]) * i / (pointsPerDirection - 1);
    }
    grid[d].back() = domain.Upper[d];
  }

  std::vector<long long> negative(static_cast<std::size_t>(space.NumElements()), 0);
  ParallelFor(negative.size(), 8, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t e = begin; e < end; ++e)
      {
        const ParametricBox<Dim>& box = space.Elements[e].Box;
        IntArray<Dim> first;
        IntArray<Dim> last; // one behind
        bool isEmpty = false;
        for (std::size_t d = 0; d < Dim; ++d)
        {
          first[d] = FirstPointFrom(grid[d], box.Lower[d]);
          last[d] = box.Upper[d] == domain.Upper[d] ? pointsPerDirection
                                                    : FirstPointFrom(grid[d], box.Upper[d]);
          isEmpty = isEmpty || last[d] <= first[d];
        }
        if (!isEmpty)
        {
          negative[e] = NegativePoints(form, static_cast<int>(e), grid, first, last);
        }
      }
    });
  return double(std::accumulate(negative.begin(), negative.end(), 0LL)) /
    std::pow(double(pointsPerDirection), Dim);
}

template Result<double> NegativeJacobianShare(const BezierForm<2>&, int, int);
template Result<double> NegativeJacobianShare(const BezierForm<3>&, int, int);
}
