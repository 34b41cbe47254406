// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "NumberColumns.h"

#include <array>

namespace knotwork
{
/// No column of a text: the coordinate is 0.
constexpr std::size_t NoColumn = ~std::size_t{ 0 };

/// Columns of a text of points, and which of them are x, y, z.
struct PointLayout : NumberColumns
{
  std::array<std::size_t, 3> Position{ 0, 1, 2 };

  /// The other columns. @param names  get theirs, as channels.
  std::vector<std::size_t> Others(std::vector<std::string>& names) const;
};

/// Finds the columns of points. @return failures of FindColumns, EmptyInput without a line.
Result<PointLayout> FindPointLayout(std::string_view text);
}
