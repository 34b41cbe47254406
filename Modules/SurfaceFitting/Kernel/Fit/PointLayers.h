// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
struct LayeredPlaces
{
  double Share = 0.0;      ///< of the places that were looked at
  Eigen::Index Point = -1; ///< at the first of them
};

/// Places at which points lie in layers over their parameters, as those of closed objects do over a
/// plane: two or more heights for neighbours in any mixture, so that no surface over the parameters
/// follows them.
///
/// Points are halved along the longer side of their parameters' box until some 12 to 24 are left.
/// There they lie in layers when two to four groups of heights leave next to nothing of the
/// variance, as those of noise, slopes and single outliers do not, and no quadratic polynomial of
/// the parameters tells the groups apart, as it does at a step. Heights are those along the longest
/// direction of what is left of a plane. Heights may be rounded, to three different ones or more:
/// groups that are one step apart are none.
/// @param parameters  n x 2. @param values  n x c, c >= 1. Both finite, else there are none.
/// @complexity O(n log m), m = min(n / 16, 2048): of more places a random sample (fixed seed).
LayeredPlaces FindLayers(const PointMatrix& parameters, const PointMatrix& values);

/// @param over  what the parameters are, for the message.
/// @param isNumbered  whether the rows are points that the reader of the message can count.
/// @return NotInSpace: points lie in layers at more than 15 % of the places; names a point.
Status CheckLayers(const PointMatrix& parameters, const PointMatrix& values, const char* over,
  bool isNumbered = true);
}
