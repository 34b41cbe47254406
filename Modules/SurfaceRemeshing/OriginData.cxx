// SPDX-License-Identifier: BSD-3-Clause
#include "OriginData.h"

#include <knotwork/SplineGrid/NamedArray.h>

#include "vtkDataSetAttributes.h"
#include "vtkIdTypeArray.h"

namespace knotwork
{
void CopyOriginData(vtkDataSetAttributes* from, const std::vector<int>& ids, const char* name,
  vtkDataSetAttributes* to)
{
  to->CopyAllOn();
  to->CopyGlobalIdsOff();
  to->CopyAllocate(from, static_cast<vtkIdType>(ids.size()));
  const auto origins = NamedArray<vtkIdTypeArray>(name);
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    if (ids[i] >= 0)
    {
      to->CopyData(from, ids[i], static_cast<vtkIdType>(i));
    }
    else
    {
      to->NullData(static_cast<vtkIdType>(i));
    }
    origins->InsertNextValue(ids[i]);
  }
  to->AddArray(origins);
}
}
