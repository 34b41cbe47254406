// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <vector>

namespace knotwork
{
/// Finds the box of a partition of a rectangle into boxes that holds a point: a uniform grid of
/// buckets, about four a box, and below a bucket that several boxes meet a tree of cuts along the
/// boxes' sides. A side belongs to the box above it, so the answer is exact.
class BoxLocator
{
public:
  BoxLocator() = default;
  /// @param boxes  interiors disjoint, union = domain, sides equal where they touch.
  /// @param shape  rough number of boxes along each direction; decides on the grid's proportions.
  BoxLocator(const ParametricBox<2>& domain, const std::vector<ParametricBox<2>>& boxes,
    const std::array<std::size_t, 2>& shape);

  /// Box of a point of the domain; points outside go to a box of the boundary. @pre no NaN.
  int Find(double u, double v) const
  {
    int node = this->Buckets[Bucket(1, v) * this->Size[0] + Bucket(0, u)];
    while (node < 0)
    {
      const Cut& cut = this->Cuts[static_cast<std::size_t>(-1 - node)];
      node = (cut.Direction == 0 ? u : v) < cut.Value ? cut.Below : cut.Above;
    }
    return node;
  }

private:
  /// Nodes are a box (>= 0) or -1 - index of a cut.
  struct Cut
  {
    double Value = 0.0;
    int Direction = 0;
    int Below = 0;
    int Above = 0;
  };
  class Divider;
  std::size_t Bucket(std::size_t d, double x) const
  {
    const double position = (x - this->Begin[d]) * this->Scale[d];
    return position > 0.0
      ? static_cast<std::size_t>(position < this->Last[d] ? position : this->Last[d])
      : 0;
  }
  std::array<std::size_t, 2> Size{};
  RealArray<2> Begin{};
  RealArray<2> Scale{};
  RealArray<2> Last{}; // Size - 1
  std::vector<int> Buckets;
  std::vector<Cut> Cuts;
};
}
