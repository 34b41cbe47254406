// SPDX-License-Identifier: BSD-3-Clause
#include "FitSides.h"

#include <algorithm>

namespace knotwork
{
namespace
{
constexpr double RoundingShare = 1e-9; // of a band, left free at its sides

double SignOf(FitSide side)
{
  return side == FitSide::Above ? 1.0 : -1.0; // FitSide::Above: the surface is above
}
}

void MoveToBands(FitSide side, FitPoints& points)
{
  for (std::size_t i = 0; i < points.Size(); ++i)
  {
    points.Values[0][i] += SignOf(side) * 0.5 * points.Tolerance[i];
    points.Tolerance[i] *= 0.5 * (1.0 - RoundingShare);
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
    double most = 0.0;
    for (std::size_t i = range.Begin; i < range.End; ++i)
    {
      if (points.Base[i] > 0.0)
      {
        most = std::max(most, SignOf(side) * points.Distance[i]);
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
