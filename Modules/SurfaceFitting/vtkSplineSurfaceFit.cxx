// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineSurfaceFit.h"

#include "FitData.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>
#include <knotwork/SplineGrid/SplineModel.h>

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <cstring>

vtkStandardNewMacro(vtkSplineSurfaceFit);

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
    case knotwork::FitEnd::Seconds:
      return "the limit of time is reached; allow more";
    case knotwork::FitEnd::Criterion:
      return "the information criterion has ended the fit; without it the fit goes on";
    case knotwork::FitEnd::Contradiction:
      return "they contradict points in the same place; leave points out, find outliers, or choose "
             "a larger tolerance";
    case knotwork::FitEnd::HeldEdges:
      return "they lie on edges of the start surface that are held; let these go, or leave points "
             "out";
    default:
      return "elements are not split any smaller; allow smaller elements, or choose a larger "
             "tolerance";
  }
}

std::string DescribeMiss(const knotwork::SurfaceFit& fit)
{
  return std::to_string(fit.Final.NumOutside) + " of " + std::to_string(fit.Distances.size()) +
    " points are farther away than their tolerance, by a largest distance of " +
    knotwork::Digits(fit.Final.MaxError) + ": " + DescribeEnd(fit.End);
}
}

vtkSplineSurfaceFit::vtkSplineSurfaceFit()
{
  this->SetInputTypes({ { { "vtkPointSet" } }, Optional(Splines()) });
  this->SetOutputTypes(
    { "vtkUnstructuredGrid", "vtkPointSet", "vtkTable", "vtkImageData", "vtkPolyData" });
  knotwork::KeepReferenceSystem(this);
}

void vtkSplineSurfaceFit::SetStartConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

void vtkSplineSurfaceFit::SetStartData(vtkDataObject* surface)
{
  this->SetInputDataObject(1, surface);
}

void vtkSplineSurfaceFit::AddFieldArray(const char* name)
{
  if (name && name[0] != '\0')
  {
    this->FieldArrays.emplace_back(name);
    this->Modified();
  }
}

void vtkSplineSurfaceFit::ClearFieldArrays()
{
  if (!this->FieldArrays.empty())
  {
    this->FieldArrays.clear();
    this->Modified();
  }
}

void vtkSplineSurfaceFit::AddToleranceBox(
  double u0, double u1, double v0, double v1, double tolerance)
{
  this->ToleranceBoxes.push_back({ u0, u1, v0, v1, tolerance });
  this->Modified();
}

void vtkSplineSurfaceFit::ClearToleranceBoxes()
{
  if (!this->ToleranceBoxes.empty())
  {
    this->ToleranceBoxes.clear();
    this->Modified();
  }
}

int vtkSplineSurfaceFit::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutputLike(outputs, 1, vtkDataObject::GetData(inputs[0], 0));
  return this->MakeDeclaredOutputs(outputs);
}

knotwork::Status vtkSplineSurfaceFit::FindArray(
  int index, const char* what, vtkInformationVector** inputs, vtkDataArray*& array)
{
  vtkInformation* info = this->GetInputArrayInformation(index);
  const char* name = info->Get(vtkDataObject::FIELD_NAME());
  const bool isNone =
    !name || name[0] == '\0' || std::strcmp(name, "None") == 0; // as ParaView says
  if (isNone && !info->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()))
  {
    return {};
  }
  int association = vtkDataObject::POINT;
  array = this->GetInputArrayToProcess(index, inputs, association);
  if (!array || association != vtkDataObject::POINT)
  {
    array = nullptr;
    return { knotwork::ErrorCode::InvalidParameter,
      std::string(what) + ": there is no point array " +
        (name ? "'" + std::string(name) + "'" : "of this attribute") +
        " of numbers; check the name" };
  }
  return {};
}

