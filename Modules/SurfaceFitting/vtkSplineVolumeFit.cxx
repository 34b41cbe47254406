// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineVolumeFit.h"

#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceFitting/VolumeFit.h>

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

using knotwork::ErrorCode;
using knotwork::Status;

vtkStandardNewMacro(vtkSplineVolumeFit);

namespace
{
const char* DescribeEnd(knotwork::FitEnd end)
{
  switch (end)
  {
    case knotwork::FitEnd::Iterations:
      return "the limit of iterations is reached; allow more";
    case knotwork::FitEnd::Functions:
      return "the limit of functions is reached; allow more, or choose a tolerance above the noise";
    default:
      return "elements are not split any smaller; choose a larger tolerance";
  }
}

void EncodeIterations(const knotwork::VolumeFit& fit, vtkTable* output)
{
  using Row = const knotwork::VolumeFitIteration&;
  const auto whole = [&](const char* name, auto value)
  { output->AddColumn(knotwork::ArrayOf<vtkIdTypeArray>(name, fit.Iterations, value)); };
  const auto real = [&](const char* name, auto value)
  { output->AddColumn(knotwork::ArrayOf<vtkDoubleArray>(name, fit.Iterations, value)); };
  output->AddColumn(knotwork::ArrayOf<vtkStringArray>(
    "Method", fit.Iterations, [](Row r) { return r.LeastSquares ? "least-squares" : "mba"; }));
  whole("Functions", [](Row r) { return static_cast<vtkIdType>(r.NumFunctions); });
  whole("Elements", [](Row r) { return static_cast<vtkIdType>(r.NumElements); });
  real("MaxError", [](Row r) { return r.MaxError; });
  real("RmsError", [](Row r) { return r.RmsError; });
  whole("PointsOutside", [](Row r) { return static_cast<vtkIdType>(r.NumOutside); });
}
}

vtkSplineVolumeFit::vtkSplineVolumeFit()
{
  this->SetInputTypes({ { { "vtkPointSet" } } });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkPointSet", "vtkTable" });
}

int vtkSplineVolumeFit::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutputLike(outputs, 1, vtkDataObject::GetData(inputs[0], 0));
  return this->MakeDeclaredOutputs(outputs);
}

Status vtkSplineVolumeFit::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  if (Status sampled = knotwork::CheckSampledPoints(input, "the input"); !sampled)
  {
    return sampled;
  }
  vtkInformation* asked = this->GetInputArrayInformation(0);
  const char* name = asked->Get(vtkDataObject::FIELD_NAME());
  vtkDataArray* array = name && name[0] != '\0' ? input->GetPointData()->GetArray(name)
                                                : input->GetPointData()->GetScalars();
  if (!array)
  {
    return { ErrorCode::InvalidParameter,
      name && name[0] != '\0' ? "there is no point array '" + std::string(name) + "' of numbers"
                              : "there is no array of values; name a point array" };
  }
  const vtkIdType n = input->GetNumberOfPoints();
  if (array->GetNumberOfTuples() != n)
  {
    return { ErrorCode::SizeMismatch,
      "the array of values has " + std::to_string(array->GetNumberOfTuples()) + " rows for " +
        std::to_string(n) + " points" };
  }
  knotwork::VolumeCloud cloud;
  cloud.Points.resize(n, 3);
  cloud.Values.resize(n, array->GetNumberOfComponents());
  for (vtkIdType i = 0; i < n; ++i)
  {
    input->GetPoint(i, &cloud.Points(i, 0));
    array->GetTuple(i, &cloud.Values(i, 0));
  }
  knotwork::VolumeFitParams params;
  params.Space = static_cast<knotwork::FitSpace>(this->Space);
  params.Degree = this->Degree;
  params.NumInitialElements.fill(this->InitialElements);
  params.Method = static_cast<knotwork::FitMethod>(this->Method);
  params.SwitchIteration = this->SwitchIteration;
  params.Smoothing = this->Smoothing;
  params.Tolerance = this->Tolerance;
  params.MaxIterations = this->MaximumIterations;
  params.MaxFunctions = this->MaximumFunctions;
  params.Strategy = static_cast<knotwork::LRStrategy>(this->Strategy);
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  auto fit = knotwork::FitVolume(cloud, params);
  if (!fit)
  {
    return fit.Status;
  }
  if (!fit->WithinTolerance)
  {
    const knotwork::VolumeFitIteration& last = fit->Iterations.back();
    this->ReportWarnings({ std::to_string(last.NumOutside) + " of " + std::to_string(n) +
      " points are farther away than the tolerance of " + knotwork::Digits(fit->Tolerance) +
      ", by a largest distance of " + knotwork::Digits(last.MaxError) + ": " +
      DescribeEnd(fit->End) });
  }
  vtkPointSet* points = vtkPointSet::GetData(outputs, 1);
  points->ShallowCopy(input);
  points->GetPointData()->AddArray(knotwork::ArrayOf<vtkDoubleArray>(
    "Distance", fit->Distances, [](double distance) { return distance; }));
  EncodeIterations(fit.Value, vtkTable::GetData(outputs, 2));
  knotwork::SplinePatch patch;
  patch.Fields.push_back(
    { array->GetName() ? array->GetName() : "Values", std::move(fit->Volume.ControlPoints) });
  fit->Volume.ControlPoints = std::move(fit->DomainPoints);
  patch.Geometry = std::move(fit->Volume);
  knotwork::SplineModel model;
  model.Patches.push_back(std::move(patch));
  return knotwork::EncodeSplineGrid(model, vtkUnstructuredGrid::GetData(outputs));
}
