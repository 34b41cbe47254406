// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineStitch.h"

#include <knotwork/SplineGrid/PatchFields.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SurfaceFitting/StitchTiles.h>

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

#include <set>

using knotwork::ErrorCode;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineStitch);

namespace
{
/// Ids that differ stay, else patches are numbered.
void NumberPatches(std::vector<knotwork::SplinePatch>& patches)
{
  std::set<int> ids;
  for (const knotwork::SplinePatch& patch : patches)
  {
    ids.insert(patch.Id);
  }
  int next = 0;
  for (knotwork::SplinePatch& patch : patches)
  {
    patch.Id = ids.size() == patches.size() ? patch.Id : next++;
    patch.Block = 0;
    patch.Cells.clear();
  }
}

/// All patches are surfaces with the same fields.
Status CheckTiles(const std::vector<knotwork::SplinePatch>& patches)
{
  for (std::size_t t = 0; t < patches.size(); ++t)
  {
    const knotwork::SplinePatch& patch = patches[t];
    const std::string tile = "tile " + std::to_string(t);
    if (!std::holds_alternative<knotwork::Spline<2>>(patch.Geometry))
    {
      return { ErrorCode::DimensionMismatch,
        tile + " (patch " + std::to_string(patch.Id) + ") is not a surface" };
    }
    const std::vector<knotwork::SplineField>& fields = patches.front().Fields;
    bool same = patch.Fields.size() == fields.size();
    for (std::size_t f = 0; same && f < fields.size(); ++f)
    {
      same = patch.Fields[f].Name == fields[f].Name &&
        patch.Fields[f].Coefficients.cols() == fields[f].Coefficients.cols();
    }
    if (!same)
    {
      return { ErrorCode::SizeMismatch,
        tile + " has other point arrays than tile 0; give all tiles the same ones" };
    }
  }
  return {};
}

/// One column a member of the edges.
template <typename Array, typename Get>
void AddEdgeColumn(
  vtkTable* table, const char* name, const std::vector<knotwork::StitchedEdge>& edges, Get get)
{
  table->AddColumn(knotwork::ArrayOf<Array>(name, edges, get));
}

void EncodeEdges(const std::vector<knotwork::StitchedEdge>& edges, vtkTable* table)
{
  using Edge = knotwork::StitchedEdge;
  const char* const tiles[] = { "TileA", "TileB" };
  const char* const sides[] = { "SideA", "SideB" };
  const char* const starts[] = { "StartA", "StartB" };
  const char* const ends[] = { "EndA", "EndB" };
  for (std::size_t i = 0; i < 2; ++i)
  {
    AddEdgeColumn<vtkIntArray>(
      table, tiles[i], edges, [i](const Edge& e) { return e.Interface.Sides[i].Patch; });
    AddEdgeColumn<vtkIntArray>(
      table, sides[i], edges, [i](const Edge& e) { return e.Interface.Sides[i].Side; });
    AddEdgeColumn<vtkDoubleArray>(
      table, starts[i], edges, [i](const Edge& e) { return e.Interface.Parts[i].Lower[0]; });
    AddEdgeColumn<vtkDoubleArray>(
      table, ends[i], edges, [i](const Edge& e) { return e.Interface.Parts[i].Upper[0]; });
  }
  AddEdgeColumn<vtkIntArray>(table, "Reversed", edges,
    [](const Edge& e) { return e.Interface.Orientation.Reversed[0] ? 1 : 0; });
  AddEdgeColumn<vtkDoubleArray>(
    table, "JumpBefore", edges, [](const Edge& e) { return e.JumpBefore; });
  AddEdgeColumn<vtkDoubleArray>(table, "Jump", edges, [](const Edge& e) { return e.Jump; });
  AddEdgeColumn<vtkDoubleArray>(
    table, "SlopeJumpBefore", edges, [](const Edge& e) { return e.SlopeJumpBefore; });
  AddEdgeColumn<vtkDoubleArray>(
    table, "SlopeJump", edges, [](const Edge& e) { return e.SlopeJump; });
}

void EncodeNumbers(const knotwork::StitchedTiles& stitched, vtkTable* table)
{
  knotwork::AddColumn(table, "Tiles", static_cast<int>(stitched.Tiles.size()));
  knotwork::AddColumn(table, "Edges", static_cast<int>(stitched.Edges.size()));
  int functions = 0;
  for (const knotwork::Spline<2>& tile : stitched.Tiles)
  {
    functions += tile.Space->NumFunctions;
  }
  knotwork::AddColumn(table, "Functions", functions);
  knotwork::AddColumn(table, "FunctionsAdded", stitched.NumFunctionsAdded);
  knotwork::AddColumn(table, "MaxChange", stitched.MaxChange);
  knotwork::AddColumn(table, "MaxJumpBefore", stitched.MaxJumpBefore);
  knotwork::AddColumn(table, "MaxJump", stitched.MaxJump);
  knotwork::AddColumn(table, "MaxSlopeJumpBefore", stitched.MaxSlopeJumpBefore);
  knotwork::AddColumn(table, "MaxSlopeJump", stitched.MaxSlopeJump);
}
}

