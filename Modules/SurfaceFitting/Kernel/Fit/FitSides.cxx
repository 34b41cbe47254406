// SPDX-License-Identifier: BSD-3-Clause
#include "FitSides.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
constexpr double RoundingShare = 1e-9; // of a band, left free at its sides
constexpr double RoundingUnits = 64.0; // of the largest coefficient: evaluations differ by less
constexpr double PointsPerCell = 4.0;
constexpr int MostCells = 4096; // a direction

double SignOf(FitSide side)
{
  return side == FitSide::Above ? 1.0 : -1.0; // FitSide::Above: the surface is above
}
}

std::vector<double> EvenBands(const PointMatrix& parameters, const ParametricBox<2>& domain,
  const std::vector<double>& tolerances)
{
  const auto [least, most] = std::minmax_element(tolerances.begin(), tolerances.end());
  if (*least == *most)
  {
    return tolerances;
  }
  const RealArray<2> size{ domain.Upper[0] - domain.Lower[0], domain.Upper[1] - domain.Lower[1] };
  const double cells = static_cast<double>(tolerances.size()) / PointsPerCell;
  IntArray<2> count{};
  for (std::size_t d = 0; d < 2; ++d)
  {
    count[d] = static_cast<int>(
      std::clamp(std::sqrt(cells * size[d] / size[1 - d]), 1.0, static_cast<double>(MostCells)));
  }
  const auto cellOf = [&](std::size_t i, std::size_t d)
  {
    const double x = parameters(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(d));
    return std::clamp(
      static_cast<int>((x - domain.Lower[d]) / size[d] * count[d]), 0, count[d] - 1);
  };
  const auto at = [&](int x, int y)
  {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(count[0]) +
      static_cast<std::size_t>(x);
  };
  std::vector<double> smallest(at(count[0] - 1, count[1] - 1) + 1, *most);
  for (std::size_t i = 0; i < tolerances.size(); ++i)
  {
    double& own = smallest[at(cellOf(i, 0), cellOf(i, 1))];
    own = std::min(own, tolerances[i]);
  }
  std::vector<double> bands = tolerances;
  for (std::size_t i = 0; i < bands.size(); ++i)
  {
    const int x = cellOf(i, 0);
    const int y = cellOf(i, 1);
    for (int b = std::max(0, y - 1); b <= std::min(count[1] - 1, y + 1); ++b)
    {
      for (int a = std::max(0, x - 1); a <= std::min(count[0] - 1, x + 1); ++a)
      {
        bands[i] = std::min(bands[i], smallest[at(a, b)]);
      }
    }
  }
  return bands;
}

void MoveToBands(FitSide side, const std::vector<double>& bands, FitPoints& points)
{
  for (std::size_t i = 0; i < points.Size(); ++i)
  {
    const double band = bands[static_cast<std::size_t>(points.Order[i])];
    points.Values[0][i] += SignOf(side) * 0.5 * band;
    points.Tolerance[i] = 0.5 * (1.0 - RoundingShare) * band;
  }
}

void MoveFromBands(
  const PointCloud& cloud, const std::vector<double>& tolerances, FitPoints& points)
{
  for (std::size_t i = 0; i < points.Size(); ++i)
  {
    const int row = points.Order[i];
    points.Values[0][i] = cloud.Values(row, 0);
    points.Tolerance[i] = tolerances[static_cast<std::size_t>(row)];
  }
}

void ShiftToSide(FitSide side, const ElementFunctions& functions, const FitPoints& points,
  PointMatrix& coefficients)
{
  std::vector<double> shift(static_cast<std::size_t>(functions.NumFunctions), 0.0);
  for (int e = 0; e < functions.NumElements(); ++e)
  {
    const FitPoints::Range& range = points.Ranges[static_cast<std::size_t>(e)];
    double largest = 0.0;
    for (int k = 0; k < functions.Alive(e); ++k)
    {
      const std::size_t entry = functions.First(e) + static_cast<std::size_t>(k);
      largest = std::max(largest, std::fabs(coefficients(functions.Functions[entry], 0)));
    }
    const double rounding = RoundingUnits * std::numeric_limits<double>::epsilon() * largest;
    double most = 0.0;
    for (std::size_t i = range.Begin; i < range.End; ++i)
    {
      if (points.Base[i] > 0.0)
      {
        most = std::max(most, SignOf(side) * points.Distance[i] + rounding);
      }
    }
    if (most > 0.0)
    {
      for (int k = 0; k < functions.Alive(e); ++k)
      {
        const std::size_t entry = functions.First(e) + static_cast<std::size_t>(k);
        double& own = shift[static_cast<std::size_t>(functions.Functions[entry])];
        own = std::max(own, most);
      }
    }
  }
  for (Eigen::Index f = 0; f < coefficients.rows(); ++f)
  {
    coefficients(f, 0) += SignOf(side) * shift[static_cast<std::size_t>(f)];
  }
}
}
