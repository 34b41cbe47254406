// SPDX-License-Identifier: BSD-3-Clause
#include "ValidatedGrids.h"

#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <iterator>

namespace knotwork
{
std::vector<std::pair<int, vtkUnstructuredGrid*>> GridsOf(vtkDataObject* input)
{
  std::vector<std::pair<int, vtkUnstructuredGrid*>> grids;
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(input))
  {
    grids.emplace_back(0, grid);
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(input);
  for (unsigned int b = 0; collection && b < collection->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkPartitionedDataSet* block = collection->GetPartitionedDataSet(b);
    for (unsigned int i = 0; block && i < block->GetNumberOfPartitions(); ++i)
    {
      if (auto* grid = vtkUnstructuredGrid::SafeDownCast(block->GetPartition(i)))
      {
        grids.emplace_back(static_cast<int>(b), grid);
      }
    }
  }
  return grids;
}

void CopyInput(vtkDataObject* input, vtkDataObject* output, std::vector<GridPair>& pairs)
{
  output->ShallowCopy(input);
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(output))
  {
    pairs.front().Output = grid;
    return;
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(output);
  auto* from = vtkPartitionedDataSetCollection::SafeDownCast(input);
  auto next = pairs.begin();
  for (unsigned int b = 0; collection && b < from->GetNumberOfPartitionedDataSets(); ++b)
  {
    vtkPartitionedDataSet* block = from->GetPartitionedDataSet(b);
    vtkNew<vtkPartitionedDataSet> copy;
    copy->ShallowCopy(block);
    for (unsigned int i = 0; block && i < block->GetNumberOfPartitions(); ++i)
    {
      if (auto* grid = vtkUnstructuredGrid::SafeDownCast(block->GetPartition(i)))
      {
        vtkNew<vtkUnstructuredGrid> made;
        made->ShallowCopy(grid);
        copy->SetPartition(i, made);
        (next++)->Output = made;
      }
    }
    collection->SetPartitionedDataSet(b, copy);
  }
}

const GridPair& OwnerOf(const std::vector<GridPair>& grids, std::size_t cell)
{
  return *std::prev(std::upper_bound(grids.begin(), grids.end(), cell,
    [](std::size_t i, const GridPair& grid) { return i < grid.FirstCell; }));
}

int PatchOf(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  vtkDataArray* ids = grid->GetCellData()->GetArray("PatchId");
  return ids && ids->GetNumberOfTuples() > cell ? static_cast<int>(ids->GetComponent(cell, 0)) : 0;
}

bool HaveCellArray(const std::vector<GridPair>& grids, const char* name)
{
  return std::all_of(grids.begin(), grids.end(),
    [name](const GridPair& grid) { return grid.Input->GetCellData()->GetArray(name) != nullptr; });
}

CellComplex ComplexOf(const GridCells& cells, const std::vector<GridPair>& grids, bool isPiece)
{
  CellComplex complex;
  const auto all = [&](const char* name) { return HaveCellArray(grids, name); };
  if (all("PatchId"))
  {
    std::map<std::pair<int, int>, int> numbers; // blocks may use the same ids
    for (const GridPair& grid : grids)
    {
      for (vtkIdType i = 0; i < grid.Input->GetNumberOfCells(); ++i)
      {
        const std::pair<int, int> key(grid.Block, PatchOf(grid.Input, i));
        complex.Patches.push_back(
          numbers.emplace(key, static_cast<int>(numbers.size())).first->second);
      }
    }
  }
  if (all("ParametricBounds") && all("PatchId"))
  {
    for (const GridPair& grid : grids)
    {
      vtkDataArray* bounds = grid.Input->GetCellData()->GetArray("ParametricBounds");
      for (vtkIdType i = 0; i < grid.Input->GetNumberOfCells(); ++i)
      {
        ParametricBox<3> box;
        for (int d = 0; d < 3 && bounds->GetNumberOfComponents() == 6; ++d)
        {
          const auto direction = static_cast<std::size_t>(d);
          box.Lower[direction] = bounds->GetComponent(i, 2 * d);
          box.Upper[direction] = bounds->GetComponent(i, 2 * d + 1);
        }
        complex.Boxes.push_back(box);
      }
    }
  }
  const bool known = std::all_of(cells.Points.begin(), cells.Points.end(),
                       [](vtkIdType point) { return point >= 0; }) &&
    (!isPiece ||
      std::all_of(grids.begin(), grids.end(),
        [](const GridPair& grid) { return grid.Input->GetPointData()->GetGlobalIds(); }));
  if (known && !complex.Patches.empty())
  {
    vtkIdType firstPoint = 0;
    std::size_t coefficient = 0;
    for (std::size_t g = 0; g < grids.size(); ++g)
    {
      const std::size_t next =
        g + 1 < grids.size() ? grids[g + 1].FirstCell : cells.FirstPoint.size();
      const std::size_t end =
        next < cells.FirstPoint.size() ? cells.FirstPoint[next] : cells.Points.size();
      vtkDataArray* ids = isPiece ? grids[g].Input->GetPointData()->GetGlobalIds() : nullptr;
      for (; coefficient < end; ++coefficient)
      {
        const vtkIdType point = cells.Points[coefficient];
        complex.PointIds.push_back(
          ids ? static_cast<vtkIdType>(ids->GetComponent(point, 0)) : firstPoint + point);
      }
      firstPoint += grids[g].Input->GetNumberOfPoints();
    }
  }
  return complex;
}

CellNames NamesOf(const std::vector<GridPair>& grids, const std::map<int, vtkIdType>& before)
{
  return [&grids, &before](int cell)
  {
    const GridPair& owner = OwnerOf(grids, static_cast<std::size_t>(cell));
    const vtkIdType local = cell - static_cast<vtkIdType>(owner.FirstCell);
    const auto first = before.find(owner.Block);
    vtkDataArray* numbers = owner.Input->GetCellData()->GetArray("ElementNumber");
    CellName name;
    name.Number = local + (first == before.end() ? 0 : first->second);
    name.Block = owner.Block;
    name.Patch = PatchOf(owner.Input, local);
    name.Element = numbers ? static_cast<std::int64_t>(numbers->GetComponent(local, 0)) : -1;
    return name;
  };
}
}
