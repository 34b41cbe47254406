// SPDX-License-Identifier: BSD-3-Clause
#include "SizeLimit.h"

#include "Numbers.h"
#include "SpaceFamily.h"

#include <cmath>

namespace knotwork
{
Status CheckSize(double count, double limit, const char* what, const char* property)
{
  if (count <= limit)
  {
    return {};
  }
  return { ErrorCode::TooLarge,
    "the result would have " + Digits(std::round(count)) + " " + what + ", the limit is " +
      Digits(limit) + "; ask for less (fewer elements, a larger tolerance), or raise " + property +
      " if the memory suffices" };
}

template <int Dim>
double FunctionsAfterRefinement(const SplineSpace<Dim>& space, int elevation, int refinements)
{
  return FamilyOf(space).FunctionsAfterRefinement(space, elevation, refinements);
}

template double FunctionsAfterRefinement<1>(const SplineSpace<1>&, int, int);
template double FunctionsAfterRefinement<2>(const SplineSpace<2>&, int, int);
template double FunctionsAfterRefinement<3>(const SplineSpace<3>&, int, int);
}
