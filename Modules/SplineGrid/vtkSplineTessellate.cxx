// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineTessellate.h"

#include "NamedArray.h"
#include "Processes.h"
#include "ReferenceSystem.h"
#include "SplineBlocks.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineCore/Parallel.h>
#include <knotwork/SplineCore/Tessellation.h>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

using knotwork::NamedArray;
using knotwork::PointMatrix;
using knotwork::SplinePatch;
using knotwork::Status;
using knotwork::TessellationMesh;
using knotwork::TessellationShape;

vtkStandardNewMacro(vtkSplineTessellate);

namespace
{
/// fill(row) of all rows, many rows at once.
template <typename Fill>
void ForRows(std::size_t count, int threads, const Fill& fill)
{
  constexpr std::size_t rowsAtOnce = 65536;
  knotwork::ParallelFor(count, rowsAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        fill(i);
      }
    });
}

/// Meshes of a block's curves, surfaces and solids, one after the other: what becomes arrays of VTK
/// is given back.
class BlockMesh
{
public:
  explicit BlockMesh(int threads) : Threads(threads) {}

  /// @param patches  index into the block's patches, of each of the mesh.
  void Add(TessellationMesh&& mesh, std::vector<int> patches, int dimension)
  {
    this->Parts.push_back(
      { std::move(mesh), std::move(patches), dimension, this->NumPoints, this->NumCells });
    this->NumPoints += static_cast<vtkIdType>(this->Parts.back().Mesh.PointPatch.size());
    this->NumCells += static_cast<vtkIdType>(this->Parts.back().Mesh.Shapes.size());
    this->Bound = std::max(this->Bound, this->Parts.back().Mesh.Bound);
  }

  /// Rows of a matrix of each mesh, zeros beyond its columns.
  vtkSmartPointer<vtkDoubleArray> Take(const char* name, PointMatrix TessellationMesh::*values)
  {
    auto array = NamedArray<vtkDoubleArray>(name, 3, this->NumPoints);
    for (Part& part : this->Parts)
    {
      PointMatrix rows = std::move(part.Mesh.*values);
      double* to = array->GetPointer(static_cast<vtkIdType>(3 * part.FirstPoint));
      ForRows(part.Mesh.PointPatch.size(), this->Threads,
        [&](std::size_t i)
        {
          for (Eigen::Index c = 0; c < 3; ++c)
          {
            const auto row = static_cast<Eigen::Index>(i);
            to[3 * i + static_cast<std::size_t>(c)] =
              row < rows.rows() && c < rows.cols() ? rows(row, c) : 0.0;
          }
        });
    }
    return array;
  }

  bool HasNormals() const
  {
    return std::any_of(this->Parts.begin(), this->Parts.end(),
      [](const Part& part) { return part.Mesh.HasNormals; });
  }

  /// Lines, or all other cells, or all.
  vtkSmartPointer<vtkCellArray> TakeCells(bool lines, bool others)
  {
    const auto isWanted = [&](const Part& part) { return part.Dimension == 1 ? lines : others; };
    std::size_t numCells = 0;
    std::size_t numCorners = 0;
    for (const Part& part : this->Parts)
    {
      numCells += isWanted(part) ? part.Mesh.Shapes.size() : 0;
      numCorners += isWanted(part) ? part.Mesh.Connectivity.size() : 0;
    }
    auto offsets = NamedArray<vtkIdTypeArray>(nullptr, 1, numCells + 1);
    auto corners = NamedArray<vtkIdTypeArray>(nullptr, 1, numCorners);
    offsets->SetValue(0, 0);
    vtkIdType* nextOffset = offsets->GetPointer(1);
    vtkIdType* nextCorner = corners->GetPointer(0);
    vtkIdType before = 0;
    for (Part& part : this->Parts)
    {
      if (isWanted(part))
      {
        const std::vector<std::int64_t> ends = std::move(part.Mesh.Offsets);
        const std::vector<std::int64_t> points = std::move(part.Mesh.Connectivity);
        ForRows(ends.size() - 1, this->Threads,
          [&](std::size_t c) { nextOffset[c] = before + ends[c + 1]; });
        ForRows(points.size(), this->Threads,
          [&](std::size_t k)
          { nextCorner[k] = static_cast<vtkIdType>(part.FirstPoint) + points[k]; });
        nextOffset += ends.size() - 1;
        nextCorner += points.size();
        before += static_cast<vtkIdType>(points.size());
      }
    }
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    cells->SetData(offsets, corners);
    return cells;
  }

