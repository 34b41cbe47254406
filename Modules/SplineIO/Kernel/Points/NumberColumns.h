// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>

#include <string>
#include <string_view>
#include <vector>

/// Private to the readers of text in columns.
namespace knotwork
{
/// Columns of numbers, as the first line that is no comment tells them.
struct NumberColumns
{
  std::size_t Begin = 0;       ///< of the first line of numbers
  std::size_t HeadLine = 1;    ///< number of the line that tells the columns
  std::size_t LinesBefore = 0; ///< of the file, where the text is a part of it
  char Separator = ' ';        ///< blanks, ',' or ';'
  std::size_t Count = 0;
  std::vector<std::string> Names; ///< of all columns; empty: without names
  std::string_view Comment;       ///< the one directly above the first line
  std::vector<bool> IsFinite;     ///< columns whose numbers may not be nan or inf; empty: none

  bool MustBeFinite(std::size_t column) const
  {
    return column < this->IsFinite.size() && this->IsFinite[column];
  }
};

/// Finds the columns: separated by white space, by commas or by semicolons, named when the first
/// words of the first line (three of them, or all) are no numbers and do not begin like one. Empty
/// lines and those that begin with '#', '%' or '//' are left out.
/// @return EmptyInput without a line; InvalidFormat naming it when it has fewer columns than least.
/// @param meaning  of the columns, for that message.
Result<NumberColumns> FindColumns(
  std::string_view text, std::size_t least, const std::string& meaning);

/// Words of a line, trimmed; one separator at the end is no word.
std::vector<std::string_view> FieldsOf(std::string_view line, char separator);

/// In lower case (ASCII).
std::string LowerName(std::string word);

/// Numbers of all lines, one row after the other, in chunks of whole rows that are read in
/// parallel.
/// @return InvalidFormat or NonFiniteInput with line, column and word.
Result<std::vector<std::vector<double>>> ReadColumns(
  std::string_view text, const NumberColumns& columns, int threads);
}
