// SPDX-License-Identifier: BSD-3-Clause
#include "SplineBlocks.h"

#include "vtkAppendFilter.h"
#include "vtkDataObjectTypes.h"
#include "vtkDataSet.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"

namespace knotwork
{
std::map<int, vtkSmartPointer<vtkUnstructuredGrid>> GridsByBlock(vtkDataObject* data)
{
  std::map<int, vtkSmartPointer<vtkUnstructuredGrid>> grids;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    grids[0] = grid;
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(data);
  for (unsigned int b = 0; collection && b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkPartitionedDataSet* block = collection->GetPartitionedDataSet(b);
    std::vector<vtkUnstructuredGrid*> pieces;
    for (unsigned int i = 0; block && i < block->GetNumberOfPartitions(); ++i)
    {
      auto* piece = vtkUnstructuredGrid::SafeDownCast(block->GetPartition(i));
      if (piece && piece->GetNumberOfCells() > 0)
      {
        pieces.push_back(piece);
      }
    }
    if (pieces.size() == 1)
    {
      grids[static_cast<int>(b)] = pieces[0];
    }
    else if (!pieces.empty())
    {
      vtkNew<vtkAppendFilter> append;
      for (vtkUnstructuredGrid* piece : pieces)
      {
        append->AddInputData(piece);
      }
      append->Update();
      grids[static_cast<int>(b)] = append->GetOutput();
    }
  }
  return grids;
}

bool HoldsSplines(vtkDataObject* data)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  if (!grid)
  {
    return vtkPartitionedDataSetCollection::SafeDownCast(data) != nullptr;
  }
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    const int type = grid->GetCellType(c);
    if (type != VTK_BEZIER_CURVE && type != VTK_BEZIER_QUADRILATERAL &&
      type != VTK_BEZIER_HEXAHEDRON)
    {
      return false;
    }
  }
  return grid->GetNumberOfCells() > 0;
}

Status MakeByBlock(const SplineModel& model, vtkDataObject* input, vtkDataObject* output, int type,
  const BlockMaker& make)
{
  std::map<int, std::vector<const SplinePatch*>> patches;
  for (const SplinePatch& patch : model.Patches)
  {
    patches[patch.Block].push_back(&patch);
  }
  const auto sources = GridsByBlock(input);
  const auto sourceOf = [&sources](int block)
  {
    const auto found = sources.find(block);
    return found == sources.end() ? nullptr : found->second.Get();
  };
  if (auto* dataSet = vtkDataSet::SafeDownCast(output))
  {
    return make(patches[0], sourceOf(0), dataSet);
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(output);
  auto* like = vtkPartitionedDataSetCollection::SafeDownCast(input);
  if (!collection || !like)
  {
    return { ErrorCode::InvalidParameter, "a collection becomes a collection" };
  }
  collection->Initialize();
  collection->CopyStructure(like);
  collection->SetNumberOfPartitionedDataSets(like->GetNumberOfPartitionedDataSets());
  for (unsigned int b = 0; b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkNew<vtkPartitionedDataSet> block;
    const auto found = patches.find(static_cast<int>(b));
    if (found != patches.end())
    {
      vtkSmartPointer<vtkDataObject> made;
      made.TakeReference(vtkDataObjectTypes::NewDataObject(type));
      const Status status =
        make(found->second, sourceOf(static_cast<int>(b)), vtkDataSet::SafeDownCast(made));
      if (!status)
      {
        return { status.Code, "block " + std::to_string(b) + ": " + status.Detail };
      }
      block->SetPartition(0, made);
    }
    collection->SetPartitionedDataSet(b, block);
  }
  return {};
}
}