  vtkSmartPointer<vtkUnsignedCharArray> Types() const
  {
    auto types = NamedArray<vtkUnsignedCharArray>(nullptr, 1, this->NumCells);
    this->ForCells([&](const Part& part, std::size_t c, std::size_t cell)
      { types->SetValue(static_cast<vtkIdType>(cell), TypeOf(part.Mesh.Shapes[c])); });
    return types;
  }

  /// do(patch, element, cell)
  template <typename Do>
  void ForCellElements(const Do& visit) const
  {
    this->ForCells([&](const Part& part, std::size_t c, std::size_t cell)
      { visit(part.PatchOf(part.Mesh.CellPatch[c]), part.Mesh.CellElement[c], cell); });
  }

  /// do(patch, element, point)
  template <typename Do>
  void ForPointElements(const Do& visit) const
  {
    for (const Part& part : this->Parts)
    {
      ForRows(part.Mesh.PointPatch.size(), this->Threads,
        [&](std::size_t i) {
          visit(
            part.PatchOf(part.Mesh.PointPatch[i]), part.Mesh.PointElement[i], part.FirstPoint + i);
        });
    }
  }

  /// Of the points of parts, among those of all parts.
  vtkSmartPointer<vtkIdTypeArray> PointNumbers() const
  {
    auto numbers = NamedArray<vtkIdTypeArray>("GlobalPointIds", 1, this->NumPoints);
    vtkIdType before = 0; // points of all parts of meshes before
    vtkIdType row = 0;
    for (const Part& part : this->Parts)
    {
      const auto count = static_cast<vtkIdType>(part.Mesh.PointPatch.size());
      const auto own = count - static_cast<vtkIdType>(part.Mesh.SharedPoints.size());
      for (vtkIdType i = 0; i < count; ++i)
      {
        numbers->SetValue(row++,
          before +
            (i < own ? part.Mesh.FirstPoint + i
                     : part.Mesh.SharedPoints[static_cast<std::size_t>(i - own)]));
      }
      before += part.Mesh.NumPointsOfAll;
    }
    return numbers;
  }

  vtkSmartPointer<vtkIdTypeArray> PointsByDimension() const
  {
    auto counts = NamedArray<vtkIdTypeArray>(vtkSplineTessellate::PointsByDimension(), 1, 3);
    counts->Fill(0.0);
    for (const Part& part : this->Parts)
    {
      counts->SetValue(part.Dimension - 1, part.Mesh.NumPointsOfAll);
    }
    return counts;
  }

  /// Points of patches that are wanted, by patch.
  std::vector<std::vector<vtkIdType>> PointsOf(const std::vector<bool>& isWanted) const
  {
    std::vector<std::vector<vtkIdType>> points(isWanted.size());
    for (const Part& part : this->Parts)
    {
      vtkIdType point = part.FirstPoint;
      for (const int own : part.Mesh.PointPatch)
      {
        const std::size_t patch = part.PatchOf(own);
        if (isWanted[patch])
        {
          points[patch].push_back(point);
        }
        ++point;
      }
    }
    return points;
  }

  vtkIdType NumPoints = 0;
  vtkIdType NumCells = 0;
  double Bound = 0.0;
  int Threads;

private:
  struct Part
  {
    TessellationMesh Mesh;
    std::vector<int> Patches;
    int Dimension;
    vtkIdType FirstPoint;
    vtkIdType FirstCell;

    std::size_t PatchOf(int patch) const
    {
      return static_cast<std::size_t>(this->Patches[static_cast<std::size_t>(patch)]);
    }
  };

  static unsigned char TypeOf(TessellationShape shape)
  {
    return shape == TessellationShape::Line       ? VTK_LINE
      : shape == TessellationShape::Triangle      ? VTK_TRIANGLE
      : shape == TessellationShape::Quadrilateral ? VTK_QUAD
                                                  : VTK_HEXAHEDRON;
  }

  template <typename Do>
  void ForCells(const Do& visit) const
  {
    for (const Part& part : this->Parts)
    {
      ForRows(part.Mesh.Shapes.size(), this->Threads,
        [&](std::size_t c) { visit(part, c, part.FirstCell + c); });
    }
  }

