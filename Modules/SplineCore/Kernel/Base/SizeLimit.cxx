// SPDX-License-Identifier: BSD-3-Clause
#include "SizeLimit.h"

#include "Numbers.h"

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
  const double pieces = std::ldexp(1.0, refinements); // of an element in a direction
  double functions = 0.0;
  if (space.Kind == SpaceKind::Tensor)
  {
    functions = 1.0;
    for (const KnotVector& knots : space.Knots)
    {
      functions *= knots.NumFunctions() + (elevation + pieces - 1.0) * knots.NumElements();
    }
    return functions;
  }
  if (space.Kind != SpaceKind::Bezier)
  {
    return space.NumFunctions + space.NumElements() * (std::pow(pieces, Dim) - 1.0);
  }
  for (const auto& element : space.Elements)
  {
    double inside = 1.0;
    for (const int degree : element.Degree)
    {
      inside *= (degree + elevation) * pieces;
    }
    functions += inside;
  }
  return functions;
}

template double FunctionsAfterRefinement<1>(const SplineSpace<1>&, int, int);
template double FunctionsAfterRefinement<2>(const SplineSpace<2>&, int, int);
template double FunctionsAfterRefinement<3>(const SplineSpace<3>&, int, int);
}
