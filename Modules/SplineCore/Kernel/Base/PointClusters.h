// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace knotwork
{
/// Numbers points so that points within a tolerance of an earlier one get its number: how sides of
/// patches are recognised as one when their control points agree but for rounding (patches of a
/// dataset have no topology between them; orders of summation differ with the orientation).
class PointClusters
{
public:
  /// Relative to the largest coordinate: far above rounding (1e-15), far below any feature.
  static constexpr double RelativeTolerance = 1e-12;

  /// @param dimension  values of a point, 1..8. @param tolerance  >= 0, in every coordinate.
  PointClusters(int dimension, double tolerance) : D(dimension), Tolerance(tolerance) {}

  /// Number of a point (finite values); the lowest number among earlier points within the
  /// tolerance, else a new one.
  /// @complexity O(2^dimension) expected.
  int Number(const double* point);

private:
  int D;
  double Tolerance;
  std::vector<double> Points; ///< first point of every number
  std::unordered_multimap<std::uint64_t, int> Cells;
};
}
