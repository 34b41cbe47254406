// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplinePointDistance.h"

#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/MergeTables.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SurfaceFitting/SurfaceDistance.h>

#include "vtkDataObject.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkVariant.h"

#include <cstdlib>
#include <functional>
#include <limits>

using knotwork::ErrorCode;
using knotwork::Status;

vtkStandardNewMacro(vtkSplinePointDistance);

namespace
{
template <typename Array>
void AddPointArray(vtkPointSet* output, const char* name, int components, vtkIdType points,
  const std::function<double(vtkIdType, int)>& value)
{
  const auto array = knotwork::NamedArray<Array>(name, components, points);
  for (vtkIdType i = 0; i < points; ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(i, c, value(i, c));
    }
  }
  output->GetPointData()->AddArray(array);
}

void EncodePoints(
  const knotwork::SurfaceDistances& found, const std::vector<int>& patchIds, vtkPointSet* output)
{
  const vtkIdType n = output->GetNumberOfPoints();
  const auto at = [](const auto& values, vtkIdType i)
  { return values[static_cast<std::size_t>(i)]; };
  AddPointArray<vtkDoubleArray>(
    output, "Distance", 1, n, [&](vtkIdType i, int) { return at(found.Distances, i); });
  AddPointArray<vtkIntArray>(
    output, "DistanceClass", 1, n, [&](vtkIdType i, int) { return at(found.Classes, i); });
  AddPointArray<vtkDoubleArray>(
    output, "SurfacePoint", 3, n, [&](vtkIdType i, int c) { return found.Feet(i, c); });
  AddPointArray<vtkIntArray>(output, "SurfacePatchId", 1, n,
    [&](vtkIdType i, int)
    {
      const int surface = at(found.Surfaces, i);
      return surface < 0 ? -1 : at(patchIds, surface);
    });
  AddPointArray<vtkIntArray>(
    output, "SurfaceElementId", 1, n, [&](vtkIdType i, int) { return at(found.Elements, i); });
  output->GetPointData()->SetActiveScalars("Distance");
}

/// Rows of statistics; columns whose names begin the same in both tables.
void EncodeStatistics(
  const std::vector<knotwork::DistanceStatistics>& rows, std::size_t all, vtkTable* table)
{
  using Row = knotwork::DistanceStatistics;
  const auto add = [&](const char* name, auto get)
  { table->AddColumn(knotwork::ArrayOf<vtkDoubleArray>(name, rows, get)); };
  table->AddColumn(knotwork::ArrayOf<vtkIdTypeArray>(
    "Points", rows, [](const Row& row) { return static_cast<vtkIdType>(row.NumPoints); }));
  add("Share",
    [all](const Row& row)
    { return static_cast<double>(row.NumPoints) / static_cast<double>(all); });
  add("Min", [](const Row& row) { return row.Min; });
  add("Max", [](const Row& row) { return row.Max; });
  add("Mean", [](const Row& row) { return row.Mean; });
  add("MeanAbsolute", [](const Row& row) { return row.MeanAbsolute; });
  add("Rms", [](const Row& row) { return row.Rms; });
}

void EncodeClasses(
  const knotwork::SurfaceDistances& found, const std::vector<double>& tolerances, vtkTable* table)
{
  const auto classes = knotwork::NamedArray<vtkIntArray>("Class");
  const auto lower = knotwork::NamedArray<vtkDoubleArray>("Lower");
  const auto upper = knotwork::NamedArray<vtkDoubleArray>("Upper");
  const auto k = static_cast<int>(tolerances.size());
  const auto limit = [&](int c) // upper end of class c >= 0
  {
    return c < k ? tolerances[static_cast<std::size_t>(c)]
                 : std::numeric_limits<double>::infinity();
  };
  for (const knotwork::DistanceStatistics& row : found.ByClass)
  {
    const int c = std::abs(row.Class);
    classes->InsertNextValue(row.Class);
    const double inner = c == 0 ? -limit(0) : limit(c - 1);
    lower->InsertNextValue(row.Class < 0 ? -limit(c) : inner);
    upper->InsertNextValue(row.Class < 0 ? -inner : limit(c));
  }
  table->AddColumn(classes);
  table->AddColumn(lower);
  table->AddColumn(upper);
  EncodeStatistics(found.ByClass, found.Distances.size(), table);
}
}

