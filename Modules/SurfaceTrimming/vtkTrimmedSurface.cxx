// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTrimmedSurface.h"
#include <knotwork/SplineCore/Numbers.h>

#include "TrimData.h"
#include "TrimmedGrids.h"

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkTimerLog.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkTrimmedSurface);

namespace
{
constexpr int DeviationPort = 3;

/// Why the deviation is not smaller, with the remedy; empty when nothing stopped it.
std::string WhyStopped(const knotwork::TrimmedSurface& trimmed)
{
  const std::string chart = trimmed.BackMaps.size() > 1
    ? " (chart " + std::to_string(trimmed.StoppedChart) + ")"
    : std::string();
  switch (trimmed.Stop)
  {
    case knotwork::BackMapStop::Effort:
      return ": the effort was used up" + chart + "; raise Effort or Tolerance";
    case knotwork::BackMapStop::Time:
      return ": the time limit was reached" + chart + "; raise TimeLimit or Tolerance";
    case knotwork::BackMapStop::Elements:
      return ": the net has all elements it may have" + chart +
        "; raise MaximumElements or Tolerance";
    case knotwork::BackMapStop::Functions:
      return ": the net has all functions it may have" + chart +
        "; raise MaximumFunctions, if the memory suffices, or Tolerance";
    case knotwork::BackMapStop::Contradiction:
      return ": " + trimmed.StopReason + chart +
        "; flatten the mesh without overlaps, by INJECTIVE or in several charts";
    case knotwork::BackMapStop::Finished:
      break;
  }
  return {};
}

/// What a user should know about faces that are not as asked for.
std::vector<std::string> Shortcomings(const knotwork::TrimmedSurface& trimmed)
{
  std::vector<std::string> texts;
  if (!trimmed.WithinTolerance)
  {
    texts.push_back("the deviation is up to " + knotwork::Digits(trimmed.MaxDeviation) +
      ", above the tolerance " + knotwork::Digits(trimmed.Tolerance) + WhyStopped(trimmed));
  }
  const std::vector<std::string> ofFaces = knotwork::ShortcomingsOfFaces(
    knotwork::WorstVerdict(trimmed.Certificates), knotwork::WorstLoops(trimmed.Loops.Verdicts));
  texts.insert(texts.end(), ofFaces.begin(), ofFaces.end());
  return texts;
}
}

vtkTrimmedSurface::vtkTrimmedSurface()
{
  this->SetInputTypes({ Meshes() });
  this->SetOutputTypes(
    { "vtkPolyData", "vtkUnstructuredGrid", "vtkUnstructuredGrid", "vtkPointSet", "vtkTable" });
}

int vtkTrimmedSurface::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  MakeOutput(outputs, DeviationPort,
    vtkPolyData::GetData(inputs[0], 0) ? "vtkPolyData" : "vtkUnstructuredGrid");
  return this->MakeDeclaredOutputs(outputs);
}

knotwork::Status vtkTrimmedSurface::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPointSet* input = vtkPointSet::GetData(inputs[0], 0);
  const double begin = vtkTimerLog::GetUniversalTime();
  const auto decoded = knotwork::DecodeCharts(input);
  if (!decoded)
  {
    return decoded.Status;
  }
  knotwork::TrimParams params;
  params.BackMap.Method = static_cast<knotwork::BackMapMethod>(this->Method);
  params.BackMap.Degree = this->Degree;
  params.BackMap.Elements = this->Elements;
  params.BackMap.MaxElements = this->MaximumElements;
  params.BackMap.Margin = this->Margin;
  params.BackMap.Smoothing = this->Smoothing;
  params.BackMap.Centres = this->Centres;
  params.CornerAngle = this->CornerAngle;
  params.Tolerance = this->Tolerance;
  params.ChordalTolerance = this->ChordalTolerance;
  params.BackMap.MaxFunctions = this->MaximumFunctions;
  params.Effort = this->Effort;
  params.TimeLimit = this->TimeLimit;
  params.Triangulation = this->Triangulation;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  auto trimmed = knotwork::TrimSurface(decoded->Charts, params);
  if (!trimmed)
  {
    return trimmed.Status;
  }
  this->ReportWarnings(Shortcomings(trimmed.Value));
  knotwork::TurnFaces(decoded->Turned, trimmed.Value);
  knotwork::EncodeTriangles(trimmed->Mesh, vtkPolyData::GetData(outputs, 0));
  const knotwork::Status status = knotwork::EncodeTrimmedModel(trimmed->Model,
    vtkUnstructuredGrid::GetData(outputs, 1), vtkUnstructuredGrid::GetData(outputs, 2));
  if (!status)
  {
    return status;
  }
  vtkPointSet* deviation = vtkPointSet::GetData(outputs, DeviationPort);
  deviation->ShallowCopy(input);
  knotwork::EncodeDeviation(decoded.Value, trimmed.Value, deviation);
  this->Seconds = vtkTimerLog::GetUniversalTime() - begin;
  knotwork::EncodeNumbers(trimmed.Value, vtkTable::GetData(outputs, 4));
  return {};
}