  std::vector<Part> Parts;
};

/// What the processes tell each other while they make a part each: once in every dimension.
class PartExchange
{
public:
  std::vector<double> operator()(const std::vector<double>& own)
  {
    this->IsDone = true;
    std::vector<double> all;
    for (const std::vector<double>& values : knotwork::Processes::Exchange(own))
    {
      all.insert(all.end(), values.begin(), values.end());
    }
    return all;
  }
  /// For those that wait, though this one has nothing to tell.
  void Finish()
  {
    if (!this->IsDone)
    {
      (*this)({});
    }
  }

private:
  bool IsDone = false;
};

/// The outcome of what all processes do at once.
Status InAll(const std::function<Status(PartExchange&)>& work)
{
  PartExchange exchange;
  Status own;
  try
  {
    own = work(exchange);
  }
  catch (...)
  {
    own = knotwork::StatusOfException();
  }
  exchange.Finish();
  return knotwork::Processes::Agree(own);
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
  auto mesh = knotwork::Tessellate<Dim>(forms, params);
  if (mesh)
  {
    block.Add(std::move(mesh.Value), std::move(patchIndex), Dim);
  }
  return mesh.Status;
}

void TakeCells(BlockMesh& block, vtkDataSet* output)
{
  if (auto* polygons = vtkPolyData::SafeDownCast(output))
  {
    polygons->SetLines(block.TakeCells(true, false));
    polygons->SetPolys(block.TakeCells(false, true));
    return;
  }
  vtkUnstructuredGrid::SafeDownCast(output)->SetCells(block.Types(), block.TakeCells(true, true));
}

void SetCellData(const BlockMesh& block, const std::vector<const SplinePatch*>& patches,
  vtkUnstructuredGrid* source, vtkDataSet* output)
{
  std::array<vtkSmartPointer<vtkIntArray>, 3> ids;
  const std::array<const char*, 3> names{ "PatchId", "ElementId", "Level" };
  for (std::size_t i = 0; i < ids.size(); ++i)
  {
    ids[i] = NamedArray<vtkIntArray>(names[i], 1, block.NumCells);
    output->GetCellData()->AddArray(ids[i]);
  }
  std::vector<vtkIdType> sourceCells(source ? block.NumCells : 0);
  block.ForCellElements(
    [&](std::size_t p, int element, std::size_t cell)
    {
      const SplinePatch& patch = *patches[p];
      const auto e = static_cast<std::size_t>(element);
      const auto at = static_cast<vtkIdType>(cell);
      ids[0]->SetValue(at, patch.Id);
      ids[1]->SetValue(at, element);
      ids[2]->SetValue(at,
        std::visit(
          [&](const auto& spline) { return spline.Space->Elements[e].Level; }, patch.Geometry));
      if (source)
      {
        sourceCells[cell] = e < patch.Cells.size() ? patch.Cells[e] : -1;
      }
    });
  if (source)
  {
    knotwork::PassCellData(source, sourceCells, output);
  }
}

/// What fields are evaluated at.
struct PointPlaces
{
  vtkSmartPointer<vtkIntArray> Elements;
  vtkSmartPointer<vtkDoubleArray> Local;
};

/// Values of the fields of one patch at its points; patches without a field leave zeros.
template <int Dim>
Status EvaluateFields(const PointPlaces& places, const SplinePatch& patch,
  const std::vector<vtkIdType>& points, const knotwork::Spline<Dim>& geometry, int threads,
  const std::map<std::string, vtkSmartPointer<vtkDoubleArray>>& fields)
{
  std::vector<int> elements;
  PointMatrix local(static_cast<Eigen::Index>(points.size()), Dim);
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    elements.push_back(places.Elements->GetValue(points[k]));
    for (int d = 0; d < Dim; ++d)
    {
      local(static_cast<Eigen::Index>(k), d) = places.Local->GetTypedComponent(points[k], d);
    }
  }
  knotwork::EvaluationParams params;
  params.Threads = threads;
  for (const knotwork::SplineField& field : patch.Fields)
  {
    const auto components = static_cast<int>(field.Coefficients.cols());
    vtkDoubleArray* values = fields.at(field.Name);
    if (values->GetNumberOfComponents() != components)
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
    for (std::size_t k = 0; k < points.size(); ++k)
    {
      for (int c = 0; c < components; ++c)
      {
        values->SetTypedComponent(points[k], c, batch.Values(static_cast<Eigen::Index>(k), c));
      }
    }
  }
  return {};
}

