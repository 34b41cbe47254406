// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSweepToHexahedra.h"

#include "HexahedronData.h"
#include <knotwork/CADMeshing/Sweep.h>
#include <knotwork/SplineGrid/CellMeshData.h>
#include <knotwork/SplineGrid/TableRow.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

using namespace knotwork;

vtkStandardNewMacro(vtkSweepToHexahedra);

namespace
{
/// The points of the only line.
Result<PointMatrix> DecodePath(vtkPolyData* path)
{
  vtkCellArray* lines = path->GetLines();
  if (path->GetNumberOfCells() != 1 || lines->GetNumberOfCells() != 1)
  {
    return { ErrorCode::InvalidTopology,
      "the path (input 1) has " + std::to_string(lines->GetNumberOfCells()) + " lines and " +
        std::to_string(path->GetNumberOfCells() - lines->GetNumberOfCells()) +
        " other cells; give one line" };
  }
  vtkNew<vtkIdList> ids;
  lines->GetCellAtId(0, ids);
  PointMatrix points(ids->GetNumberOfIds(), 3);
  for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
  {
    path->GetPoint(ids->GetId(i), points.row(i).data());
  }
  return points;
}

/// Data of the source for every layer.
void CopyData(vtkDataSetAttributes* from, const std::vector<vtkIdType>& ids, int times,
  const char* layerName, const char* idName, vtkDataSetAttributes* to)
{
  const auto layers = NamedArray<vtkIntArray>(layerName);
  const auto origins = NamedArray<vtkIdTypeArray>(idName);
  to->CopyAllOn();
  to->CopyGlobalIdsOff();
  to->CopyAllocate(from, static_cast<vtkIdType>(ids.size()) * times);
  vtkIdType next = 0;
  for (int k = 0; k < times; ++k)
  {
    for (const vtkIdType id : ids)
    {
      to->CopyData(from, id, next++);
      layers->InsertNextValue(k);
      origins->InsertNextValue(id);
    }
  }
  to->AddArray(layers);
  to->AddArray(origins);
}

void EncodeMesh(const SweptMesh& swept, const DecodedMeshCells& source,
  const HexahedronQuality& quality, vtkPointSet* input, vtkUnstructuredGrid* output)
{
  EncodeHexahedra(swept.Mesh, swept.Points, quality, output);
  std::vector<vtkIdType> pointIds = source.Vertices;
  if (pointIds.empty())
  {
    for (Eigen::Index i = 0; i < source.Points.rows(); ++i)
    {
      pointIds.push_back(i);
    }
  }
  CopyData(input->GetPointData(), pointIds, swept.Layers + (swept.IsRing ? 0 : 1), "PointLayer",
    "SourcePointId", output->GetPointData());
  CopyData(input->GetCellData(), source.Cells, swept.Layers, "Layer", "SourceCellId",
    output->GetCellData());
}

void EncodeNumbers(const SweptMesh& swept, const HexahedronQuality& quality, vtkTable* table)
{
  AddColumn(table, "Hexahedra", swept.Mesh.NumCells());
  AddColumn(table, "Points", static_cast<int>(swept.Points.rows()));
  AddColumn(table, "Layers", swept.Layers);
  AddColumn(table, "Ring", swept.IsRing ? 1 : 0);
  AddHexahedronColumns(quality, table);
}
}

vtkSweepToHexahedra::vtkSweepToHexahedra()
{
  this->SetInputTypes({ Meshes(), Optional({ { "vtkPolyData" } }) });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkTable" });
}

void vtkSweepToHexahedra::SetPathConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkSweepToHexahedra::SetPathData(vtkDataObject* path)
{
  this->SetInputDataObject(1, path);
}

Status vtkSweepToHexahedra::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  vtkPolyData* path = vtkPolyData::GetData(inputs[1], 0);
  if (input->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const auto source = DecodeMeshCells(input, false);
  if (!source)
  {
    return source.Status;
  }
  const auto* quads = std::get_if<CellMesh<2>>(&source->Mesh);
  if (!quads)
  {
    return { ErrorCode::InvalidTopology,
      "the source (input 0) has hexahedra; give quadrilaterals, of their boundary, say" };
  }
  PathSweepParams params;
  params.Path = PointMatrix::Zero(2, 3);
  params.Path.row(0) = source->Points.leftCols<3>().colwise().mean();
  params.Path.row(1) = params.Path.row(0) +
    Eigen::RowVector3d(this->Direction[0], this->Direction[1], this->Direction[2]);
  if (path)
  {
    auto decoded = DecodePath(path);
    if (!decoded)
    {
      return decoded.Status;
    }
    params.Path = std::move(decoded.Value);
  }
  params.Layers = this->Layers;
  params.Twist = this->Twist;
  params.Scale = this->Scale;
  params.Progress = this->Progress();
  const PointMatrix points = source->Points.leftCols<3>();
  const auto swept = SweepAlongPath(*quads, points, params);
  if (!swept)
  {
    return swept.Status;
  }
  const auto quality = MeasureHexahedra(swept->Mesh, swept->Points, this->KernelThreads());
  if (!quality)
  {
    return quality.Status;
  }
  EncodeMesh(
    swept.Value, source.Value, quality.Value, input, vtkUnstructuredGrid::GetData(outputs, 0));
  EncodeNumbers(swept.Value, quality.Value, vtkTable::GetData(outputs, 1));
  this->ReportWarnings(HexahedronWarnings(
    quality.Value, "turn the path less sharply, twist less, or mend the source's quadrilaterals"));
  return {};
}
