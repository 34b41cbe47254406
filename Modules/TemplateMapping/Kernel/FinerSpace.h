// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>

namespace knotwork
{
/// The space with smaller cells around points: a point in a cell of level l asks for cells of level
/// l + 1, its own and so many more on every side; what is refined then is whole cells of level l.
/// @param points    n x Dim, inside the domain. @param extension  >= 0, in cells of the new level.
/// @param maxLevel  points in cells of this level are skipped.
/// @return the same space when nothing is to do; failures of RefineBoxes.
/// @source  Kiss, Giannelli, Zore, Juettler, Grossmann, Barner, Graph. Models 76 (2014) 273-288.
template <int Dim>
Result<SplineSpacePtr<Dim>> RefineAround(
  const SplineSpacePtr<Dim>& space, const PointMatrix& points, int extension, int maxLevel);

/// The space with these elements halved in every direction, and so many cells of the new level
/// around each of them; elements of level maxLevel are left.
template <int Dim>
Result<SplineSpacePtr<Dim>> RefineHeld(
  const SplineSpacePtr<Dim>& space, const std::vector<int>& elements, int extension, int maxLevel);

/// The space with every cell halved in every direction.
template <int Dim>
Result<SplineSpacePtr<Dim>> RefineEverywhere(const SplineSpacePtr<Dim>& space, int maxLevel);
}
