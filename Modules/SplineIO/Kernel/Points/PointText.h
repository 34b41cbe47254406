// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineIO/PointFile.h>

#include <string_view>

namespace knotwork
{
/// Reads points as text, one a line: x y z and further numbers, the channels. Numbers are separated
/// by white space, by commas or by semicolons, as the first line shows. Empty lines and those that
/// begin with '#', '%' or '//' are left out. The first line may name the columns (its first three
/// words are no numbers and do not begin like one): x, y, z are those
/// of that name (also X, Y, Z; Points:0, Points:1, Points:2), else the first three. A comment
/// directly above the first line that begins with x y z and has a word a column names them too.
/// Channels without a name are Column4, Column5, ... Coordinates are finite; channels may be nan or
/// inf, as what has no value at a point is written. Two columns that are named x and y are points
/// of the plane z = 0.
/// @param text  read independently of the locale; numbers are rounded to the nearest double.
/// @param threads  0: all cores; the result does not depend on it.
/// @return EmptyInput without a point; InvalidFormat or, for a coordinate, NonFiniteInput with
/// line, column and word.
/// @complexity time and memory O(size of the text).
Result<PointFile> ReadPointText(std::string_view text, int threads = 0);

/// Whether a text's beginning may be that of points: only printable characters, and a line of three
/// columns or more.
bool LooksLikePointText(std::string_view beginning);

/// Writes points as text that ReadPointText reads again bit for bit (NaN as NaN), with a first line
/// that names the columns when there are channels. Without a point that line is all.
/// @param separator  ' ' or ','; with ',' the names are always written, with ' ' as a comment.
/// @return SizeMismatch; NonFiniteInput naming point and coordinate.
Result<std::string> WritePointText(const PointFile& file, char separator);
}
