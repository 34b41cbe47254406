// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineTessellate.h"

#include "ReferenceSystem.h"
#include "SplineBlocks.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Tessellation.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <map>

using knotwork::PointMatrix;
using knotwork::SplinePatch;
using knotwork::Status;
using knotwork::TessellationMesh;
using knotwork::TessellationShape;

vtkStandardNewMacro(vtkSplineTessellate);

namespace
{
/// A double array with the rows of a matrix.
vtkSmartPointer<vtkDoubleArray> MakeArray(const std::string& name, const PointMatrix& values)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name.c_str());
  array->SetNumberOfComponents(static_cast<int>(values.cols()));
  array->SetNumberOfTuples(values.rows());
  std::copy(values.data(), values.data() + values.size(), array->GetPointer(0));
  return array;
}

/// Meshes of a block's curves, surfaces and solids, one after the other.
struct BlockMesh
{
  PointMatrix Points{ 0, 3 };
  PointMatrix Normals{ 0, 3 };
  bool HasNormals = false;
  std::vector<int> PointPatch; ///< index into the block's patches
  std::vector<int> PointElement;
  PointMatrix PointLocal{ 0, 3 };
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkCellArray> Cells; ///< polygons, or all cells of a volume mesh
  std::vector<unsigned char> Types;
  std::vector<int> CellPatch; ///< index into the block's patches
  std::vector<int> CellElement;
  double Bound = 0.0;
};

template <typename Matrix>
void AppendRows(Matrix& to, const PointMatrix& rows)
{
  const Eigen::Index before = to.rows();
  to.conservativeResize(before + rows.rows(), to.cols());
  to.bottomRows(rows.rows()) = rows;
}

void Append(
  const TessellationMesh& mesh, const std::vector<int>& patchIndex, int dimension, BlockMesh& block)
{
  const vtkIdType first = block.Points.rows();
  const Eigen::Index n = mesh.Points.rows();
  AppendRows(block.Points, mesh.Points);
  PointMatrix normals = PointMatrix::Zero(n, 3);
  if (mesh.Normals.rows() > 0)
  {
    normals = mesh.Normals;
    block.HasNormals = true;
  }
  AppendRows(block.Normals, normals);
  PointMatrix local = PointMatrix::Zero(n, 3);
  local.leftCols(dimension) = mesh.PointLocal;
  AppendRows(block.PointLocal, local);
  for (std::size_t i = 0; i < mesh.PointPatch.size(); ++i)
  {
    block.PointPatch.push_back(patchIndex[static_cast<std::size_t>(mesh.PointPatch[i])]);
    block.PointElement.push_back(mesh.PointElement[i]);
  }
  std::vector<vtkIdType> corners;
  for (std::size_t c = 0; c < mesh.Shapes.size(); ++c)
  {
    corners.clear();
    for (std::int64_t k = mesh.Offsets[c]; k < mesh.Offsets[c + 1]; ++k)
    {
      corners.push_back(first + mesh.Connectivity[static_cast<std::size_t>(k)]);
    }
    const bool line = mesh.Shapes[c] == TessellationShape::Line;
    (line ? block.Lines : block.Cells)
      ->InsertNextCell(static_cast<vtkIdType>(corners.size()), corners.data());
    block.Types.push_back(line                               ? VTK_LINE
        : mesh.Shapes[c] == TessellationShape::Triangle      ? VTK_TRIANGLE
        : mesh.Shapes[c] == TessellationShape::Quadrilateral ? VTK_QUAD
                                                             : VTK_HEXAHEDRON);
    block.CellPatch.push_back(patchIndex[static_cast<std::size_t>(mesh.CellPatch[c])]);
    block.CellElement.push_back(mesh.CellElement[c]);
  }
  block.Bound = std::max(block.Bound, mesh.Bound);
}

/// Tessellates the patches with Dim parameters.
template <int Dim>
Status TessellateDimension(const std::vector<const SplinePatch*>& patches,
  const knotwork::TessellationParams& params, BlockMesh& block)
{
  std::vector<knotwork::BezierForm<Dim>> forms;
  std::vector<int> patchIndex;
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    if (const auto* spline = std::get_if<knotwork::Spline<Dim>>(&patches[p]->Geometry))
    {
      forms.push_back(MakeBezierForm(*spline, params.Threads));
      patchIndex.push_back(static_cast<int>(p));
    }
  }
  if (forms.empty())
  {
    return {};
  }
  const auto mesh = knotwork::Tessellate<Dim>(forms, params);
  if (mesh)
  {
    Append(mesh.Value, patchIndex, Dim, block);
  }
  return mesh.Status;
}

