// SPDX-License-Identifier: BSD-3-Clause
#include "DataCheck.h"

#include <knotwork/SplineGrid/InputChecks.h>

#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkPointSet.h>
#include <vtkSmartPointer.h>

#include <cmath>

namespace knotwork
{
namespace
{
Status CheckPart(vtkPointSet* data)
{
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
  {
    double point[3];
    data->GetPoint(i, point);
    for (int c = 0; c < 3; ++c)
    {
      if (!std::isfinite(point[c]))
      {
        return { ErrorCode::NonFiniteInput,
          "point " + std::to_string(i) + " has a coordinate " + "xyz"[c] +
            " that is not finite (NaN or infinity); correct or remove it" };
      }
    }
  }
  return CheckCellSizes(data);
}
}

Status CheckData(vtkDataObject* data)
{
  if (auto* points = vtkPointSet::SafeDownCast(data))
  {
    return CheckPart(points);
  }
  auto* collection = vtkCompositeDataSet::SafeDownCast(data);
  if (!collection)
  {
    return {};
  }
  auto part = vtkSmartPointer<vtkCompositeDataIterator>::Take(collection->NewIterator());
  int number = 0;
  for (part->InitTraversal(); !part->IsDoneWithTraversal(); part->GoToNextItem(), ++number)
  {
    auto* points = vtkPointSet::SafeDownCast(part->GetCurrentDataObject());
    if (const Status status = points ? CheckPart(points) : Status(); !status)
    {
      return { status.Code, "part " + std::to_string(number) + ", " + status.Detail };
    }
  }
  return {};
}
}
