// SPDX-License-Identifier: BSD-3-Clause
#include "ReferenceSystem.h"

#include <knotwork/SplineGrid/NamedArray.h>

#include "vtkAlgorithm.h"
#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkStringArray.h"

#include <functional>

namespace knotwork
{
namespace
{
constexpr const char* Name = "CoordinateReferenceSystem";

/// Keys are part of a filter's information, so that a property of filters need not be in the header
/// of all of them.
vtkInformationIntegerKey* KeepsKey()
{
  static vtkInformationIntegerKey* const key =
    vtkInformationIntegerKey::MakeKey("KEEPS_REFERENCE_SYSTEM", "knotwork");
  return key;
}

void ForEachBlock(vtkDataObject* data, const std::function<void(vtkDataObject*)>& act)
{
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data);
  if (!collection)
  {
    act(data);
    return;
  }
  for (unsigned block = 0; block < collection->GetNumberOfPartitionedDataSets(); ++block)
  {
    for (unsigned part = 0; part < collection->GetNumberOfPartitions(block); ++part)
    {
      if (vtkDataSet* grid = collection->GetPartition(block, part))
      {
        act(grid);
      }
    }
  }
}
}

std::string ReferenceSystemOf(vtkDataObject* data)
{
  std::string found;
  if (data)
  {
    ForEachBlock(data,
      [&found](vtkDataObject* one)
      {
        auto* array = vtkStringArray::SafeDownCast(one->GetFieldData()->GetAbstractArray(Name));
        if (found.empty() && array && array->GetNumberOfValues() > 0)
        {
          found = array->GetValue(0);
        }
      });
  }
  return found;
}

void SetReferenceSystem(vtkDataObject* data, const std::string& text)
{
  ForEachBlock(data,
    [&text](vtkDataObject* one)
    {
      one->GetFieldData()->RemoveArray(Name);
      if (!text.empty())
      {
        const auto array = NamedArray<vtkStringArray>(Name);
        array->InsertNextValue(text);
        one->GetFieldData()->AddArray(array);
      }
    });
}

void KeepReferenceSystem(vtkAlgorithm* filter)
{
  filter->GetInformation()->Set(KeepsKey(), 1);
}

bool KeepsReferenceSystem(vtkAlgorithm* filter)
{
  return filter->GetInformation()->Has(KeepsKey()) != 0;
}
}
