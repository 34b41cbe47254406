// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineCombine.h"

#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/PatchFields.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>
#include <knotwork/SurfaceFitting/CombineSplines.h>

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkObjectFactory.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <set>

using knotwork::CombinedSurface;
using knotwork::ErrorCode;
using knotwork::Result;
using knotwork::Spline;
using knotwork::SplinePatch;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineCombine);

namespace
{
/// Surface patches in the order of their ids.
Status TakeSurfaces(vtkDataObject* data, const std::string& name, int threads,
  std::vector<SplinePatch>& patches, std::vector<std::string>& warnings)
{
  auto decoded = knotwork::DecodeSplineModel(data, threads);
  if (!decoded)
  {
    return { decoded.Status.Code, name + ": " + decoded.Status.Detail };
  }
  warnings.insert(warnings.end(), decoded->Warnings.begin(), decoded->Warnings.end());
  patches = std::move(decoded->Patches);
  std::stable_sort(patches.begin(), patches.end(),
    [](const SplinePatch& a, const SplinePatch& b) { return a.Id < b.Id; });
  for (const SplinePatch& patch : patches)
  {
    if (!std::holds_alternative<Spline<2>>(patch.Geometry))
    {
      return { ErrorCode::DimensionMismatch,
        name + ": patch " + std::to_string(patch.Id) + " is not a surface" };
    }
  }
  return {};
}

/// Leaves the fields that both patches have, in one order; the names of the others are added.
void ShareFields(SplinePatch& a, SplinePatch& b, std::set<std::string>& dropped)
{
  const auto less = [](const knotwork::SplineField& x, const knotwork::SplineField& y)
  { return x.Name < y.Name; };
  std::sort(a.Fields.begin(), a.Fields.end(), less);
  std::sort(b.Fields.begin(), b.Fields.end(), less);
  const auto keep = [&](SplinePatch& patch, const SplinePatch& other)
  {
    const auto lacks = [&](const knotwork::SplineField& field)
    {
      const bool found = std::any_of(other.Fields.begin(), other.Fields.end(),
        [&](const knotwork::SplineField& x)
        { return x.Name == field.Name && x.Coefficients.cols() == field.Coefficients.cols(); });
      if (!found)
      {
        dropped.insert(field.Name);
      }
      return !found;
    };
    patch.Fields.erase(
      std::remove_if(patch.Fields.begin(), patch.Fields.end(), lacks), patch.Fields.end());
  };
  keep(a, b);
  keep(b, a);
}

/// The first patch becomes both of them combined.
Result<CombinedSurface> CombinePatches(
  SplinePatch& a, const SplinePatch& b, const knotwork::SurfaceCombination& combination)
{
  auto combined = CombineSurfaces(JoinFields(std::get<Spline<2>>(a.Geometry), a.Fields),
    JoinFields(std::get<Spline<2>>(b.Geometry), b.Fields), combination);
  if (!combined)
  {
    return { combined.Status.Code,
      "patch " + std::to_string(a.Id) + ": " + combined.Status.Detail };
  }
  if (combined->HasDifference)
  {
    const auto rows = combined->Value.ControlPoints.rows();
    a.Fields.insert(a.Fields.begin(), { "Difference", knotwork::PointMatrix(rows, 3) });
  }
  SeparateFields(combined->Value, a);
  a.Block = 0;
  a.Cells.clear();
  return combined;
}

/// Rows of the table of patches.
struct PatchTable
{
  vtkSmartPointer<vtkIntArray> Ids = knotwork::NamedArray<vtkIntArray>("PatchId");
  vtkSmartPointer<vtkIntArray> Functions = knotwork::NamedArray<vtkIntArray>("Functions");
  vtkSmartPointer<vtkDoubleArray> Lower = knotwork::NamedArray<vtkDoubleArray>("MinBound");
  vtkSmartPointer<vtkDoubleArray> Upper = knotwork::NamedArray<vtkDoubleArray>("MaxBound");

  void Add(int id, const CombinedSurface& combined)
  {
    this->Ids->InsertNextValue(id);
    this->Functions->InsertNextValue(combined.Value.Space->NumFunctions);
    this->Lower->InsertNextValue(combined.Lower);
    this->Upper->InsertNextValue(combined.Upper);
  }

  void Encode(vtkTable* table)
  {
    table->AddColumn(this->Ids);
    table->AddColumn(this->Functions);
    table->AddColumn(this->Lower);
    table->AddColumn(this->Upper);
  }
};
}

vtkSplineCombine::vtkSplineCombine()
{
  this->SetInputTypes({ Splines(), Splines() });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkTable" });
  knotwork::KeepReferenceSystem(this);
}

void vtkSplineCombine::SetSecondConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkSplineCombine::SetSecondData(vtkDataObject* surface)
{
  this->SetInputDataObject(1, surface);
}

Status vtkSplineCombine::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int threads = this->KernelThreads();
  knotwork::SplineModel model;
  std::vector<SplinePatch> second;
  std::vector<std::string> warnings;
  Status status = TakeSurfaces(
    vtkDataObject::GetData(inputs[0], 0), "first surface", threads, model.Patches, warnings);
  status = status ? TakeSurfaces(vtkDataObject::GetData(inputs[1], 0), "second surface", threads,
                      second, warnings)
                  : status;
  if (status && model.Patches.size() != second.size())
  {
    status = { ErrorCode::SizeMismatch,
      "the first input has " + std::to_string(model.Patches.size()) + " patches, the second " +
        std::to_string(second.size()) };
  }
  if (!status)
  {
    return status;
  }

  knotwork::SurfaceCombination combination;
  combination.Mode = static_cast<knotwork::CombineMode>(this->Mode);
  combination.Weights = { this->FirstWeight, this->SecondWeight };
  combination.CommonDomain = this->CommonDomain;
  combination.MaxFunctions = this->MaximumFunctions;
  combination.Threads = threads;
  const knotwork::ProgressCallback progress = this->Progress();
  std::set<std::string> dropped;
  PatchTable table;
  for (std::size_t p = 0; p < second.size(); ++p)
  {
    if (!progress(static_cast<double>(p) / static_cast<double>(second.size())))
    {
      return { ErrorCode::Aborted, "" };
    }
    SplinePatch& patch = model.Patches[p];
    ShareFields(patch, second[p], dropped);
    const auto combined = CombinePatches(patch, second[p], combination);
    if (!combined)
    {
      return combined.Status;
    }
    table.Add(patch.Id, combined.Value);
  }
  for (const std::string& name : dropped)
  {
    warnings.push_back("the point array '" + name + "' is not in both inputs and does not pass");
  }
  this->ReportWarnings(warnings);
  table.Encode(vtkTable::GetData(outputs, 1));
  return knotwork::EncodeSplineGrid(model, vtkUnstructuredGrid::GetData(outputs, 0));
}
