// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitPoints.h"

namespace knotwork
{
/// Tells outliers from features that the surface does not follow yet: the distances of a feature's
/// points are alike, an outlier's is not like those of the points around it. A point is one when it
/// is outside its tolerance, and differs from the median of its neighbours by more than its
/// tolerance and more than a number of robust standard deviations (1.4826 times the median absolute
/// deviation) of the neighbours, and at most one of its eight nearest is off alike (to the same
/// side and at least 0.3 times as far): the points of a ridge or a cliff narrower than a
/// neighbourhood speak for each other.
///
/// Neighbours are the points in 3 x 3 cells of a grid with about four points a cell, more where
/// these hold less than twelve.
/// @source  Rousseeuw, Leroy, Robust Regression and Outlier Detection (1987), chapter 5 (median
/// absolute deviation).
class OutlierSearch
{
public:
  OutlierSearch(const PointCloud& cloud, const ParametricBox<2>& domain);

  /// Decides anew about every point outside its tolerance and every outlier.
  /// @param outliers  n, in the cloud's order, updated. @param scale  FitParams::OutlierScale.
  /// @return elements with points whose state has changed; points.Base follows: 0 of an outlier,
  /// else the weight asked for.
  std::vector<int> Update(FitPoints& points, const std::vector<double>& weights, double scale,
    std::vector<std::uint8_t>& outliers, int threads) const;

private:
  int CellOf(std::size_t direction, double x) const;
  /// Memory that is kept between calls.
  struct Work
  {
    std::vector<std::pair<double, int>> Near; ///< squared distance in cells, row
    std::vector<double> Values;
  };
  bool IsOutlier(int row, const std::vector<double>& distances, double tolerance, double scale,
    Work& work) const;

  const PointCloud& Cloud;
  ParametricBox<2> Domain;
  std::array<int, 2> Size{};
  std::vector<int> Start; ///< of a cell's rows
  std::vector<int> Rows;
};
}
