// SPDX-License-Identifier: BSD-3-Clause
#include "GridReader.h"

#include "vtkDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"

#include <algorithm>
#include <unordered_set>

namespace knotwork
{
namespace
{
/// What is said again of another patch or block goes.
void KeepNewWarnings(std::vector<std::string>& warnings)
{
  std::unordered_set<std::string> said;
  const auto isOld = [&said](const std::string& text) { return !said.insert(text).second; };
  warnings.erase(std::remove_if(warnings.begin(), warnings.end(), isOld), warnings.end());
}

Status DecodeCollection(
  vtkPartitionedDataSetCollection* collection, int threads, SplineModel& model)
{
  for (unsigned int b = 0; b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkPartitionedDataSet* block = collection->GetPartitionedDataSet(b);
    vtkIdType firstCell = 0;
    PatchNumbers numbers;
    for (unsigned int i = 0; block && i < block->GetNumberOfPartitions(); ++i)
    {
      vtkDataSet* piece = block->GetPartition(i);
      auto* grid = vtkUnstructuredGrid::SafeDownCast(piece);
      const std::string where = "block " + std::to_string(b);
      if (!grid)
      {
        if (piece)
        {
          model.Warnings.push_back(
            where + " has a " + piece->GetClassName() + ", which is no spline: it passes as it is");
        }
        continue;
      }
      const Status status =
        GridReader(grid, static_cast<int>(b), firstCell, numbers, threads, model).Read();
      if (!status)
      {
        return { status.Code, where + ": " + status.Detail };
      }
      firstCell += grid->GetNumberOfCells();
    }
  }
  return {};
}
}

Result<SplineModel> DecodeSplineModel(vtkDataObject* data, int threads)
{
  SplineModel model;
  Status status;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    PatchNumbers numbers;
    status = GridReader(grid, 0, 0, numbers, threads, model).Read();
  }
  else if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data))
  {
    status = DecodeCollection(collection, threads, model);
  }
  else
  {
    status = { ErrorCode::InvalidTopology,
      std::string(data ? data->GetClassName() : "nothing") +
        " is no spline: needed is a vtkUnstructuredGrid of Bezier cells or a "
        "vtkPartitionedDataSetCollection of such grids" };
  }
  if (!status)
  {
    return status;
  }
  KeepNewWarnings(model.Warnings);
  return model;
}
}
