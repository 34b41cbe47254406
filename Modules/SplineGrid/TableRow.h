// SPDX-License-Identifier: BSD-3-Clause
// Tables of one row, as filters give their numbers.
#pragma once
#include <knotwork/SplineGrid/NamedArray.h>

#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <array>
#include <string>

namespace knotwork
{
template <typename Array, typename Value>
void AddToRow(vtkTable* table, const char* name, const Value& value)
{
  const auto column = NamedArray<Array>(name);
  column->InsertNextValue(value);
  table->AddColumn(column);
}

inline void AddColumn(vtkTable* table, const char* name, double value)
{
  AddToRow<vtkDoubleArray>(table, name, value);
}

inline void AddColumn(vtkTable* table, const char* name, int value)
{
  AddToRow<vtkIntArray>(table, name, value);
}

inline void AddColumn(vtkTable* table, const char* name, const std::string& value)
{
  AddToRow<vtkStringArray>(table, name, value);
}

/// A column of several components.
template <std::size_t N>
void AddTuple(vtkTable* table, const char* name, const std::array<double, N>& values)
{
  const auto column = NamedArray<vtkDoubleArray>(name, static_cast<int>(N), 1);
  column->SetTuple(0, values.data());
  table->AddColumn(column);
}
}
