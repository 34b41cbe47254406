// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FitPoints.h"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace knotwork
{
/// Tells outliers from features that the surface does not follow yet: the distances of a feature's
/// points are alike, an outlier's is not like those of the points around it. A point is one when it
/// is outside its tolerance, and differs from the median of its neighbours by more than its
/// tolerance and more than a number of robust standard deviations (1.4826 times the median absolute
/// deviation) of the neighbours; with FitDeviation::Standard from their mean and by more than a
/// number of their standard deviations; unless
/// - as many of its eight nearest are off alike (to the same side and at least 0.3 times as far) as
///   outliers in this number, strewn at random, hardly ever are: two, or three or more where there
///   are many outliers. So the points of a ridge speak for each other.
/// - six of its eight nearest have its value, within the tolerance: it is the surface that is off,
///   beside a step.
/// - it lies on a step: a line through it parts its neighbours into two flat sides, at different
///   heights, and its value is between these. No other point need be as high as one in the middle
///   of a cliff.
///
/// Neighbours are the points in 3 x 3 cells of a grid with about four points a cell, more where
/// these hold less than twelve.
/// @source  Rousseeuw, Leroy, Robust Regression and Outlier Detection (1987), chapter 5 (median
/// absolute deviation).
class OutlierSearch
{
public:
  OutlierSearch(const PointCloud& cloud, const ParametricBox<2>& domain, int numMeasured,
    FitDeviation deviation);

  /// Decides anew about every point outside its tolerance and every outlier.
  /// @param outliers  n, in the cloud's order, updated. @param scale  FitParams::OutlierScale.
  /// @return elements with points whose state has changed; points.Base follows: 0 of an outlier,
  /// else the weight asked for.
  std::vector<int> Update(FitPoints& points, const std::vector<double>& weights, double scale,
    std::vector<std::uint8_t>& outliers, int threads) const;

private:
  /// The distances of all points in two orders: of the cloud's rows, and as Rows has them.
  struct Distances
  {
    std::vector<double> ByRow;
    std::vector<double> ByCell;
  };
  /// Ranges of Rows in the cells around a point.
  struct CellRows
  {
    std::array<std::array<int, 2>, 9> Ranges; ///< 2 MostRings + 1 at most
    int Count = 0;
    std::size_t NumRows = 0; ///< in all of them, the point itself too
  };

  int CellOf(std::size_t direction, double x) const;
  /// As many rings of cells as a point's neighbours need.
  CellRows RowsAround(int row) const;
  /// Whether a point is no farther than its tolerance from the median of its neighbours, as most
  /// are: the same as computing it, by counts alone.
  static bool IsNearMedian(
    const CellRows& around, const std::vector<double>& byCell, double own, double tolerance);
  struct Neighbour
  {
    double SquaredDistance = 0.0; ///< in cells
    int Row = 0;
    RealArray<2> Offset{}; ///< in cells, from the point
    bool operator<(const Neighbour& other) const
    {
      return std::tie(this->SquaredDistance, this->Row) <
        std::tie(other.SquaredDistance, other.Row);
    }
  };
  /// Memory that is kept between calls.
  struct Workspace
  {
    std::vector<Neighbour> Near;
    std::vector<double> Values;
    std::vector<double> Sides[2];
  };
  /// Fills work.Near; false when there are too few.
  bool FindNeighbours(int row, Workspace& work) const;
  /// How many of the nearest are off as the point is, of one that may be an outlier; else -1.
  int CountAlike(
    int row, const Distances& distances, double tolerance, double scale, Workspace& work) const;
  /// @pre work.Near are the neighbours; their order changes, the farthest are left out.
  bool IsCommon(int row, double tolerance, Workspace& work) const;
  bool IsOnStep(int row, double tolerance, Workspace& work) const;

  const PointCloud& Cloud;
  int NumMeasured;
  FitDeviation Deviation;
  ParametricBox<2> Domain;
  std::array<int, 2> Size{};
  std::vector<int> Start; ///< of a cell's rows
  std::vector<int> Rows;
};
}