void FillCells(const BlockMesh& block, vtkDataSet* output)
{
  if (auto* polygons = vtkPolyData::SafeDownCast(output))
  {
    polygons->SetLines(block.Lines);
    polygons->SetPolys(block.Cells);
    return;
  }
  vtkNew<vtkCellArray> all; // lines were made first
  all->Append(block.Lines);
  all->Append(block.Cells);
  vtkNew<vtkUnsignedCharArray> types;
  types->SetNumberOfValues(static_cast<vtkIdType>(block.Types.size()));
  std::copy(block.Types.begin(), block.Types.end(), types->GetPointer(0));
  vtkUnstructuredGrid::SafeDownCast(output)->SetCells(types, all);
}

void SetCellData(const BlockMesh& block, const std::vector<const SplinePatch*>& patches,
  vtkUnstructuredGrid* source, vtkDataSet* output)
{
  std::array<vtkNew<vtkIntArray>, 3> ids;
  std::vector<vtkIdType> sourceCells;
  for (std::size_t c = 0; c < block.CellPatch.size(); ++c)
  {
    const SplinePatch& patch = *patches[static_cast<std::size_t>(block.CellPatch[c])];
    const auto element = static_cast<std::size_t>(block.CellElement[c]);
    ids[0]->InsertNextValue(patch.Id);
    ids[1]->InsertNextValue(block.CellElement[c]);
    ids[2]->InsertNextValue(std::visit(
      [&](const auto& spline) { return spline.Space->Elements[element].Level; }, patch.Geometry));
    sourceCells.push_back(element < patch.Cells.size() ? patch.Cells[element] : -1);
  }
  for (std::size_t i = 0; i < 3; ++i)
  {
    ids[i]->SetName(i == 0 ? "PatchId" : i == 1 ? "ElementId" : "Level");
    output->GetCellData()->AddArray(ids[i]);
  }
  if (source)
  {
    knotwork::PassCellData(source, sourceCells, output);
  }
}

/// Values of the fields of one patch at its points, rows of the block; patches without a field
/// leave zeros.
template <int Dim>
Status EvaluateFields(const BlockMesh& block, const SplinePatch& patch,
  const std::vector<Eigen::Index>& rows, const knotwork::Spline<Dim>& geometry, int threads,
  std::map<std::string, PointMatrix>& fields)
{
  std::vector<int> elements;
  for (const Eigen::Index row : rows)
  {
    elements.push_back(block.PointElement[static_cast<std::size_t>(row)]);
  }
  PointMatrix local(static_cast<Eigen::Index>(rows.size()), Dim);
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    local.row(static_cast<Eigen::Index>(k)) = block.PointLocal.row(rows[k]).head<Dim>();
  }
  knotwork::EvaluationParams params;
  params.Threads = threads;
  for (const knotwork::SplineField& field : patch.Fields)
  {
    PointMatrix& values = fields[field.Name];
    if (values.rows() == 0)
    {
      values = PointMatrix::Zero(block.Points.rows(), field.Coefficients.cols());
    }
    if (values.cols() != field.Coefficients.cols())
    {
      continue; // a field of this name has other components on another patch
    }
    knotwork::Spline<Dim> spline = geometry;
    spline.ControlPoints = field.Coefficients;
    knotwork::EvaluationBatch batch;
    const Status status =
      EvaluateElements(MakeBezierForm(spline, threads), elements, local, params, batch);
    if (!status)
    {
      return status;
    }
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
      values.row(rows[k]) = batch.Values.row(static_cast<Eigen::Index>(k));
    }
  }
  return {};
}

