// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/LRRefinement.h>
#include <knotwork/SplineCore/SizeLimit.h>

namespace knotwork
{
/// Operations on splines of kind LocallyRefined. All return DimensionMismatch for other kinds and
/// Spline::Check's codes. Threads: 0 = all cores; results are the same for any number.

/// The same map as a tensor-product spline: every line becomes as long as the domain.
/// @param maxFunctions  @return TooLarge above them and those that the surface has already.
/// @complexity that of the insertions.
Result<Spline<2>> ExpandToTensor(
  const Spline<2>& spline, int threads, int maxFunctions = DefaultMaxFunctions);

/// The map with its parameters exchanged: S'(u, v) = S(v, u).
Result<Spline<2>> SwapParameters(const Spline<2>& spline, int threads);

/// The map with a parameter reversed: t becomes begin + end - t of its domain.
/// @param direction  0 or 1; InvalidParameter otherwise.
Result<Spline<2>> ReverseParameter(const Spline<2>& spline, int direction, int threads);

/// The map over another domain: parameters are scaled and shifted.
/// @return InvalidParameter unless the domain is finite and has an area; InvalidKnots when it is so
/// far from zero for its size that different knots become one.
Result<Spline<2>> MoveDomain(const Spline<2>& spline, const ParametricBox<2>& domain, int threads);

/// The map restricted to a box of its domain, which becomes the domain.
/// @return OutsideDomain unless the box lies in the domain and has an area.
Result<Spline<2>> RestrictToBox(const Spline<2>& spline, const ParametricBox<2>& box, int threads);

/// The curve on which a parameter is constant, over the domain of the other one, with the knots of
/// the lines that it crosses. On a line of full multiplicity it is the limit from above (at the end
/// of the domain from below).
/// @param direction  of the constant parameter. @return InvalidParameter, OutsideDomain.
Result<Spline<1>> IsoCurve(const Spline<2>& spline, int direction, double value, int threads);
}
