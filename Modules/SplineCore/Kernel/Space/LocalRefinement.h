// SPDX-License-Identifier: BSD-3-Clause
// What families that refine locally have in common, private to the kernel.
#pragma once
#include "SplineSpace.h"

#include <cmath>

namespace knotwork
{
inline constexpr const char* NoElevation =
  "the degree of a locally refined or hierarchical spline cannot be raised; raise it before local "
  "refinement";

/// About the functions after all elements are halved: one a new element.
template <int Dim>
double FunctionsOfHalvedElements(const SplineSpace<Dim>& space, int refinements)
{
  const double pieces = std::ldexp(1.0, refinements); // of an element in a direction
  return space.NumFunctions + space.NumElements() * (std::pow(pieces, Dim) - 1.0);
}
}