Status SetPointData(
  BlockMesh& block, const std::vector<const SplinePatch*>& patches, vtkDataSet* output)
{
  const auto patchId = NamedArray<vtkIntArray>("PatchId", 1, block.NumPoints);
  const PointPlaces places{ NamedArray<vtkIntArray>("ElementId", 1, block.NumPoints),
    block.Take("LocalParameters", &TessellationMesh::PointLocal) };
  block.ForPointElements(
    [&](std::size_t patch, int element, std::size_t point)
    {
      patchId->SetValue(static_cast<vtkIdType>(point), patches[patch]->Id);
      places.Elements->SetValue(static_cast<vtkIdType>(point), element);
    });

  // every part has the arrays of all, though patches with them may have no point in it
  std::map<std::string, vtkSmartPointer<vtkDoubleArray>> fields;
  std::vector<bool> hasFields;
  for (const SplinePatch* patch : patches)
  {
    hasFields.push_back(!patch->Fields.empty());
    for (const knotwork::SplineField& field : patch->Fields)
    {
      auto& values = fields[field.Name];
      if (!values)
      {
        values = NamedArray<vtkDoubleArray>(
          field.Name.c_str(), static_cast<int>(field.Coefficients.cols()), block.NumPoints);
        values->Fill(0.0);
      }
    }
  }
  const auto points = block.PointsOf(hasFields);
  for (std::size_t p = 0; p < patches.size(); ++p)
  {
    const Status status = std::visit([&](const auto& geometry)
      { return EvaluateFields(places, *patches[p], points[p], geometry, block.Threads, fields); },
      patches[p]->Geometry);
    if (!status)
    {
      return status;
    }
  }
  vtkPointData* arrays = output->GetPointData();
  for (const auto& [name, values] : fields)
  {
    arrays->AddArray(values);
  }
  if (block.HasNormals())
  {
    arrays->SetNormals(block.Take("Normals", &TessellationMesh::Normals));
  }
  arrays->AddArray(patchId);
  arrays->AddArray(places.Elements);
  arrays->AddArray(places.Local);
  return {};
}
}

vtkSplineTessellate::vtkSplineTessellate()
{
  knotwork::KeepReferenceSystem(this);
}

void vtkSplineTessellate::SetPart(int part, int parts, bool together)
{
  this->Part = part;
  this->Parts = parts;
  this->Together = together;
  this->Modified();
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
  knotwork::Result<knotwork::SplineModel> model;
  const auto decode = [&](PartExchange&)
  {
    model = this->DecodeInput(input);
    return model.Status;
  };
  PartExchange none;
  if (Status status = this->Together ? InAll(decode) : decode(none); !status)
  {
    return status;
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
      params.Part = this->Part;
      params.Parts = this->Parts;
      params.Threads = this->KernelThreads();
      params.Progress = this->Progress();
      BlockMesh block(params.Threads);
      Status status;
      const auto tessellate = [&](const auto& dimension)
      {
        constexpr int dim = std::decay_t<decltype(dimension)>::value;
        if (!status || !this->Together)
        {
          return status ? TessellateDimension<dim>(patches, params, block) : status;
        }
        return InAll(
          [&](PartExchange& exchange)
          {
            params.Exchange = std::ref(exchange);
            return TessellateDimension<dim>(patches, params, block);
          });
      };
      status = tessellate(std::integral_constant<int, 1>());
      status = tessellate(std::integral_constant<int, 2>());
      status = tessellate(std::integral_constant<int, 3>());
      if (!status)
      {
        return status;
      }
      vtkNew<vtkPoints> points;
      points->SetData(block.Take("Points", &TessellationMesh::Points));
      vtkPointSet::SafeDownCast(output)->SetPoints(points);
      TakeCells(block, output);
      SetCellData(block, patches, source, output);
      status = SetPointData(block, patches, output);
      if (this->Parts > 1)
      {
        output->GetPointData()->SetGlobalIds(block.PointNumbers());
        output->GetFieldData()->AddArray(block.PointsByDimension());
      }
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
