// SPDX-License-Identifier: BSD-3-Clause
#include "NumberTable.h"

#include "NumberColumns.h"

#include <algorithm>

namespace knotwork
{
Result<NumberTable> ReadNumberTable(std::string_view text, int threads)
{
  auto columns = FindColumns(text, 1, "one number a column");
  if (!columns)
  {
    return columns.Status;
  }
  if (columns->Names.empty())
  {
    return { ErrorCode::InvalidFormat,
      "line " + std::to_string(columns->HeadLine) +
        " does not name the columns; put a line with their names above the numbers" };
  }
  auto chunks = ReadColumns(text, columns.Value, threads);
  if (!chunks)
  {
    return chunks.Status;
  }
  const auto width = static_cast<Eigen::Index>(columns->Count);
  Eigen::Index size = 0;
  for (const std::vector<double>& numbers : chunks.Value)
  {
    size += static_cast<Eigen::Index>(numbers.size());
  }
  if (size == 0)
  {
    return { ErrorCode::EmptyInput, "the table has names of columns and no row" };
  }
  NumberTable table;
  table.Names = std::move(columns->Names);
  table.Numbers.resize(size / width, width);
  double* to = table.Numbers.data(); // rows one after the other
  for (const std::vector<double>& numbers : chunks.Value)
  {
    to = std::copy(numbers.begin(), numbers.end(), to);
  }
  return table;
}
}
