// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineContour.h"

#include "ContourData.h"

#include "vtkDataObject.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkSplineContour);

vtkSplineContour::vtkSplineContour()
{
  this->SetOutputTypes({ "vtkPolyData", "vtkUnstructuredGrid", "vtkTable", "vtkPolyData" });
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

knotwork::Status vtkSplineContour::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using namespace knotwork;
  const auto model = this->DecodeInput(vtkDataObject::GetData(inputs[0], 0));
  if (!model)
  {
    return model.Status;
  }
  ContourChoice choice;
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
  const auto patches = TracePatches(model.Value, choice);
  if (!patches)
  {
    return patches.Status;
  }
  std::size_t undecided = 0;
  for (const PatchContours& patch : patches.Value)
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
  EncodeLevels(patches.Value, vtkTable::GetData(outputs, 2));
  Status status =
    EncodePolylines(patches.Value, this->ProjectToLevel, threads, vtkPolyData::GetData(outputs));
  status = status
    ? EncodeCurves(patches.Value, this->ProjectToLevel, vtkUnstructuredGrid::GetData(outputs, 1))
    : status;
  return status ? EncodeUndecided(patches.Value, threads, vtkPolyData::GetData(outputs, 3))
                : status;
}
