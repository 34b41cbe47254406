// SPDX-License-Identifier: BSD-3-Clause
#include "PieceSchema.h"

#include "BezierCells.h"
#include "SplineSchema.h"
#include "TopologyTable.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string>
#include <tuple>

namespace knotwork
{
namespace
{
/// The patches of a grid by their numbers, which take the places of indices.
std::map<int, PatchPlace> PatchesOf(vtkUnstructuredGrid* grid)
{
  std::map<int, PatchPlace> patches;
  vtkDataArray* ids = grid->GetCellData()->GetArray(name::PatchId);
  for (vtkIdType cell = 0; ids && cell < grid->GetNumberOfCells(); ++cell)
  {
    const int id = static_cast<int>(ids->GetComponent(cell, 0));
    patches.try_emplace(id, PatchPlace{ id, BezierCellDimension(grid->GetCellType(cell)) });
  }
  return patches;
}

void RemoveSchema(vtkFieldData* fieldData)
{
  for (int i = fieldData->GetNumberOfArrays() - 1; i >= 0; --i)
  {
    const char* arrayName = fieldData->GetArrayName(i);
    if (arrayName && std::string(arrayName).rfind("Knotwork", 0) == 0)
    {
      fieldData->RemoveArray(i);
    }
  }
}
}

void KeepOwnPatches(
  vtkUnstructuredGrid* whole, const std::vector<vtkSmartPointer<vtkUnstructuredGrid>>& pieces)
{
  const Result<SplineSchema> schema = ReadSchema(whole->GetFieldData());
  if (!schema || !schema->Present)
  {
    return;
  }
  int lost = 0;
  const PatchTopology topology = ReadTopology(whole->GetFieldData(), PatchesOf(whole), lost);
  for (const auto& piece : pieces)
  {
    const std::map<int, PatchPlace> own = PatchesOf(piece);
    const auto isOwn = [&own](int id) { return own.count(id) > 0; };
    SplineSchema kept;
    kept.Present = true;
    std::copy_if(schema->Patches.begin(), schema->Patches.end(), std::back_inserter(kept.Patches),
      [&](const PatchRecord& patch) { return isOwn(patch.Id); });
    if (kept.Patches.size() < own.size())
    {
      continue; // a patch has been renumbered: its basis is that of another record
    }
    std::copy_if(topology.Interfaces.begin(), topology.Interfaces.end(),
      std::back_inserter(kept.Topology.Interfaces),
      [&](const PatchInterface& one)
      { return isOwn(one.Sides[0].Patch) || isOwn(one.Sides[1].Patch); });
    std::copy_if(topology.Boundary.begin(), topology.Boundary.end(),
      std::back_inserter(kept.Topology.Boundary),
      [&](const PatchSide& side) { return isOwn(side.Patch); });
    RemoveSchema(piece->GetFieldData());
    WriteSchema(kept, piece->GetFieldData());
  }
}

PatchTopology JoinTopologies(
  const std::vector<vtkFieldData*>& pieces, const std::map<int, std::pair<int, int>>& patches)
{
  std::map<int, PatchPlace> places;
  for (const auto& [id, place] : patches)
  {
    places[id] = { place.first, place.second };
  }
  PatchTopology joined;
  std::set<std::tuple<int, int, int, int, int, std::array<double, 2>>> seen;
  std::set<std::pair<int, int>> seenSides;
  for (vtkFieldData* piece : pieces)
  {
    int lost = 0;
    const PatchTopology read = ReadTopology(piece, places, lost);
    for (const PatchInterface& one : read.Interfaces)
    {
      const auto& [a, b] = one.Sides;
      // several parts of a side begin at different places
      const std::array<double, 2> begin =
        one.Partial ? one.Parts[0].Lower : std::array<double, 2>{ 0.0, 0.0 };
      if (seen.emplace(a.Patch, a.Side, b.Patch, b.Side, one.Orientation.Number(), begin).second)
      {
        joined.Interfaces.push_back(one);
      }
    }
    for (const PatchSide& side : read.Boundary)
    {
      if (seenSides.emplace(side.Patch, side.Side).second)
      {
        joined.Boundary.push_back(side);
      }
    }
  }
  return joined;
}
}
