// SPDX-License-Identifier: BSD-3-Clause
#include "CellCheck.h"

#include <vtkCellArray.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <string>

namespace knotwork
{
namespace
{
Status CheckArray(vtkCellArray* cells, vtkIdType numPoints)
{
  if (!cells || cells->GetNumberOfCells() == 0)
  {
    return {};
  }
  if (!cells->IsValid())
  {
    return { ErrorCode::InvalidTopology, "the offsets of its cells do not fit their points" };
  }
  vtkDataArray* ids = cells->GetConnectivityArray();
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i)
  {
    const auto id = static_cast<vtkIdType>(ids->GetComponent(i, 0));
    if (id < 0 || id >= numPoints)
    {
      return { ErrorCode::InvalidTopology,
        "a cell has point " + std::to_string(id) + " of " + std::to_string(numPoints) };
    }
  }
  return {};
}

/// Faces of polyhedra: their number, and of each the number of its points and these.
Status CheckFaces(vtkIdTypeArray* faces, vtkIdTypeArray* places, vtkIdType numPoints)
{
  const vtkIdType size = faces ? faces->GetNumberOfValues() : 0;
  for (vtkIdType cell = 0; places && cell < places->GetNumberOfValues(); ++cell)
  {
    vtkIdType at = places->GetValue(cell);
    if (at < 0)
    {
      continue;
    }
    bool good = at < size;
    for (vtkIdType left = good ? faces->GetValue(at++) : 0; left > 0 && good; --left)
    {
      good = at < size && faces->GetValue(at) >= 0 && faces->GetValue(at) < size - at;
      for (vtkIdType end = good ? at + faces->GetValue(at) + 1 : at; good && ++at < end;)
      {
        good = faces->GetValue(at) >= 0 && faces->GetValue(at) < numPoints;
      }
    }
    if (!good)
    {
      return { ErrorCode::InvalidTopology,
        "the faces of cell " + std::to_string(cell) + " do not fit its points" };
    }
  }
  return {};
}
}

Status CheckCells(vtkDataObject* data)
{
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    const Status status = CheckArray(grid->GetCells(), grid->GetNumberOfPoints());
    return status
      ? CheckFaces(grid->GetFaces(), grid->GetFaceLocations(), grid->GetNumberOfPoints())
      : status;
  }
  if (auto* polydata = vtkPolyData::SafeDownCast(data))
  {
    for (vtkCellArray* cells :
      { polydata->GetVerts(), polydata->GetLines(), polydata->GetPolys(), polydata->GetStrips() })
    {
      if (Status status = CheckArray(cells, polydata->GetNumberOfPoints()); !status)
      {
        return status;
      }
    }
  }
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    const auto part = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (part->InitTraversal(); !part->IsDoneWithTraversal(); part->GoToNextItem())
    {
      if (Status status = CheckCells(part->GetCurrentDataObject()); !status)
      {
        return status;
      }
    }
  }
  return {};
}
}