vtkSplineStitch::vtkSplineStitch()
{
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkTable", "vtkTable" });
  knotwork::KeepReferenceSystem(this);
}

void vtkSplineStitch::AddPair(int tileA, int sideA, int tileB, int sideB, int reversed)
{
  this->Pairs.push_back({ tileA, sideA, tileB, sideB, reversed });
  this->Modified();
}

void vtkSplineStitch::ClearPairs()
{
  if (!this->Pairs.empty())
  {
    this->Pairs.clear();
    this->Modified();
  }
}

int vtkSplineStitch::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_IS_REPEATABLE(), 1);
  return this->Superclass::FillInputPortInformation(port, info);
}

Status vtkSplineStitch::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  knotwork::SplineModel model;
  for (int i = 0; i < inputs[0]->GetNumberOfInformationObjects(); ++i)
  {
    auto decoded = this->DecodeInput(vtkDataObject::GetData(inputs[0], i));
    if (!decoded)
    {
      return decoded.Status;
    }
    for (knotwork::SplinePatch& patch : decoded->Patches)
    {
      model.Patches.push_back(std::move(patch));
    }
  }
  if (model.Patches.empty())
  {
    return {};
  }
  if (const Status status = CheckTiles(model.Patches); !status)
  {
    return status;
  }
  std::vector<knotwork::Spline<2>> tiles;
  for (const knotwork::SplinePatch& patch : model.Patches)
  {
    tiles.push_back(
      knotwork::JoinFields(std::get<knotwork::Spline<2>>(patch.Geometry), patch.Fields));
  }

  knotwork::StitchParams params;
  params.Continuity = this->Continuity;
  params.Matching = static_cast<knotwork::TileMatching>(this->Matching);
  for (const auto& [tileA, sideA, tileB, sideB, reversed] : this->Pairs)
  {
    params.Pairs.emplace_back();
    params.Pairs.back().Sides = { knotwork::PatchSide{ tileA, sideA },
      knotwork::PatchSide{ tileB, sideB } };
    params.Pairs.back().Orientation = knotwork::SideOrientation::Make(reversed != 0 ? 1 : 0);
  }
  params.Tolerance = this->Tolerance;
  params.NumMeasured = 3;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto stitched = knotwork::StitchTiles(tiles, params);
  if (!stitched)
  {
    return stitched.Status;
  }

  for (std::size_t t = 0; t < tiles.size(); ++t)
  {
    knotwork::SeparateFields(stitched->Tiles[t], model.Patches[t]);
  }
  NumberPatches(model.Patches);
  EncodeEdges(stitched->Edges, vtkTable::GetData(outputs, 1));
  EncodeNumbers(stitched.Value, vtkTable::GetData(outputs, 2));
  return knotwork::EncodeSplineGrid(model, vtkUnstructuredGrid::GetData(outputs, 0));
}
