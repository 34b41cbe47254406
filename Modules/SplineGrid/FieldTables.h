// SPDX-License-Identifier: BSD-3-Clause
// Tables of numbers in the field data of a grid.
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <cstdint>
#include <string>
#include <vector>

class vtkFieldData;

namespace knotwork
{
/// An array of whole numbers of any integer type (readers choose their own), row by row.
struct IntegerTable
{
  int Columns = 0;
  std::vector<std::int64_t> Values;
  std::size_t Rows() const
  {
    return this->Columns == 0 ? 0 : this->Values.size() / static_cast<std::size_t>(this->Columns);
  }
  std::int64_t At(std::size_t row, int column) const
  {
    return this
      ->Values[row * static_cast<std::size_t>(this->Columns) + static_cast<std::size_t>(column)];
  }
};

/// @return false when there is no such array of integers with so many columns.
bool ReadIntegers(vtkFieldData* fieldData, const char* arrayName, int columns, IntegerTable& table);
bool ReadDoubles(vtkFieldData* fieldData, const char* arrayName, PointMatrix& rows);
void WriteIntegers(vtkFieldData* fieldData, const std::string& arrayName, int columns,
  const std::vector<std::int64_t>& values, const char* const* names = nullptr);
void WriteDoubles(vtkFieldData* fieldData, const std::string& arrayName, int columns,
  const std::vector<double>& values);
}
