// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SplineFile.h"

#include <string_view>

namespace knotwork
{
/// Reads all objects of a GoTools g2 text: SplineCurve (100), SplineSurface (200), LRSplineSurface
/// (293), SplineVolume (700), polynomial and rational. Rational rows are homogeneous, (w x, w y, w
/// z, w); the quotient is taken in extended precision, so that what WriteG2 wrote comes back bit
/// for bit.
/// @param text  words separated by white space; read independently of the locale.
/// @return InvalidFormat with line and word for text that does not follow the format;
/// InvalidDegree, InvalidKnots, InvalidWeight, NonFiniteInput for what it says, InvalidTopology for
/// LR functions that do not fit their mesh (MakeLRSpace); EmptyInput without an object.
/// @complexity time and memory O(size of the text), whatever counts the text claims.
Result<SplineFile> ReadG2(std::string_view text);

/// Whether a text's beginning is a header of one of GoTools' classes.
bool LooksLikeG2(std::string_view beginning);

/// Writes splines with any number of components. Numbers have the fewest digits that give the same
/// double again: ReadG2(WriteG2(f)) has the splines of f bit for bit, and a second writing gives
/// the same text. Where long double is not longer than double, coordinates of rational splines may
/// differ by one unit in the last place, once.
/// @return InvalidParameter for a spline that is not of tensor-product or locally refined kind (or
/// a hierarchy without refined cells): the format has no other; Spline::Check's codes.
Result<std::string> WriteG2(const std::vector<AnySpline>& splines);
}
