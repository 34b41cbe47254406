// SPDX-License-Identifier: BSD-3-Clause
#include "CoincidentPoints.h"

#include "SideSplines.h"

#include <algorithm>

namespace knotwork
{
namespace
{
/// Of the largest coordinate: some hundred roundings, which refinements add up.
constexpr double CoincidentRounding = 0x1p-46;

/// The net of the map, of which the boundary's control points are known.
template <int Dim>
struct Net
{
  using Index = std::array<int, Dim>;
  Index Counts{};

  Eigen::Index Size() const
  {
    Eigen::Index size = 1;
    for (int count : this->Counts)
    {
      size *= count;
    }
    return size;
  }
  Index At(Eigen::Index number) const
  {
    Index at{};
    for (std::size_t d = 0; d < Dim; ++d)
    {
      at[d] = static_cast<int>(number % this->Counts[d]);
      number /= this->Counts[d];
    }
    return at;
  }
  Eigen::Index Number(const Index& at) const
  {
    Eigen::Index number = 0;
    for (std::size_t d = Dim; d-- > 0;)
    {
      number = number * this->Counts[d] + at[d];
    }
    return number;
  }
  /// Bit 2 d + e: the point is on the side where direction d ends with e.
  unsigned Sides(const Index& at) const
  {
    unsigned sides = 0;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      sides |= (at[d] == 0 ? 1u : 0u) << 2 * d;
      sides |= (at[d] == this->Counts[d] - 1 ? 1u : 0u) << (2 * d + 1);
    }
    return sides;
  }
  /// Number of a side's control point in the net.
  Eigen::Index OnSide(int side, Eigen::Index point) const
  {
    Index at{};
    const std::size_t across = static_cast<std::size_t>(side / 2);
    at[across] = side % 2 ? this->Counts[across] - 1 : 0;
    for (const std::size_t d : SideDirections<Dim>(side))
    {
      at[d] = static_cast<int>(point % this->Counts[d]);
      point /= this->Counts[d];
    }
    return this->Number(at);
  }
};
}

template <int Dim>
double JoinCoincidentPoints(CompatibleBoundary<Dim>& boundary, double tolerance)
{
  Net<Dim> net;
  for (std::size_t d = 0; d < Dim; ++d)
  {
    net.Counts[d] = boundary.Knots[d].NumFunctions();
  }
  PointMatrix points(net.Size(), Dim);
  double coordinate = 0.0;
  for (int s = 0; s < 2 * Dim; ++s)
  {
    const PointMatrix& own = boundary.Sides[static_cast<std::size_t>(s)].ControlPoints;
    coordinate = std::max(coordinate, own.cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < own.rows(); ++i)
    {
      points.row(net.OnSide(s, i)) = own.row(i);
    }
  }
  tolerance = std::min(tolerance, CoincidentRounding * coordinate);

  // corners first, then edges, then what is inside of sides: each joins a neighbour before it
  std::vector<Eigen::Index> joined(static_cast<std::size_t>(points.rows()), -1);
  double moved = 0.0;
  for (int most = Dim; most > 0; --most)
  {
    for (Eigen::Index i = 0; i < points.rows(); ++i)
    {
      const auto at = net.At(i);
      const unsigned sides = net.Sides(at);
      // a direction of one function would be on both of its sides: degrees are 1 or more
      if (__builtin_popcount(sides) != most)
      {
        continue;
      }
      joined[static_cast<std::size_t>(i)] = i;
      for (std::size_t d = 0; d < Dim; ++d)
      {
        for (int step : { -1, 1 })
        {
          auto other = at;
          other[d] += step;
          if (other[d] < 0 || other[d] >= net.Counts[d] || (net.Sides(other) & sides) == 0)
          {
            continue; // outside, or across the inside
          }
          const Eigen::Index to = joined[static_cast<std::size_t>(net.Number(other))];
          if (to < 0)
          {
            continue;
          }
          const double distance = (points.row(i) - points.row(to)).norm();
          if (distance <= tolerance)
          {
            joined[static_cast<std::size_t>(i)] = to;
            moved = std::max(moved, distance);
          }
        }
      }
    }
  }
  for (int s = 0; s < 2 * Dim; ++s)
  {
    PointMatrix& own = boundary.Sides[static_cast<std::size_t>(s)].ControlPoints;
    for (Eigen::Index i = 0; i < own.rows(); ++i)
    {
      own.row(i) = points.row(joined[static_cast<std::size_t>(net.OnSide(s, i))]);
    }
  }
  return moved;
}

template double JoinCoincidentPoints<2>(CompatibleBoundary<2>&, double);
template double JoinCoincidentPoints<3>(CompatibleBoundary<3>&, double);
}
