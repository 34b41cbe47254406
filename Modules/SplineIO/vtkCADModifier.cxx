// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCADModifier.h"

#include "CADGrids.h"
#include "CurvesInSpace.h"
#include "ForeignFile.h"
#include "ModifyProcess.h"
#include <knotwork/CADModel/CADOperationText.h>
#include <knotwork/SplineGrid/TableRow.h>
#include <knotwork/SplineGrid/WorkerProcess.h>

#include "vtkDataObject.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <sstream>

using namespace knotwork;

vtkStandardNewMacro(vtkCADModifier);

namespace
{
constexpr int StepPort = 3;
constexpr double ChordalTolerance = 1e-3; ///< of triangles, share of the size, as vtkCADReader's

/// Operations with semicolons or ends of lines between them.
Result<std::vector<CADOperation>> ParseOperations(std::string text)
{
  for (char& letter : text)
  {
    letter = letter == '\n' || letter == '\r' ? ';' : letter;
  }
  std::vector<CADOperation> operations;
  std::istringstream stream(text);
  for (std::string one; std::getline(stream, one, ';');)
  {
    if (one.find_first_not_of(" \t") == std::string::npos)
    {
      continue;
    }
    auto operation = ParseCADOperation(one);
    if (!operation)
    {
      return operation.Status;
    }
    operations.push_back(std::move(operation.Value));
  }
  return operations;
}

/// "4,5 - 6": the first face became 4 and 5, the second one is gone, the third one is 6.
std::string InWords(const std::vector<std::vector<int>>& newFaces)
{
  std::string text;
  for (const std::vector<int>& ids : newFaces)
  {
    std::string one;
    for (int id : ids)
    {
      one += (one.empty() ? "" : ",") + std::to_string(id);
    }
    text += (text.empty() ? "" : " ") + (one.empty() ? "-" : one);
  }
  return text;
}

void EncodeSteps(const std::vector<CADStep>& steps, vtkTable* table)
{
  using Step = const CADStep&;
  const auto text = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkStringArray>(name, steps, value)); };
  const auto count = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkIntArray>(name, steps, value)); };
  const auto number = [&](const char* name, const auto& value)
  { table->AddColumn(ArrayOf<vtkDoubleArray>(name, steps, value)); };
  text("Operation", [](Step step) { return std::string(NameOf(step.Kind)); });
  count("SolidsBefore", [](Step step) { return step.Before.Solids; });
  count("FacesBefore", [](Step step) { return step.Before.Faces; });
  number("VolumeBefore", [](Step step) { return step.Before.Volume; });
  count("Solids", [](Step step) { return step.After.Solids; });
  count("Faces", [](Step step) { return step.After.Faces; });
  count("Edges", [](Step step) { return step.After.Edges; });
  count("Vertices", [](Step step) { return step.After.Vertices; });
  count("FaceIds", [](Step step) { return step.After.FaceIds; });
  number("Volume", [](Step step) { return step.After.Volume; });
  number("VolumeChange", [](Step step) { return step.VolumeChange; });
  number("Overlap", [](Step step) { return step.Overlap; });
  text("NewFaces", [](Step step) { return InWords(step.NewFaces); });
  text("Composite", [](Step step) { return step.Composite.Name; });
  count("TurnedFaces", [](Step step) { return step.Healing.TurnedFaces; });
  count("TurnedSolids", [](Step step) { return step.Healing.TurnedSolids; });
  count("SewnEdges", [](Step step) { return step.Healing.SewnEdges; });
  count("NewSolids", [](Step step) { return step.Healing.NewSolids; });
  count("RemovedEdges", [](Step step) { return step.Healing.RemovedEdges; });
  count("RemovedFaces", [](Step step) { return step.Healing.RemovedFaces; });
  count("ClosedGaps", [](Step step) { return step.Healing.ClosedGaps; });
  text("Unmended",
    [](Step step)
    {
      std::string all;
      for (const std::string& one : step.Healing.Unmended)
      {
        all += (all.empty() ? "" : "; ") + one;
      }
      return all;
    });
}
}

vtkCADModifier::vtkCADModifier()
{
  this->SetInputTypes({ Optional(Shapes()) });
  this->SetOutputTypes({ "vtkUnstructuredGrid", "vtkUnstructuredGrid", "vtkPolyData", "vtkTable" });
}

vtkCADModifier::~vtkCADModifier()
{
  this->SetFileName(nullptr);
  this->SetOutputFileName(nullptr);
  this->SetOperations(nullptr);
}

Status vtkCADModifier::Compute(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!this->FileName || this->FileName[0] == '\0')
  {
    return { ErrorCode::EmptyInput, "there is no file name" };
  }
  auto operations = ParseOperations(this->Operations ? this->Operations : "");
  if (!operations)
  {
    return operations.Status;
  }
  if (vtkDataObject* data = vtkDataObject::GetData(inputs[0]))
  {
    const auto curves = CurvesInSpace(data, this->KernelThreads());
    if (!curves)
    {
      return { curves.Status.Code, "input 0: " + curves.Status.Detail };
    }
    for (CADOperation& operation : operations.Value)
    {
      if (operation.Kind == CADOperationKind::SplitByCurve)
      {
        operation.Curves = curves.Value;
      }
    }
  }
  const TemporaryFolder folder;
  const bool isKept = this->OutputFileName && this->OutputFileName[0] != '\0';
  const std::string output = isKept ? this->OutputFileName : folder.Path() + "/modified.step";
  CADModifyParams params;
  params.Unit = static_cast<LengthUnit>(this->Unit);
  params.VolumeTolerance = this->VolumeTolerance;
  const ProgressCallback progress = this->Progress();
  const auto steps = ModifyCADInProcess(this->FileName, output, operations.Value, params,
    [&progress] { return !progress || progress(0.1); });
  if (!steps)
  {
    return steps.Status;
  }
  std::vector<std::string> unmended;
  for (const CADStep& step : steps.Value)
  {
    unmended.insert(unmended.end(), step.Healing.Unmended.begin(), step.Healing.Unmended.end());
  }
  this->ReportWarnings(unmended);
  CADReadParams reading;
  reading.Unit = params.Unit;
  const auto contents = ReadCADInProcess(output, reading);
  if (!contents)
  {
    return contents.Status;
  }
  this->ReportLeftOut(contents->LeftOut);
  this->ReportWarnings(contents->Warnings);
  TrimmedMeshParams meshing;
  meshing.Tolerance = ChordalTolerance * SizeOf(contents->Model);
  meshing.Threads = this->KernelThreads();
  meshing.Progress = this->Progress();
  if (Status status = EncodeCAD(contents->Model, &meshing, vtkUnstructuredGrid::GetData(outputs, 0),
        vtkUnstructuredGrid::GetData(outputs, 1), vtkPolyData::GetData(outputs, 2));
      !status)
  {
    return status;
  }
  EncodeSteps(steps.Value, vtkTable::GetData(outputs, StepPort));
  return {};
}
