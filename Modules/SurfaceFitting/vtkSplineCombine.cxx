// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineCombine.h"

#include "BezierForm.h"
#include "CombineSplines.h"
#include "HeightField.h"
#include "NamedArray.h"
#include "PatchFields.h"

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <set>

using knotwork::ErrorCode;
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

bool IsHeight(const SplinePatch& patch, int threads)
{
  return IsHeightField(MakeBezierForm(std::get<Spline<2>>(patch.Geometry), threads));
}
}

vtkSplineCombine::vtkSplineCombine()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

void vtkSplineCombine::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mode: " << this->Mode << "\n";
  os << indent << "FirstWeight: " << this->FirstWeight << "\n";
  os << indent << "SecondWeight: " << this->SecondWeight << "\n";
  os << indent << "CommonDomain: " << this->CommonDomain << "\n";
}

void vtkSplineCombine::SetSecondConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkSplineCombine::SetSecondData(vtkDataObject* surface)
{
  this->SetInputDataObject(1, surface);
}

int vtkSplineCombine::FillInputPortInformation(int, vtkInformation* info)
{
  return this->Superclass::FillInputPortInformation(0, info);
}

int vtkSplineCombine::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkTable");
  return 1;
}

int vtkSplineCombine::RequestDataObject(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return this->MakeDeclaredOutputs(outputs);
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

  const bool isDifference = this->Mode == DIFFERENCE;
  const double weightA = this->Mode == WEIGHTED ? this->FirstWeight : isDifference ? 1.0 : 0.5;
  const double weightB = this->Mode == WEIGHTED ? this->SecondWeight : isDifference ? -1.0 : 0.5;
  const knotwork::ProgressCallback progress = this->Progress();
  std::set<std::string> dropped;
  const auto ids = knotwork::NamedArray<vtkIntArray>("PatchId");
  const auto functions = knotwork::NamedArray<vtkIntArray>("Functions");
  const auto lower = knotwork::NamedArray<vtkDoubleArray>("MinBound");
  const auto upper = knotwork::NamedArray<vtkDoubleArray>("MaxBound");
  for (std::size_t p = 0; p < second.size(); ++p)
  {
    if (!progress(static_cast<double>(p) / static_cast<double>(second.size())))
    {
      return { ErrorCode::Aborted, "" };
    }
    SplinePatch& a = model.Patches[p];
    SplinePatch& b = second[p];
    ShareFields(a, b, dropped);
    const bool heights = IsHeight(a, threads) && IsHeight(b, threads);
    if (isDifference && !heights)
    {
      for (SplinePatch* patch : { &a, &b })
      {
        patch->Fields.insert(patch->Fields.begin(),
          { "Difference", std::get<Spline<2>>(patch->Geometry).ControlPoints });
      }
    }
    knotwork::CombineParams params;
    params.NumKept = heights ? 2 : isDifference ? 3 : 0;
    params.CommonDomain = this->CommonDomain;
    params.Threads = threads;
    const auto combined = CombineSplines(JoinFields(std::get<Spline<2>>(a.Geometry), a.Fields),
      JoinFields(std::get<Spline<2>>(b.Geometry), b.Fields), weightA, weightB, params);
    if (!combined)
    {
      return { combined.Status.Code,
        "patch " + std::to_string(a.Id) + ": " + combined.Status.Detail };
    }
    SeparateFields(combined->Value, a);
    a.Block = 0;
    a.Cells.clear();
    const std::size_t first = heights ? 2 : isDifference ? 3 : 0;
    const std::size_t last = heights || !isDifference ? 3 : 6;
    const auto begin = static_cast<std::ptrdiff_t>(first);
    const auto end = static_cast<std::ptrdiff_t>(last);
    ids->InsertNextValue(a.Id);
    functions->InsertNextValue(combined->Value.Space->NumFunctions);
    lower->InsertNextValue(
      *std::min_element(combined->Lower.begin() + begin, combined->Lower.begin() + end));
    upper->InsertNextValue(
      *std::max_element(combined->Upper.begin() + begin, combined->Upper.begin() + end));
  }
  for (const std::string& name : dropped)
  {
    warnings.push_back("the point array '" + name + "' is not in both inputs and does not pass");
  }
  this->ReportWarnings(warnings);
  vtkTable* table = vtkTable::GetData(outputs, 1);
  table->AddColumn(ids);
  table->AddColumn(functions);
  table->AddColumn(lower);
  table->AddColumn(upper);
  return knotwork::EncodeSplineGrid(model, vtkUnstructuredGrid::GetData(outputs, 0));
}
