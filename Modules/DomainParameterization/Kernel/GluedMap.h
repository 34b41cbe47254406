// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Patches, each on [0, 1]^Dim, that share control points where they meet. Control point i of patch
/// p is number Functions[p][i] of them all; shared ones are the same bits (and weights) in every
/// patch.
template <int Dim>
struct GluedMap
{
  std::vector<Spline<Dim>> Patches; ///< rational all or none
  std::vector<std::vector<int>> Functions;
  std::vector<bool> Fixed; ///< one a number: never moved

  int NumFunctions() const { return static_cast<int>(this->Fixed.size()); }
  int NumElements() const
  {
    int n = 0;
    for (const Spline<Dim>& patch : this->Patches)
    {
      n += patch.Space->NumElements();
    }
    return n;
  }
  bool IsRational() const { return this->Patches.front().IsRational(); }
};

/// One patch; fixed are the functions that its boundary needs (tensor-product and hierarchical
/// spaces).
template <int Dim>
GluedMap<Dim> SingleMap(const Spline<Dim>& map);

/// Control points of all patches by their numbers, NumFunctions x Dim.
template <int Dim>
PointMatrix GluedPoints(const GluedMap<Dim>& map);
}
