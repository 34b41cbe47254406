// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkSmartPointer.h"
#include "vtkType.h"

namespace knotwork
{
/// An array with a name; its tuples, if any, are not set.
template <typename Array>
vtkSmartPointer<Array> NamedArray(const char* name, int components = 1, vtkIdType tuples = 0)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  return array;
}

/// An array with a name and one value a row, value(row).
template <typename Array, typename Rows, typename Value>
vtkSmartPointer<Array> ArrayOf(const char* name, const Rows& rows, const Value& value)
{
  auto array = NamedArray<Array>(name);
  for (const auto& row : rows)
  {
    array->InsertNextValue(value(row));
  }
  return array;
}
}
