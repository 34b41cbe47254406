// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceRepair.h"

#include "OriginData.h"
#include <knotwork/MeshParameterization/MeshData.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SurfaceRemeshing/SurfaceRepair.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <string>

using namespace knotwork;

vtkStandardNewMacro(vtkSurfaceRepair);

namespace
{
void EncodeSurface(const SurfaceRepair& repaired, const std::vector<int>& cellsOfTriangles,
  vtkPointSet* input, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(repaired.Changed ? VTK_DOUBLE : input->GetPoints()->GetDataType());
  for (Eigen::Index i = 0; i < repaired.Mesh.Points.rows(); ++i)
  {
    points->InsertNextPoint(repaired.Mesh.Points.row(i).data());
  }
  vtkNew<vtkCellArray> cells;
  std::vector<int> ids;
  for (std::size_t t = 0; t < repaired.Mesh.Triangles.size(); ++t)
  {
    const auto& corners = repaired.Mesh.Triangles[t];
    cells->InsertNextCell({ corners[0], corners[1], corners[2] });
    const int triangle = repaired.TriangleIds[t];
    ids.push_back(triangle < 0 ? -1 : cellsOfTriangles[static_cast<std::size_t>(triangle)]);
  }
  output->SetPoints(points);
  output->SetPolys(cells);
  CopyOriginData(input->GetPointData(), repaired.PointIds, "PointIds", output->GetPointData());
  CopyOriginData(input->GetCellData(), ids, "CellIds", output->GetCellData());
}

void EncodeActions(const SurfaceRepair& repaired, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  for (const RepairAction& action : repaired.Actions)
  {
    const vtkIdType point = points->InsertNextPoint(action.Place.data());
    cells->InsertNextCell(1, &point);
  }
  output->SetPoints(points);
  output->SetVerts(cells);
  vtkCellData* data = output->GetCellData();
  data->AddArray(ArrayOf<vtkIntArray>("Kind", repaired.Actions,
    [](const RepairAction& action) { return static_cast<int>(action.Kind); }));
  data->AddArray(ArrayOf<vtkStringArray>("Action", repaired.Actions,
    [](const RepairAction& action) { return std::string(ToString(action.Kind)); }));
  data->AddArray(ArrayOf<vtkDoubleArray>(
    "Size", repaired.Actions, [](const RepairAction& action) { return action.Size; }));
}

void AddNumbers(vtkTable* table, const std::string& suffix, const RepairNumbers& numbers)
{
  AddColumn(table, ("Points" + suffix).c_str(), numbers.Points);
  AddColumn(table, ("Triangles" + suffix).c_str(), numbers.Triangles);
  AddColumn(table, ("Parts" + suffix).c_str(), numbers.Parts);
  AddColumn(table, ("Euler" + suffix).c_str(), numbers.Euler);
  AddColumn(table, ("Area" + suffix).c_str(), numbers.Area);
  AddColumn(table, ("Volume" + suffix).c_str(), numbers.Volume);
}

void EncodeNumbers(const SurfaceRepair& repaired, vtkTable* table)
{
  AddColumn(table, "Changed", repaired.Changed ? 1 : 0);
  AddColumn(table, "Closed", repaired.Closed ? 1 : 0);
  AddColumn(table, "Wrapped", repaired.Wrapped ? 1 : 0);
  const char* names[NumRepairKinds] = { "DegenerateFaces", "DuplicateFaces", "LooseFaces",
    "TurnedFaces", "Junctions", "Holes", "Intersections", "DividedEdges", "DividedPoints",
    "CutTips", "Overlaps", "InnerWalls", "SmallParts", "Patches" };
  for (int kind = 0; kind < NumRepairKinds; ++kind)
  {
    AddColumn(table, names[kind], repaired.Count(static_cast<RepairKind>(kind)));
  }
  AddColumn(table, "MergedPoints", repaired.MergedPoints);
  AddNumbers(table, "Before", repaired.Before);
  AddNumbers(table, "After", repaired.After);
  AddColumn(table, "DistanceFromInput", repaired.DistanceFromInput);
  AddColumn(table, "DistanceToInput", repaired.DistanceToInput);
  AddColumn(table, "Diagonal", repaired.Diagonal);
}
}

vtkSurfaceRepair::vtkSurfaceRepair()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkPolyData", "vtkPolyData", "vtkTable" });
}

Status vtkSurfaceRepair::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  if (input->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const auto decoded = DecodeMesh(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  SurfaceRepairParams params;
  params.Limit = this->Limit;
  params.LargestHole = this->LargestHole;
  params.AllowOpen = this->AllowOpen;
  params.OverlapDepth = this->OverlapDepth;
  params.SmallestPart = this->SmallestPart;
  params.AlphaWrap = this->AlphaWrap;
  params.WrapAlpha = this->WrapAlpha;
  params.WrapOffset = this->WrapOffset;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto repaired = RepairSurface(decoded->Mesh, params);
  if (!repaired)
  {
    return repaired.Status;
  }
  if (repaired->Wrapped)
  {
    this->ReportWarnings({ "the result is an alpha wrap around the triangles, no repair of them: " +
      repaired->WrapReason });
  }
  EncodeSurface(repaired.Value, decoded->Cells, input, vtkPolyData::GetData(outputs, 0));
  EncodeActions(repaired.Value, vtkPolyData::GetData(outputs, 1));
  EncodeNumbers(repaired.Value, vtkTable::GetData(outputs, 2));
  return {};
}
