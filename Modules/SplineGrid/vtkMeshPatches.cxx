// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshPatches.h"

#include "CellMeshData.h"
#include "NamedArray.h"
#include <knotwork/SplineCore/MeshGeometry.h>
#include <knotwork/SplineCore/MeshPatches.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataObject.h"
#include "vtkIdList.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

using namespace knotwork;

vtkStandardNewMacro(vtkMeshPatches);

namespace
{
std::size_t At(int i)
{
  return static_cast<std::size_t>(i);
}

/// The points of the mesh, which has fewer than a dataset of Bezier cells.
vtkSmartPointer<vtkPoints> PointsOf(vtkPointSet* data, const DecodedMeshCells& decoded)
{
  if (decoded.Vertices.empty())
  {
    return data->GetPoints();
  }
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(data->GetPoints()->GetDataType());
  for (const vtkIdType vertex : decoded.Vertices)
  {
    points->InsertNextPoint(data->GetPoint(vertex));
  }
  return points;
}

/// The cells of any dataset as a grid, with their data.
void CopyCells(vtkPointSet* data, vtkUnstructuredGrid* output)
{
  output->SetPoints(data->GetPoints());
  vtkNew<vtkIdList> ids;
  output->Allocate(data->GetNumberOfCells());
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
  {
    data->GetCellPoints(cell, ids);
    output->InsertNextCell(data->GetCellType(cell), ids);
  }
  output->GetPointData()->ShallowCopy(data->GetPointData());
  output->GetCellData()->ShallowCopy(data->GetCellData());
}

template <int Dim>
void EncodePlaces(const MeshPatches<Dim>& patches, vtkUnstructuredGrid* output)
{
  const auto ids =
    ArrayOf<vtkIntArray>("PatchId", patches.PatchOf, [](int patch) { return patch; });
  const auto cells = static_cast<vtkIdType>(patches.IndexOf.size());
  const auto places = NamedArray<vtkIntArray>("PatchIndex", 3, cells);
  for (vtkIdType c = 0; c < cells; ++c)
  {
    for (int d = 0; d < 3; ++d)
    {
      places->SetTypedComponent(
        c, d, d < Dim ? patches.IndexOf[static_cast<std::size_t>(c)][At(d % Dim)] : 0);
    }
  }
  output->GetCellData()->AddArray(ids);
  output->GetCellData()->AddArray(places);
  output->GetCellData()->SetActiveScalars("PatchId"); // drawn first
}

/// Vertices come before lines and polygons in polydata.
template <int Dim>
void EncodeCuts(const CellMesh<Dim>& mesh, const MeshTopology<Dim>& topology,
  const MeshPatches<Dim>& patches, vtkPoints* points, vtkPolyData* output)
{
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkCellArray> facets;
  const auto beside = NamedArray<vtkIntArray>("Patches", 2);
  for (const CellSide& joint : patches.TJoints)
  {
    const vtkIdType point = mesh.Cell(joint.Cell)[joint.Side];
    vertices->InsertNextCell(1, &point);
    beside->InsertNextTuple2(-1, -1);
  }
  for (const CellSide& cut : patches.Cuts)
  {
    constexpr int around[] = { 0, 1, 3, 2 }; // of the corners of a face
    vtkIdType ids[4] = {};
    int count = 0;
    for (int k = 0; k < (1 << (Dim - 1)); ++k)
    {
      const int corner = PatchCorner<Dim>(cut.Side, around[k]);
      ids[count++] = mesh.Cell(cut.Cell)[corner];
    }
    facets->InsertNextCell(count, ids);
    const int a = patches.PatchOf[At(cut.Cell)];
    const int b = patches.PatchOf[At(topology.Neighbour(cut.Cell, cut.Side))];
    beside->InsertNextTuple2(std::min(a, b), std::max(a, b));
  }
  output->SetPoints(points);
  output->SetVerts(vertices);
  Dim == 2 ? output->SetLines(facets) : output->SetPolys(facets);
  output->GetCellData()->AddArray(beside);
}

template <int Dim>
void EncodeTable(const MeshPatches<Dim>& patches, vtkTable* table)
{
  const auto add = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkIntArray>(name, patches.Patches, value)); };
  add("PatchId",
    [&](const MeshPatch<Dim>& patch) { return static_cast<int>(&patch - patches.Patches.data()); });
  for (std::size_t d = 0; d < 3; ++d)
  {
    const std::string name = "Size" + std::to_string(d);
    add(
      name.c_str(), [d](const MeshPatch<Dim>& patch) { return d < Dim ? patch.Size[d % Dim] : 1; });
  }
  add("Cells", [](const MeshPatch<Dim>& patch) { return static_cast<int>(patch.Cells.size()); });
}
}

vtkMeshPatches::vtkMeshPatches()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkPolyData", "vtkTable" });
}

vtkMeshPatches::~vtkMeshPatches()
{
  this->SetFeatureArray(nullptr);
}

Status vtkMeshPatches::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* data = vtkPointSet::GetData(inputs[0], 0);
  const auto decoded = DecodeMeshCells(data, false);
  if (!decoded)
  {
    return decoded.Status;
  }
  return std::visit(
    [&](const auto& mesh) -> Status
    {
      constexpr int Dim = std::is_same_v<std::decay_t<decltype(mesh)>, CellMesh<2>> ? 2 : 3;
      const auto topology = MakeConforming<Dim>(mesh, decoded.Value);
      if (!topology)
      {
        return topology.Status;
      }
      const auto features = FindFeatures<Dim>(data, decoded.Value, mesh, topology.Value,
        this->FeatureAngle, this->FeatureArray ? this->FeatureArray : "");
      if (!features)
      {
        return features.Status;
      }
      const auto patches = FindMeshPatches<Dim>(mesh,
        this->Layout == BASE_COMPLEX ? CreasePolicy::Full : CreasePolicy::Motorcycle,
        features.Value);
      if (!patches)
      {
        return patches.Status;
      }
      vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputs, 0);
      CopyCells(data, output);
      EncodePlaces<Dim>(patches.Value, output);
      EncodeCuts<Dim>(mesh, topology.Value, patches.Value, PointsOf(data, decoded.Value),
        vtkPolyData::GetData(outputs, 1));
      EncodeTable<Dim>(patches.Value, vtkTable::GetData(outputs, 2));
      return {};
    },
    decoded->Mesh);
}
