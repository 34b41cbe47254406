// SPDX-License-Identifier: BSD-3-Clause
#include "FieldTables.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkTypeInt64Array.h"

#include <algorithm>

namespace knotwork
{
namespace
{
template <typename T>
void CopyIntegers(const T* from, std::vector<std::int64_t>& to)
{
  for (std::int64_t& value : to)
  {
    value = static_cast<std::int64_t>(*from++);
  }
}
}

bool ReadIntegers(vtkFieldData* fieldData, const char* arrayName, int columns, IntegerTable& table)
{
  vtkDataArray* array = fieldData->GetArray(arrayName);
  if (!array || array->GetNumberOfComponents() != columns || array->GetDataType() == VTK_FLOAT ||
    array->GetDataType() == VTK_DOUBLE)
  {
    return false;
  }
  table.Columns = columns;
  table.Values.resize(static_cast<std::size_t>(array->GetNumberOfValues()));
  switch (array->GetDataType())
  {
    vtkTemplateMacro(
      CopyIntegers(static_cast<const VTK_TT*>(array->GetVoidPointer(0)), table.Values));
    default:
      return false;
  }
  return true;
}

bool ReadDoubles(vtkFieldData* fieldData, const char* arrayName, PointMatrix& rows)
{
  vtkDataArray* array = fieldData->GetArray(arrayName);
  if (!array || array->GetDataType() != VTK_DOUBLE)
  {
    return false;
  }
  rows.resize(array->GetNumberOfTuples(), array->GetNumberOfComponents());
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    array->GetTuple(i, rows.row(i).data());
  }
  return true;
}

void WriteIntegers(vtkFieldData* fieldData, const std::string& arrayName, int columns,
  const std::vector<std::int64_t>& values, const char* const* names)
{
  vtkNew<vtkTypeInt64Array> array;
  array->SetName(arrayName.c_str());
  array->SetNumberOfComponents(columns);
  for (int c = 0; names && c < columns; ++c)
  {
    array->SetComponentName(c, names[c]);
  }
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / columns);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  fieldData->AddArray(array);
}

void WriteDoubles(vtkFieldData* fieldData, const std::string& arrayName, int columns,
  const std::vector<double>& values)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(arrayName.c_str());
  array->SetNumberOfComponents(columns);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / columns);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  fieldData->AddArray(array);
}
}
