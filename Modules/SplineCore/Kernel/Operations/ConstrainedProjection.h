// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Spline.h>

namespace knotwork
{
/// Bezier projection of a spline onto the splines of its space that have given coefficients in some
/// functions: on every element the polynomials nearest in L2 with these coefficients, then weighted
/// averages over the elements as ProjectOntoSpace takes them. What is given to a side of patches
/// goes on inside, where it is nearest to what was there, instead of in the functions of the side
/// alone.
/// @param coefficients  functions x c, of the spline, polynomial. @param functions  each once, at
/// least one. @param values  as many rows x c.
/// @return  functions x c: the given values, what elements without any of the functions have alone
/// as it was. InvalidParameter for a function that is not there; SizeMismatch.
/// @post  values that the spline has change nothing.
/// @complexity O(elements (p + 1)^Dim), and O((p + 1)^(3 Dim)) for every kind of element.
/// @source  Thomas, Scott, Evans, Tew, Evans, CMAME 284 (2015) 55-105, section 4, with the local
/// projection replaced by one with constraints.
template <int Dim>
Result<PointMatrix> ConstrainCoefficients(const SplineSpace<Dim>& space,
  const PointMatrix& coefficients, const std::vector<int>& functions, const PointMatrix& values);
}
