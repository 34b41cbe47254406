// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ContourCells.h"

/// Private to TraceContours: paths of elements joined to components.
namespace knotwork
{
/// A path with what is known of its element.
struct LinkedPath
{
  ContourPath Path;
  const RealArray<2>* Points = nullptr; ///< of the path, local parameters
  double Merge = 0.0;                   ///< points nearer than that (local parameters) are one
  double MaxError = 0.0;                ///< of |value - level|
};

/// Appends components, points and counts of all levels. Paths join where one ends at the root at
/// which another one begins.
/// @param paths     in an order that does not depend on threads; the order of components.
/// @param numRoots  roots are numbered from 0.
/// @param seams     a root: 1, where the parameters jump.
void LinkContours(const SplineSpace<2>& space, const std::vector<LinkedPath>& paths,
  std::size_t numRoots, const std::vector<std::uint8_t>& seams, ContourSet& contours);
}
