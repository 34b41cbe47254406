// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/SplineSpace.h>
#include <knotwork/SplineCore/Status.h>

namespace knotwork
{
/// Functions that a filter makes at most, unless a user allows more.
inline constexpr int DefaultMaxFunctions = 1000000;

/// Refuses what would be larger than a limit, before memory is taken.
/// @param count  that the result would have. @param what  they are: "functions", "polygons".
/// @param property  that sets the limit. @return TooLarge with both numbers and the property.
Status CheckSize(double count, double limit, const char* what = "functions",
  const char* property = "MaximumFunctions");

/// Functions of a space after its degrees are raised and all elements halved in every direction:
/// exact for tensor-product spaces, for others about as many as elements make.
/// @param elevation  degrees added first, >= 0. @param refinements >= 0.
template <int Dim>
double FunctionsAfterRefinement(const SplineSpace<Dim>& space, int elevation, int refinements);
}
