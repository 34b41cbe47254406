// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineContour.h"

#include "ContourData.h"

#include "vtkDataObject.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include <knotwork/SplineGrid/DistributedInput.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/ReferenceSystem.h>

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkSplineContour);

vtkSplineContour::vtkSplineContour()
{
  this->SetOutputTypes({ "vtkPolyData", "vtkUnstructuredGrid", "vtkTable", "vtkPolyData" });
  knotwork::KeepReferenceSystem(this);
}

void vtkSplineContour::AddLevel(double level)
{
  this->Levels.push_back(level);
  this->Modified();
}

void vtkSplineContour::ClearLevels()
{
  if (!this->Levels.empty())
  {
    this->Levels.clear();
    this->Modified();
  }
}

struct vtkSplineContour::Preparation
{
  knotwork::ContourChoice Choice;
  knotwork::ContourPatches Surfaces;
};

vtkSplineContour::~vtkSplineContour() = default;

knotwork::Status vtkSplineContour::Prepare(vtkInformationVector** inputs)
{
  using namespace knotwork;
  this->Prepared = std::make_unique<Preparation>();
  const auto model = this->DecodeInput(vtkDataObject::GetData(inputs[0], 0));
  if (!model)
  {
    return model.Status;
  }
  ContourChoice& choice = this->Prepared->Choice;
  choice.Field = this->FieldName == "None" ? "" : this->FieldName;
  choice.Component = this->Component;
  choice.Range = { this->Range[0], this->Range[1] };
  choice.Curves = this->Curves;
  choice.Params.Levels = this->Levels;
  choice.Params.NumLevels = this->NumberOfLevels;
  choice.Params.Tolerance = this->Tolerance;
  choice.Params.ChordTolerance = this->ChordalTolerance;
  choice.Params.JoinSeams = this->JoinSeams;
  choice.Params.MaxCells = this->MaximumCells;
  choice.Params.MaxPoints = this->MaximumPoints;
  choice.Params.Threads = this->KernelThreads();
  choice.Params.Progress = this->Progress();
  auto surfaces = PreparePatches(model.Value, choice);
  this->Prepared->Surfaces = std::move(surfaces.Value);
  return surfaces.Status;
}

knotwork::Status vtkSplineContour::Gather(vtkInformationVector** inputs)
{
  using namespace knotwork;
  ContourRanges own;
  own.fill({ HUGE_VAL, -HUGE_VAL });
  Status status;
  if (HasData(inputs, 1))
  {
    status = this->Prepare(inputs);
    own = status ? this->Prepared->Surfaces.Ranges : own;
  }
  ContourRanges whole = own;
  for (const auto& piece : Processes::Exchange(std::vector<ContourRanges>{ own }))
  {
    for (std::size_t c = 0; c < whole.size(); ++c)
    {
      whole[c] = { std::min(whole[c][0], piece.front()[c][0]),
        std::max(whole[c][1], piece.front()[c][1]) };
    }
  }
  if (this->Prepared)
  {
    this->Prepared->Surfaces.Ranges = whole;
  }
  return status;
}

knotwork::Status vtkSplineContour::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using namespace knotwork;
  Status status = Processes::Count() > 1 ? Status() : this->Prepare(inputs); // else gathered
  const std::unique_ptr<Preparation> prepared = std::move(this->Prepared);
  status = status ? TracePatches(prepared->Choice, prepared->Surfaces) : status;
  if (!status)
  {
    return status;
  }
  const std::vector<PatchContours>& patches = prepared->Surfaces.Patches;
  std::size_t undecided = 0;
  for (const PatchContours& patch : patches)
  {
    undecided += patch.Contours.Undecided.size();
  }
  if (undecided > 0)
  {
    this->ReportWarnings({ std::to_string(undecided) +
      " cells stay undecided (output 3): a ridge or valley on the level, perhaps; move the level "
      "or raise MaximumCells" });
  }
  const int threads = this->KernelThreads();
  EncodeLevels(patches, vtkTable::GetData(outputs, 2));
  status = EncodePolylines(patches, this->ProjectToLevel, threads, vtkPolyData::GetData(outputs));
  status = status
    ? EncodeCurves(patches, this->ProjectToLevel, vtkUnstructuredGrid::GetData(outputs, 1))
    : status;
  return status ? EncodeUndecided(patches, threads, vtkPolyData::GetData(outputs, 3)) : status;
}

knotwork::Status vtkSplineContour::Merge(vtkInformationVector**, vtkInformationVector* outputs)
{
  return knotwork::MergeContours(this->KernelThreads(), vtkPolyData::GetData(outputs),
    vtkUnstructuredGrid::GetData(outputs, 1), vtkTable::GetData(outputs, 2));
}
