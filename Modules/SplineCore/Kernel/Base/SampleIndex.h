// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/BoxTree.h>

namespace knotwork
{
/// Spatial index of n points that may move: the first stage of every closest-point search (the
/// nearest of dense samples; Newton steps follow).
class SampleIndex
{
public:
  SampleIndex() = default;
  /// @param points  n x d, d in [1, 4], finite. @complexity O(n log n).
  explicit SampleIndex(PointMatrix points) : Points(std::move(points))
  {
    this->Tree = BoxTree(this->Points, this->Points);
  }
  /// The same n samples at new places. @complexity O(n).
  void Move(const PointMatrixView& points)
  {
    this->Points = points;
    this->Tree.Refit(this->Points, this->Points);
  }
  const PointMatrix& Samples() const { return this->Points; }

  /// Nearest sample (of equally near ones the first) with squared distance <= bound.
  NearestItem Nearest(
    const double* point, double bound = std::numeric_limits<double>::infinity()) const
  {
    const int dimension = this->Tree.Dimension();
    return this->Tree.Nearest(
      point,
      [&](int item)
      {
        const double* sample = this->Points.data() + static_cast<std::ptrdiff_t>(item) * dimension;
        double sum = 0.0;
        for (int d = 0; d < dimension; ++d)
        {
          sum += (sample[d] - point[d]) * (sample[d] - point[d]);
        }
        return sum;
      },
      bound);
  }

private:
  PointMatrix Points;
  BoxTree Tree;
};
}