vtkSplinePointDistance::vtkSplinePointDistance()
{
  this->SetInputTypes({ { { "vtkPointSet" } }, Splines() });
  this->SetOutputTypes({ "vtkPointSet", "vtkTable", "vtkTable" });
  knotwork::KeepReferenceSystem(this);
}

Status vtkSplinePointDistance::Merge(vtkInformationVector**, vtkInformationVector* outputs)
{
  using knotwork::Merging;
  knotwork::MergedTable how;
  how.Weight = "Points";
  how.Columns = { { "Points", Merging::Sum }, { "PointsWithout", Merging::Sum },
    { "Min", Merging::Least }, { "Max", Merging::Largest }, { "Mean", Merging::Mean },
    { "MeanAbsolute", Merging::Mean }, { "Rms", Merging::QuadraticMean } };
  vtkTable* all = vtkTable::GetData(outputs, 2);
  MergeTables(all, how);
  how.Key = "Class";
  // an empty class has zeros for its extrema, which are none
  vtkTable* classes = vtkTable::GetData(outputs, 1);
  MergeTables(classes, how);
  const double count = all->GetNumberOfRows() == 0 ? 0.0
                                                   : all->GetValueByName(0, "Points").ToDouble() +
      all->GetValueByName(0, "PointsWithout").ToDouble();
  for (vtkTable* table : { classes, all })
  {
    for (vtkIdType row = 0; row < table->GetNumberOfRows(); ++row)
    {
      table->SetValueByName(
        row, "Share", vtkVariant(table->GetValueByName(row, "Points").ToDouble() / count));
    }
  }
  return {};
}

void vtkSplinePointDistance::AddTolerance(double tolerance)
{
  this->Tolerances.push_back(tolerance);
  this->Modified();
}

void vtkSplinePointDistance::ClearTolerances()
{
  if (!this->Tolerances.empty())
  {
    this->Tolerances.clear();
    this->Modified();
  }
}

void vtkSplinePointDistance::SetSurfaceConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkSplinePointDistance::SetSurfaceData(vtkDataObject* surface)
{
  this->SetInputDataObject(1, surface);
}

int vtkSplinePointDistance::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutputLike(outputs, 0, vtkDataObject::GetData(inputs[0], 0));
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkSplinePointDistance::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  vtkPointSet* output = vtkPointSet::GetData(outputs, 0);
  if (input->GetNumberOfPoints() == 0)
  {
    output->ShallowCopy(input);
    return {};
  }
  if (Status sampled = knotwork::CheckSampledPoints(input, "the first input"); !sampled)
  {
    return sampled;
  }
  auto decoded = this->DecodeInput(this->WholeInput(inputs));
  if (!decoded)
  {
    return decoded.Status;
  }
  std::vector<knotwork::Spline<2>> surfaces;
  std::vector<int> patchIds;
  for (const knotwork::SplinePatch& patch : decoded->Patches)
  {
    if (!std::holds_alternative<knotwork::Spline<2>>(patch.Geometry))
    {
      return { ErrorCode::DimensionMismatch,
        "patch " + std::to_string(patch.Id) + " of the second input is not a surface" };
    }
    surfaces.push_back(std::get<knotwork::Spline<2>>(patch.Geometry));
    patchIds.push_back(patch.Id);
  }
  knotwork::PointMatrix points(input->GetNumberOfPoints(), 3);
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    input->GetPoint(i, points.data() + 3 * i);
  }

  knotwork::SurfaceDistanceParams params;
  params.Kind = static_cast<knotwork::DistanceKind>(this->Kind);
  params.Tolerances = this->Tolerances;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto found = knotwork::MeasureSurfaceDistances(points, surfaces, params);
  if (!found)
  {
    return found.Status;
  }

  output->ShallowCopy(input);
  EncodePoints(found.Value, patchIds, output);
  EncodeClasses(found.Value, this->Tolerances, vtkTable::GetData(outputs, 1));
  vtkTable* numbers = vtkTable::GetData(outputs, 2);
  knotwork::AddColumn(numbers, "Kind",
    std::string(found->Kind == knotwork::DistanceKind::Vertical ? "vertical" : "closest"));
  knotwork::AddToRow<vtkIdTypeArray>(
    numbers, "PointsWithout", static_cast<vtkIdType>(found->NumWithout));
  EncodeStatistics({ found->All }, found->Distances.size(), numbers);
  return {};
}
