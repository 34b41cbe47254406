// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/SplineFile.h>

#include <string_view>

namespace knotwork
{
/// Reads the geometries and multi-patches of a G+Smo XML text: BSpline, Nurbs, TensorBSpline,
/// TensorNurbs, THBSpline, RationalTHBSpline with one to three parameters. Other elements and
/// geometries of other types are left out, the latter with a warning.
///
/// Coefficients of THB-splines are ordered as G+Smo orders them and as SplineSpace does: level by
/// level, within a level the active functions lexicographically, first parameter fastest. Boxes of
/// level l count the elements of level l; a cell has the highest level of the boxes that cover it.
/// @param text  UTF-8. Numbers are read independently of the locale.
/// @return InvalidFormat with line and element for text that is not such XML; the kernel's codes
/// (InvalidDegree, InvalidKnots, InvalidWeight, NonFiniteInput, ...) for what it says;
/// InvalidTopology for boxes that no hierarchy of whole cells has; EmptyInput without a geometry;
/// TooLarge for boxes with far more cells than the text has coefficients.
/// @complexity time and memory O(size of the text).
Result<SplineFile> ReadGismoXml(std::string_view text);

/// Whether the first element of a text's beginning is `xml`: .xml is the ending of many formats.
bool LooksLikeGismoXml(std::string_view beginning);

/// Writes splines with any number of components as G+Smo XML. Numbers have the fewest digits that
/// give the same double again: ReadGismoXml(WriteGismoXml(f)) is f bit for bit, and a second
/// writing gives the same text.
/// @return InvalidParameter for a spline of kind Bezier (the format needs knots); InvalidTopology
/// for ids that are not distinct or a multi-patch that refers to what is not there; Spline::Check's
/// codes.
Result<std::string> WriteGismoXml(const SplineFile& file);
}
