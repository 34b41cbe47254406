// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

namespace knotwork
{
/// Share of places at which points lie in layers over their parameters, as those of closed objects
/// do over a plane: two or more heights for neighbours in any mixture, so that no surface over the
/// parameters follows them.
///
/// Points are halved along the longer side of their parameters' box until some 12 to 24 are left.
/// There they lie in layers when two to four groups of heights leave next to nothing of the
/// variance, as those of noise, slopes and single outliers do not, and no quadratic polynomial of
/// the parameters tells the groups apart, as it does at a step. Heights are those along the longest
/// direction of what is left of a plane. Steps of rounded heights are no layers.
/// @param parameters  n x 2. @param values  n x c, c >= 1. Both finite, else 0 is the answer.
/// @complexity O(m log m) with m = min(n, 32768): more points are a random sample (fixed seed).
double LayeredShare(const PointMatrix& parameters, const PointMatrix& values);

/// @param over  what the parameters are, for the message.
/// @return NotInSpace: points lie in layers at more than a seventh of the places.
Status CheckLayers(const PointMatrix& parameters, const PointMatrix& values, const char* over);
}
