// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineSurfaceFit.h"

#include "FitData.h"
#include <knotwork/SplineCore/Numbers.h>
#include <knotwork/SplineGrid/Bytes.h>
#include <knotwork/SplineGrid/DistributedInput.h>
#include <knotwork/SplineGrid/InputChecks.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SurfaceFitting/FitProcesses.h>
#include <knotwork/SurfaceFitting/PointLayers.h>

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

#include <algorithm>
#include <cstring>
#include <utility>

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
  return std::to_string(fit.Final.NumOutside) + " of " + std::to_string(fit.NumPoints) +
    " points are farther away than their tolerance, by a largest distance of " +
    knotwork::Digits(fit.Final.MaxError) + ": " + DescribeEnd(fit.End);
}

/// What is fitted along, from the first process with points to those without.
void TellNames(knotwork::DecodedCloud& decoded)
{
  using namespace knotwork;
  const bool hasPoints = decoded.Cloud.Parameters.rows() > 0;
  Bytes own;
  if (hasPoints)
  {
    own.Add(decoded.NumMeasured);
    own.Add(decoded.Components);
    for (const std::string& name : decoded.Names)
    {
      own.Add(name);
    }
  }
  for (const std::string& text : Processes::Exchange(own.Get()))
  {
    if (!hasPoints && !text.empty())
    {
      Bytes told(text);
      decoded.NumMeasured = told.Take<int>();
      told.Take(decoded.Components);
      for (std::size_t i = 0; i < decoded.Components.size(); ++i)
      {
        decoded.Names.push_back(told.Take<std::string>());
      }
      return;
    }
  }
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

knotwork::Status vtkSplineSurfaceFit::DecodeStart(
  vtkInformationVector** inputs, knotwork::SplineModel& start)
{
  using namespace knotwork;
  vtkDataObject* data = this->WholeInput(inputs);
  if (!data)
  {
    return this->HoldEdges == NO_EDGES ? Status()
                                       : Status(ErrorCode::InvalidParameter,
                                           "there are no edges to hold: the edges of a start "
                                           "surface are held; give one as the second input, or "
                                           "HoldEdges None");
  }
  auto model = this->DecodeInput(data);
  if (!model)
  {
    return { model.Status.Code, "the start: " + model.Status.Detail };
  }
  start = std::move(model.Value);
  return FindStart(start).Status;
}

knotwork::Status vtkSplineSurfaceFit::DecodePoints(vtkInformationVector** inputs,
  const knotwork::SplineModel& start, knotwork::DecodedCloud& decoded)
{
  using namespace knotwork;
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  if (Status sampled = CheckSampledPoints(input, "the input"); !sampled)
  {
    return sampled;
  }
  CloudChoice choice;
  choice.Start = start.Patches.empty() ? nullptr : FindStart(start).Value;
  choice.Parameters = static_cast<CloudParameters>(this->Parameterization);
  choice.Fields = this->FieldArrays;
  choice.AllFields = this->AllFields;
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
  Result<DecodedCloud> found = DecodeCloud(input, choice);
  decoded = std::move(found.Value);
  return found.Status;
}

knotwork::Status vtkSplineSurfaceFit::MakeParams(const knotwork::SplineModel& startModel,
  knotwork::DecodedCloud& decoded, knotwork::FitParams& params)
{
  using namespace knotwork;
  if (!startModel.Patches.empty())
  {
    auto start = MakeStart(startModel, decoded, this->KernelThreads());
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
  params.NumMeasured = decoded.NumMeasured;
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
  return {};
}

std::string vtkSplineSurfaceFit::NeedsWholeInput() const
{
  const std::pair<bool, const char*> all[] = { { this->FindOutliers, "FindOutliers" },
    { this->Side != BOTH_SIDES, "Side" }, { this->FeatureGridSize > 0, "FeatureGridSize" },
    { this->Parameterization == COMPUTED, "Parameterization Computed" },
    { this->CorrectParameters && this->Parameterization != HEIGHT_FIELD, "CorrectParameters" } };
  std::string names;
  for (const auto& [isAsked, name] : all)
  {
    names += isAsked ? (names.empty() ? "" : ", ") + std::string(name) : "";
  }
  return names;
}

void vtkSplineSurfaceFit::EncodePoints(vtkInformationVector** inputs, vtkInformationVector* outputs,
  const knotwork::DecodedCloud& decoded, const knotwork::SurfaceFit& fit)
{
  vtkPointSet* points = vtkPointSet::GetData(outputs, 1);
  points->ShallowCopy(vtkPointSet::GetData(inputs[0], 0));
  knotwork::EncodeDistances(decoded, fit, points);
}

knotwork::Status vtkSplineSurfaceFit::EncodeResult(vtkInformationVector* outputs,
  const knotwork::DecodedCloud& decoded, const knotwork::SurfaceFit& fit)
{
  if (!fit.WithinTolerance)
  {
    this->ReportWarnings({ DescribeMiss(fit) });
  }
  knotwork::EncodeIterations(fit, vtkTable::GetData(outputs, 2));
  knotwork::EncodeGridFeatures(fit, vtkImageData::GetData(outputs, 3));
  knotwork::EncodeElementFeatures(fit, vtkPolyData::GetData(outputs, 4));
  return knotwork::EncodeFit(decoded, fit, vtkUnstructuredGrid::GetData(outputs));
}

knotwork::Status vtkSplineSurfaceFit::FitAlone(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using namespace knotwork;
  SplineModel start;
  DecodedCloud decoded;
  FitParams params;
  Status status = this->DecodeStart(inputs, start);
  status = status ? this->DecodePoints(inputs, start, decoded) : status;
  // an envelope may have layers below it
  if (status && decoded.Over && this->Side == BOTH_SIDES && !this->LayersAreChecked)
  {
    status = CheckLayers(
      decoded.Cloud.Parameters, decoded.Cloud.Values.leftCols(decoded.NumMeasured), decoded.Over);
  }
  status = status ? this->MakeParams(start, decoded, params) : status;
  if (!status)
  {
    return status;
  }
  const Result<SurfaceFit> fit = FitSurface(decoded.Cloud, params);
  if (!fit)
  {
    return fit.Status;
  }
  this->Seconds = fit->Iterations.back().Seconds;
  this->EncodePoints(inputs, outputs, decoded, fit.Value);
  return this->EncodeResult(outputs, decoded, fit.Value);
}

knotwork::Status vtkSplineSurfaceFit::FitTogether(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using namespace knotwork;
  const bool hasPoints = vtkPointSet::GetData(inputs[0], 0)->GetNumberOfPoints() > 0;
  SplineModel start;
  DecodedCloud decoded;
  FitParams params;
  Status status = this->DecodeStart(inputs, start);
  status =
    Processes::Agree(status && hasPoints ? this->DecodePoints(inputs, start, decoded) : status);
  if (!status)
  {
    return status;
  }
  TellNames(decoded);
  status = Processes::Agree(this->MakeParams(start, decoded, params));
  if (!status)
  {
    return status;
  }
  FitProcesses processes;
  processes.Own = Processes::Own();
  processes.Count = Processes::Count();
  processes.Exchange = [](const std::string& own) { return Processes::Exchange(own); };
  processes.Deal = [](std::vector<std::string> hands) { return Processes::Deal(std::move(hands)); };
  processes.Check = [this](const PointMatrix& parameters, const PointMatrix& values)
  {
    return CheckLayers(parameters, values,
      this->Parameterization == HEIGHT_FIELD ? "x and y" : "the parameters that are given", false);
  };
  // points in space get their parameters back
  PointMatrix parameters = decoded.NumMeasured == 3 ? decoded.Cloud.Parameters : PointMatrix();
  const Result<SurfaceFit> fit = FitSurface(std::move(decoded.Cloud), params, processes);
  decoded.Cloud.Parameters = std::move(parameters);
  if (!fit)
  {
    return fit.Status;
  }
  this->Seconds = fit->Iterations.back().Seconds;
  if (hasPoints)
  {
    this->EncodePoints(inputs, outputs, decoded, fit.Value);
  }
  return Processes::Own() == 0 ? this->EncodeResult(outputs, decoded, fit.Value) : Status();
}

knotwork::Status vtkSplineSurfaceFit::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return knotwork::IsPieceOfEveryProcess(outputs) ? knotwork::Status()
                                                  : this->FitAlone(inputs, outputs);
}

knotwork::Status vtkSplineSurfaceFit::Merge(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using namespace knotwork;
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  const int own = input && input->GetNumberOfPoints() > 0 ? 1 : 0;
  const std::vector<int> all = Processes::ExchangeNumber(own);
  const auto withPoints = std::count(all.begin(), all.end(), 1);
  const std::string whole = this->NeedsWholeInput();
  if (withPoints == 0)
  {
    return {};
  }
  if (whole.empty())
  {
    return this->FitTogether(inputs, outputs);
  }
  if (withPoints > 1)
  {
    return { ErrorCode::InvalidTopology,
      "the whole input is needed, and it is spread over " + std::to_string(withPoints) + " of " +
        std::to_string(all.size()) + " processes; leave out what needs it (" + whole +
        "), or work in one process" };
  }
  return own != 0 ? this->FitAlone(inputs, outputs) : Status();
}
