// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/SplineFile.h>

#include <string_view>

namespace knotwork
{
/// Reads a file of Bezier extraction operators: text (titles B E X T 2.0, B E X T 2.1 and BASIS
/// TRANSFORM 2.1) or JSON, told apart by the first character. Its elements become one spline of
/// kind Explicit, its functions numbered as the control points of the file, in three coordinates,
/// rational when the file says so. Every operator is checked (MakeExplicitSpace).
/// @return InvalidFormat with line, or key and element, for what does not follow the format;
/// NonFiniteInput, InvalidDegree, InvalidWeight, InvalidTopology, SizeMismatch, NotInSpace for what
/// it says; messages count elements, control points and vectors as the file does: from 1, in JSON
/// from 0. EmptyInput without an element.
/// @complexity that of MakeExplicitSpace; memory O(size of the text), whatever counts it claims
Result<SplineFile> ReadBext(std::string_view text);

/// Whether a text may begin like this, and whether a JSON text does.
bool LooksLikeBext(std::string_view beginning);
bool LooksLikeBextJson(std::string_view beginning);

/// Writes splines of any kind by their extraction operators, as text: ReadBext gives the numbers
/// again bit for bit. Control points, elements and vectors follow each other spline by spline.
/// @return EmptyInput without a spline; DimensionMismatch for splines of several parametric
/// dimensions or more than three coordinates; TooLarge for numbers of more than 8 digits;
/// Spline::Check's codes.
Result<std::string> WriteBext(const SplineFile& file);

/// The same as JSON, which has no limit of digits.
Result<std::string> WriteBextJson(const SplineFile& file);
}
