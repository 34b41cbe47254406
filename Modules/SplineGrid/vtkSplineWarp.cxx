// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineWarp.h"

#include "SplineBlocks.h"
#include "SplineModel.h"
#include <knotwork/SplineCore/BezierProjection.h>
#include <knotwork/SplineCore/Composition.h>
#include <knotwork/SplineCore/Numbers.h>

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <map>

using knotwork::ErrorCode;
using knotwork::PointMatrix;
using knotwork::Spline;
using knotwork::SplineModel;
using knotwork::SplinePatch;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineWarp);

namespace
{
/// The map as a function of points.
struct Map
{
  SplineModel Model;
  knotwork::PointMap Function;
  Status Outcome;

  Map(vtkDataObject* data, int patchId, bool clamp, int threads)
  {
    auto decoded = knotwork::DecodeSplineModel(data, threads);
    this->Outcome = decoded.Status;
    if (!decoded)
    {
      return;
    }
    this->Model = std::move(decoded.Value);
    const SplinePatch* chosen = nullptr;
    for (const SplinePatch& patch : this->Model.Patches)
    {
      if (patchId < 0 ? this->Model.Patches.size() == 1 : patch.Id == patchId)
      {
        chosen = &patch;
      }
    }
    if (!chosen)
    {
      this->Outcome = { this->Model.Patches.empty() ? ErrorCode::EmptyInput
                                                    : ErrorCode::InvalidParameter,
        patchId < 0 ? "the map has " + std::to_string(this->Model.Patches.size()) +
            " patches; choose one by MapPatchId"
                    : "the map has no patch " + std::to_string(patchId) };
      return;
    }
    std::visit(
      [this, clamp, threads](const auto& spline)
      {
        if (!spline.Space->HasDomain())
        {
          this->Outcome = { ErrorCode::DimensionMismatch,
            "the map is a Bezier grid without a parameter domain" };
          return;
        }
        // one thread inside: the composition calls it from several
        this->Function = [form = knotwork::MakeBezierForm(spline, threads), clamp](
                           const PointMatrix& points, PointMatrix& values)
        { return knotwork::MapPoints(form, points, clamp, 1, values); };
      },
      chosen->Geometry);
  }
};

Status WarpPoints(vtkPointSet* input, const Map& map, vtkPointSet* output)
{
  PointMatrix points(input->GetNumberOfPoints(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
  {
    input->GetPoint(i, points.row(i).data());
  }
  PointMatrix values;
  if (Status status = map.Function(points, values); !status)
  {
    return status;
  }
  output->ShallowCopy(input);
  vtkNew<vtkPoints> moved;
  moved->SetDataTypeToDouble();
  moved->SetNumberOfPoints(points.rows());
  for (Eigen::Index i = 0; i < values.rows(); ++i)
  {
    moved->SetPoint(i, values.row(i).data());
  }
  output->SetPoints(moved);
  output->GetPointData()->SetNormals(nullptr);
  return {};
}

/// Cells of the old patch under the elements of the new one.
template <int Dim>
std::vector<vtkIdType> OldCells(const SplinePatch& patch, const knotwork::SplineSpace<Dim>& old,
  const knotwork::SplineSpace<Dim>& space)
{
  if (!old.HasDomain())
  {
    return patch.Cells;
  }
  std::vector<vtkIdType> cells;
  for (const auto& element : space.Elements)
  {
    std::array<double, Dim> middle;
    std::array<double, Dim> local;
    for (std::size_t d = 0; d < Dim; ++d)
    {
      middle[d] = 0.5 * (element.Box.Lower[d] + element.Box.Upper[d]);
    }
    const int e = old.Locate(middle.data(), local.data());
    cells.push_back(patch.Cells[static_cast<std::size_t>(e)]);
  }
  return cells;
}

/// A field of the old patch in the new space.
template <int Dim>
knotwork::Result<Spline<Dim>> MoveField(Spline<Dim> old, const PointMatrix& coefficients,
  const knotwork::SplineSpacePtr<Dim>& space, int threads)
{
  if (space == old.Space && !old.IsRational())
  {
    Spline<Dim> same{ space, coefficients, {} };
    return same;
  }
  old.ControlPoints = coefficients;
  const auto form = knotwork::MakeBezierForm(old, threads);
  knotwork::ProjectionParams params;
  params.Threads = threads;
  const bool domain = space->HasDomain();
  return knotwork::ProjectOntoSpace<Dim>(
    space, old.NumComponents(),
    [&form, domain](
      int element, const PointMatrix& local, const PointMatrix& parameters, PointMatrix& values)
    {
      knotwork::EvaluationBatch batch;
      const std::vector<int> elements(static_cast<std::size_t>(local.rows()), element);
      const Status status = domain
        ? knotwork::EvaluateParameters(form, parameters, { 0, 1 }, batch)
        : knotwork::EvaluateElements(form, elements, local, { 0, 1 }, batch);
      values = batch.Values;
      return static_cast<bool>(status);
    },
    params);
}

/// Composes the patches with Dim parameters; distances by patch of the model.
template <int Dim>
Status ComposePatches(SplineModel& model, const knotwork::PointMap& map,
  const knotwork::CompositionParams& params, std::map<std::pair<int, int>, double>& distances)
{
  std::vector<Spline<Dim>> inner;
  std::vector<SplinePatch*> patches;
  for (SplinePatch& patch : model.Patches)
  {
    if (const auto* spline = std::get_if<Spline<Dim>>(&patch.Geometry))
    {
      inner.push_back(*spline);
      patches.push_back(&patch);
    }
  }
  if (inner.empty())
  {
    return {};
  }
  auto result = knotwork::ComposeSplines<Dim>(inner, 3, map, params);
  if (!result)
  {
    return result.Status;
  }
  for (std::size_t k = 0; k < patches.size(); ++k)
  {
    SplinePatch& patch = *patches[k];
    Spline<Dim>& image = result->Patches[k];
    for (knotwork::SplineField& field : patch.Fields)
    {
      auto moved = MoveField<Dim>(inner[k], field.Coefficients, image.Space, params.Threads);
      if (!moved)
      {
        return moved.Status;
      }
      field.Coefficients = std::move(moved.Value.ControlPoints);
    }
    patch.Cells = OldCells<Dim>(patch, *inner[k].Space, *image.Space);
    patch.Geometry = std::move(image);
    distances[{ patch.Block, patch.Id }] = result->Distances[k];
  }
  return {};
}

/// Passes the cell arrays of the block's source and adds Distance. Cells of an encoded grid stand
/// patch by patch in the order of the model.
void AddCellArrays(const SplineModel& model, int block, vtkUnstructuredGrid* source,
  const std::map<std::pair<int, int>, double>& distances, vtkUnstructuredGrid* output)
{
  std::vector<vtkIdType> cells;
  vtkNew<vtkDoubleArray> distance;
  distance->SetName("Distance");
  for (const SplinePatch& patch : model.Patches)
  {
    if (patch.Block == block)
    {
      cells.insert(cells.end(), patch.Cells.begin(), patch.Cells.end());
      for (std::size_t e = 0; e < patch.Cells.size(); ++e)
      {
        distance->InsertNextValue(distances.at({ block, patch.Id }));
      }
    }
  }
  knotwork::PassCellData(source, cells, output);
  output->GetCellData()->AddArray(distance);
}
}

vtkSplineWarp::vtkSplineWarp()
{
  this->SetInputTypes({ { { "vtkPointSet", "vtkPartitionedDataSetCollection" } }, Splines() });
}

int vtkSplineWarp::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutputLike(outputs, 0, vtkDataObject::GetData(inputs[0], 0));
  return 1;
}

Status vtkSplineWarp::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0], 0);
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  auto* points = vtkPointSet::SafeDownCast(input);
  if (points && points->GetNumberOfPoints() == 0)
  {
    return {};
  }
  const Map map(this->WholeInput(inputs), this->MapPatchId, this->Clamp, this->KernelThreads());
  if (!map.Outcome)
  {
    return { map.Outcome.Code, "map: " + map.Outcome.Detail };
  }
  if (!knotwork::HoldsSplines(input))
  {
    return WarpPoints(points, map, vtkPointSet::SafeDownCast(output));
  }

  auto decoded = this->DecodeInput(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  SplineModel& model = decoded.Value;
  knotwork::CompositionParams params;
  params.Tolerance = this->Tolerance;
  params.MaxLevel = this->MaxLevel;
  params.MaxFunctions = this->MaximumFunctions;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  std::map<std::pair<int, int>, double> distances;
  Status status = ComposePatches<1>(model, map.Function, params, distances);
  status = status ? ComposePatches<2>(model, map.Function, params, distances) : status;
  status = status ? ComposePatches<3>(model, map.Function, params, distances) : status;
  status = status ? knotwork::EncodeSplineModel(model, input, output) : status;
  if (!status)
  {
    return status;
  }
  double largest = 0.0;
  for (const auto& [patch, distance] : distances)
  {
    largest = std::max(largest, distance);
  }
  if (this->Tolerance > 0.0 && largest > this->Tolerance)
  {
    this->ReportWarnings({ "the distance to the composition is " + knotwork::Digits(largest) +
      ", above the tolerance " + knotwork::Digits(this->Tolerance) + ": raise MaxLevel" });
  }
  const auto sources = knotwork::GridsByBlock(input);
  const auto results = knotwork::GridsByBlock(output);
  for (const auto& [block, grid] : results)
  {
    if (grid->GetNumberOfCells() > 0)
    {
      AddCellArrays(model, block, sources.at(block), distances, grid);
    }
  }
  return {};
}
