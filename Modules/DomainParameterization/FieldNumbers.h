// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

/// Private to the filter: field data of one value.
namespace knotwork
{
inline void AddText(vtkUnstructuredGrid* grid, const char* name, const char* text)
{
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(text);
  grid->GetFieldData()->AddArray(array);
}

inline void AddNumber(vtkUnstructuredGrid* grid, const char* name, double value)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  grid->GetFieldData()->AddArray(array);
}
}