Status SetPointData(const BlockMesh& block, const std::vector<const SplinePatch*>& patches,
  int threads, vtkDataSet* output)
{
  std::map<std::string, PointMatrix> fields;
  std::vector<std::vector<Eigen::Index>> rows(patches.size());
  for (std::size_t i = 0; i < block.PointPatch.size(); ++i)
  {
    rows[static_cast<std::size_t>(block.PointPatch[i])].push_back(static_cast<Eigen::Index>(i));
  }
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const Status status = std::visit([&](const auto& geometry)
      { return EvaluateFields(block, *patches[p], rows[p], geometry, threads, fields); },
      patches[p]->Geometry);
    if (!status)
    {
      return status;
    }
  }
  vtkPointData* arrays = output->GetPointData();
  for (const auto& [name, values] : fields)
  {
    arrays->AddArray(MakeArray(name, values));
  }
  if (block.HasNormals)
  {
    arrays->SetNormals(MakeArray("Normals", block.Normals));
  }
  vtkNew<vtkIntArray> patchId;
  patchId->SetName("PatchId");
  vtkNew<vtkIntArray> elementId;
  elementId->SetName("ElementId");
  for (std::size_t i = 0; i < block.PointPatch.size(); ++i)
  {
    patchId->InsertNextValue(patches[static_cast<std::size_t>(block.PointPatch[i])]->Id);
    elementId->InsertNextValue(block.PointElement[i]);
  }
  arrays->AddArray(patchId);
  arrays->AddArray(elementId);
  arrays->AddArray(MakeArray("LocalParameters", block.PointLocal));
  return {};
}
}

vtkSplineTessellate::vtkSplineTessellate()
{
  knotwork::KeepReferenceSystem(this);
}

int vtkSplineTessellate::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (this->Cells == VOLUME || vtkPartitionedDataSetCollection::GetData(inputs[0], 0))
  {
    return this->Superclass::RequestDataObject(request, inputs, outputs);
  }
  MakeOutput(outputs, 0, "vtkPolyData");
  return 1;
}

Status vtkSplineTessellate::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  auto model = this->DecodeInput(input);
  if (!model)
  {
    return model.Status;
  }
  return knotwork::MakeByBlock(model.Value, input, vtkDataObject::GetData(outputs),
    this->Cells == VOLUME ? VTK_UNSTRUCTURED_GRID : VTK_POLY_DATA,
    [this](const std::vector<const SplinePatch*>& patches, vtkUnstructuredGrid* source,
      vtkDataSet* output)
    {
      if (patches.empty())
      {
        return Status();
      }
      knotwork::TessellationParams params;
      params.Tolerance = this->ChordalTolerance;
      if (this->RelativeTolerance)
      {
        // A single point has no size: any tolerance will do.
        const double diagonal = source->GetLength();
        params.Tolerance *= diagonal > 0.0 ? diagonal : 1.0;
      }
      params.MaximumSubdivision = this->MaximumSubdivision;
      params.Output = this->Cells == VOLUME ? knotwork::TessellationOutput::Volume
                                            : knotwork::TessellationOutput::Surface;
      params.Normals = this->Normals;
      params.Splitting = this->Splitting;
      params.MaxCells = this->MaximumCells;
      params.Threads = this->KernelThreads();
      params.Progress = this->Progress();
      BlockMesh block;
      Status status = TessellateDimension<1>(patches, params, block);
      status = status ? TessellateDimension<2>(patches, params, block) : status;
      status = status ? TessellateDimension<3>(patches, params, block) : status;
      if (!status)
      {
        return status;
      }
      vtkNew<vtkPoints> points;
      points->SetData(MakeArray("Points", block.Points));
      if (auto* polygons = vtkPolyData::SafeDownCast(output))
      {
        polygons->SetPoints(points);
      }
      else
      {
        vtkUnstructuredGrid::SafeDownCast(output)->SetPoints(points);
      }
      FillCells(block, output);
      SetCellData(block, patches, source, output);
      status = SetPointData(block, patches, params.Threads, output);
      vtkNew<vtkDoubleArray> bound;
      bound->SetName("ChordalBound");
      bound->InsertNextValue(block.Bound);
      output->GetFieldData()->AddArray(bound);
      if (block.Bound > params.Tolerance)
      {
        this->ReportWarnings(
          { "the deviation is below " + knotwork::Digits(block.Bound) + " only, not below " +
            knotwork::Digits(params.Tolerance) + ": raise MaximumSubdivision" });
      }
      return status;
    });
}
