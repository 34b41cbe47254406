// SPDX-License-Identifier: BSD-3-Clause
#include "NegativeJacobian.h"

#include "Bernstein.h"
#include "Parallel.h"

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
}

Result<double> NegativeJacobianShare(const BezierForm<2>& form, int pointsPerDirection, int threads)
{
  if (!form.Space || !form.Space->HasDomain || form.NumComponents != 2 || form.Rational)
  {
    return { ErrorCode::DimensionMismatch,
      "the share of negative Jacobians needs a polynomial planar map with a parameter domain" };
  }
  if (pointsPerDirection < 2 || pointsPerDirection > 100000)
  {
    return { ErrorCode::InvalidParameter,
      "points per direction must be in [2, 100000], not " + std::to_string(pointsPerDirection) };
  }
  const SplineSpace<2>& space = *form.Space;
  const ParametricBox<2> domain = space.Domain();
  std::array<std::vector<double>, 2> grid;
  for (std::size_t d = 0; d < 2; ++d)
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
        const SplineSpace<2>::Element& element = space.Elements[e];
        std::array<int, 2> first;
        std::array<int, 2> last; // one behind
        for (std::size_t d = 0; d < 2; ++d)
        {
          const ParametricBox<2>& box = element.Box;
          first[d] = FirstPointFrom(grid[d], box.Lower[d]);
          last[d] = box.Upper[d] == domain.Upper[d] ? pointsPerDirection
                                                    : FirstPointFrom(grid[d], box.Upper[d]);
        }
        const long long points =
          static_cast<long long>(last[0] - first[0]) * static_cast<long long>(last[1] - first[1]);
        if (points <= 0)
        {
          continue;
        }
        double magnitude = 0.0;
        const std::vector<double> det =
          DeterminantCoefficients(element.Degree, form.Block(static_cast<int>(e)), magnitude);
        const auto [low, high] = std::minmax_element(det.begin(), det.end());
        // Rounding of the products and of convex combinations of up to 18 x 18 of them.
        const double zero = 64.0 * std::numeric_limits<double>::epsilon() * magnitude;
        if (*low >= -zero)
        {
          continue;
        }
        if (*high < -zero)
        {
          negative[e] = points;
          continue;
        }
        const int du = 2 * element.Degree[0] - 1;
        const int dv = 2 * element.Degree[1] - 1;
        const Eigen::Map<const Eigen::MatrixXd> coefficients(det.data(), du + 1, dv + 1);
        const Eigen::MatrixXd tableU = BernsteinTable(
          du, grid[0], first[0], last[0], element.Box.Lower[0], element.Box.Upper[0]);
        const Eigen::MatrixXd tableV = BernsteinTable(
          dv, grid[1], first[1], last[1], element.Box.Lower[1], element.Box.Upper[1]);
        const Eigen::MatrixXd values = tableU.transpose() * (coefficients * tableV);
        negative[e] = (values.array() < -zero).count();
      }
    });
  const double total = double(pointsPerDirection) * double(pointsPerDirection);
  return double(std::accumulate(negative.begin(), negative.end(), 0LL)) / total;
}
}
