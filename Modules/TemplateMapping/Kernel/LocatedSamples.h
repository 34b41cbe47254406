// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Points of the domain, element by element.
template <int Dim>
struct LocatedSamples
{
  /// Points Order[First] ... Order[Last - 1] lie on the element, in ascending order.
  struct Group
  {
    int Element = 0;
    std::size_t First = 0;
    std::size_t Last = 0;
  };
  std::vector<Group> Groups; ///< ascending elements
  std::vector<Eigen::Index> Order;
  PointMatrix Local; ///< of the points, in their own order
};

/// @return OutsideDomain, naming the first point outside.
template <int Dim>
Result<LocatedSamples<Dim>> LocateSamples(
  const SplineSpace<Dim>& space, const PointMatrix& parameters);
}
