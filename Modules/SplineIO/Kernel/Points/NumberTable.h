// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <string>
#include <string_view>
#include <vector>

namespace knotwork
{
/// Columns with names.
struct NumberTable
{
  std::vector<std::string> Names;
  PointMatrix Numbers; ///< rows x columns
};

/// Reads a table as text: a line that names the columns, then a row a line, all numbers, separated
/// by white space, by commas or by semicolons as in the first line. Empty lines and those that
/// begin with '#', '%' or '//' are left out.
/// @param text  read independently of the locale; numbers are rounded to the nearest double.
/// @param threads  0: all cores; the result does not depend on it.
/// @return EmptyInput without a line or a row; InvalidFormat when the first line names no columns,
/// and with line, column and word for what is no number.
/// @complexity time and memory O(size of the text).
Result<NumberTable> ReadNumberTable(std::string_view text, int threads = 0);
}
