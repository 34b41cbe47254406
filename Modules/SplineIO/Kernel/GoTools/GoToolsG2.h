// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/PointFile.h>
#include <knotwork/SplineIO/SplineFile.h>

#include <string_view>

namespace knotwork
{
/// Reads all splines of a GoTools g2 text: SplineCurve (100), SplineSurface (200), LRSplineSurface
/// (293), SplineVolume (700), polynomial and rational, and surfaces that are bounded by spline
/// curves (210); point clouds (400) are left out with a
/// warning. Rational rows are homogeneous, (w x, w y, w
/// z, w); the quotient is taken in extended precision, so that what WriteG2 wrote comes back bit
/// for bit.
/// @param text  words separated by white space; read independently of the locale.
/// @return InvalidFormat with line and word for text that does not follow the format;
/// InvalidDegree, InvalidKnots, InvalidWeight, NonFiniteInput for what it says, InvalidTopology for
/// LR functions that do not fit their mesh (MakeLRSpace); EmptyInput without an object.
/// @complexity time and memory O(size of the text), whatever counts the text claims.
Result<SplineFile> ReadG2(std::string_view text);

/// Reads all point clouds (400) of a g2 text, one group each; splines are left out with a warning.
/// @return as ReadG2; EmptyInput without a point.
Result<PointFile> ReadG2Points(std::string_view text);

/// Whether the first object of a text is a point cloud.
bool BeginsWithG2Points(std::string_view beginning);

/// Writes points as point clouds, one a group: ReadG2Points gives the same bits again. Channels
/// are not written: the format has none.
/// @return EmptyInput without a point; SizeMismatch for groups that do not follow each other;
/// NonFiniteInput naming point and coordinate.
Result<std::string> WriteG2Points(const PointFile& file);

/// Whether a text's beginning is a header of one of GoTools' classes.
bool LooksLikeG2(std::string_view beginning);

/// Writes splines with any number of components. Numbers have the fewest digits that give the same
/// double again: ReadG2(WriteG2(f)) has the splines of f bit for bit, and a second writing gives
/// the same text. Where long double is not longer than double, coordinates of rational splines may
/// differ by one unit in the last place, once.
/// @return InvalidParameter for a spline that is not of tensor-product or locally refined kind (or
/// a hierarchy without refined cells): the format has no other; Spline::Check's codes.
Result<std::string> WriteG2(const std::vector<AnySpline>& splines);

/// The same for splines of which some are bounded (DimensionMismatch: one that is no surface).
Result<std::string> WriteG2File(const SplineFile& file);
}