knotwork::Status vtkSplineSurfaceFit::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using namespace knotwork;
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  if (Status sampled = CheckSampledPoints(input, "the input"); !sampled)
  {
    return sampled;
  }
  CloudChoice choice;
  SplineModel startModel;
  if (vtkDataObject* data = vtkDataObject::GetData(inputs[1], 0))
  {
    auto model = this->DecodeInput(data);
    if (!model)
    {
      return { model.Status.Code, "the start: " + model.Status.Detail };
    }
    startModel = std::move(model.Value);
    const auto start = FindStart(startModel);
    if (!start)
    {
      return start.Status;
    }
    choice.Start = start.Value;
  }
  else if (this->HoldEdges != NO_EDGES)
  {
    return { ErrorCode::InvalidParameter,
      "there are no edges to hold: the edges of a start surface are held; give one as the second "
      "input, or HoldEdges None" };
  }
  choice.Parameters = static_cast<CloudParameters>(this->Parameterization);
  choice.Fields = this->FieldArrays;
  choice.AllFields = this->AllFields;
  choice.RefuseLayers = this->Side == BOTH_SIDES;
  choice.Threads = this->KernelThreads();
  choice.Progress = this->Progress();
  Status status;
  if (choice.Parameters == CloudParameters::Given)
  {
    status = this->FindArray(0, "parameters", inputs, choice.Given);
    choice.Given = choice.Given || !status ? choice.Given : input->GetPointData()->GetArray("UV");
    choice.Given = choice.Given || !status ? choice.Given : input->GetPointData()->GetTCoords();
  }
  status = status ? this->FindArray(1, "tolerances", inputs, choice.Tolerances) : status;
  status = status ? this->FindArray(2, "significant points", inputs, choice.Significant) : status;
  if (!status)
  {
    return status;
  }
  Result<DecodedCloud> decoded = DecodeCloud(input, choice);
  if (!decoded)
  {
    return decoded.Status;
  }
  FitParams params;
  if (choice.Start)
  {
    auto start = MakeStart(startModel, decoded.Value, choice.Threads);
    if (!start)
    {
      return start.Status;
    }
    for (std::size_t side = 0; side < 4; ++side)
    {
      start->Edges[side] =
        this->HeldSides[side] != 0 ? static_cast<FitEdge>(this->HoldEdges) : FitEdge::Free;
    }
    params.Start = std::move(start.Value);
  }
  params.Space = static_cast<FitSpace>(this->Space);
  params.Degree = { this->Degree, this->SecondDegree > 0 ? this->SecondDegree : this->Degree };
  params.NumInitialElements = { this->InitialElementsU, this->InitialElementsV };
  params.Domain = { { this->Domain[0], this->Domain[2] }, { this->Domain[1], this->Domain[3] } };
  params.NumMeasured = decoded->NumMeasured;
  params.CorrectParameters = this->CorrectParameters && this->Parameterization != HEIGHT_FIELD;
  params.Method = static_cast<FitMethod>(this->Method);
  params.SwitchIteration = this->SwitchIteration;
  params.Smoothing = this->Smoothing;
  params.SignificantWeight = this->SignificantWeight;
  params.Tolerance = this->Tolerance;
  params.ToleranceFactorAbove = this->ToleranceFactorAbove;
  params.ToleranceFactorBelow = this->ToleranceFactorBelow;
  for (const auto& [u0, u1, v0, v1, tolerance] : this->ToleranceBoxes)
  {
    params.ToleranceBoxes.push_back({ { { u0, v0 }, { u1, v1 } }, tolerance });
  }
  params.Distance = static_cast<FitDistance>(this->DistanceMode);
  params.DistanceSlope = this->DistanceSlope;
  params.DistanceCentre = { this->DistanceCentre[0], this->DistanceCentre[1] };
  params.Side = static_cast<FitSide>(this->Side);
  params.FindOutliers = this->FindOutliers;
  params.OutlierScale = this->OutlierScale;
  params.OutlierDeviation = static_cast<FitDeviation>(this->OutlierDeviation);
  params.MaxIterations = this->MaximumIterations;
  params.MaxFunctions = this->MaximumFunctions;
  params.MaxSeconds = this->MaximumSeconds;
  params.Criterion = static_cast<FitCriterion>(this->Criterion);
  params.Threshold = static_cast<FitThreshold>(this->Threshold);
  params.ThresholdShare = this->ThresholdShare;
  params.Directions = static_cast<FitDirections>(this->Directions);
  params.Strategy = static_cast<LRStrategy>(this->Strategy);
  params.StrategySwitch = this->StrategySwitch;
  params.LaterStrategy = static_cast<LRStrategy>(this->LaterStrategy);
  params.Independent = this->Independent;
  params.MinElementSize = this->MinimumElementSize;
  params.FeatureGridSize = this->FeatureGridSize;
  params.ElementFeatures = this->ElementFeatures;
  params.FeatureIterations = this->FeatureIterations;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const Result<SurfaceFit> fit = FitSurface(decoded->Cloud, params);
  if (!fit)
  {
    return fit.Status;
  }
  this->Seconds = fit->Iterations.back().Seconds;
  if (!fit->WithinTolerance)
  {
    this->ReportWarnings({ DescribeMiss(fit.Value) });
  }
  vtkPointSet* points = vtkPointSet::GetData(outputs, 1);
  points->ShallowCopy(input);
  EncodeDistances(decoded.Value, fit.Value, points);
  EncodeIterations(fit.Value, vtkTable::GetData(outputs, 2));
  EncodeGridFeatures(fit.Value, vtkImageData::GetData(outputs, 3));
  EncodeElementFeatures(fit.Value, vtkPolyData::GetData(outputs, 4));
  return EncodeFit(decoded.Value, fit.Value, vtkUnstructuredGrid::GetData(outputs));
}
