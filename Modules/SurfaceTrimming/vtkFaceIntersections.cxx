// SPDX-License-Identifier: BSD-3-Clause
#include "vtkFaceIntersections.h"

#include "TrimmedGrids.h"

#include <knotwork/SurfaceTrimming/FaceIntersections.h>

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkTypeInt64Array.h"

vtkStandardNewMacro(vtkFaceIntersections);

namespace
{
template <typename Array>
Array* AddArray(vtkPolyData* points, const char* name, int components)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  points->GetPointData()->AddArray(array);
  return array;
}

void EncodeMeetings(const std::vector<knotwork::FaceMeeting>& meetings, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  auto* faces = AddArray<vtkIntArray>(output, "Faces", 2);
  auto* parameters = AddArray<vtkDoubleArray>(output, "Parameters", 4);
  auto* verdicts = AddArray<vtkIntArray>(output, "Verdict", 1);
  auto* open = AddArray<vtkIntArray>(output, "OpenPlaces", 1);
  for (const knotwork::FaceMeeting& meeting : meetings)
  {
    const vtkIdType point = points->InsertNextPoint(meeting.Position.data());
    vertices->InsertNextCell(1, &point);
    faces->InsertNextTypedTuple(meeting.Faces.data());
    const auto& [first, second] = meeting.Parameters;
    const double all[4] = { first[0], first[1], second[0], second[1] };
    parameters->InsertNextTypedTuple(all);
    verdicts->InsertNextValue(static_cast<int>(meeting.Verdict));
    open->InsertNextValue(meeting.OpenPlaces);
  }
  output->SetPoints(points);
  output->SetVerts(vertices);
  output->GetPointData()->SetActiveScalars("Verdict");
}

template <typename Array, typename Value>
void AddColumn(vtkTable* table, const char* name, Value value)
{
  vtkNew<Array> column;
  column->SetName(name);
  column->InsertNextValue(value);
  table->AddColumn(column);
}

void EncodeNumbers(const knotwork::FaceIntersections& found, std::size_t faces, vtkTable* table)
{
  std::int64_t number = 0;
  for (const knotwork::FaceMeeting& meeting : found.Meetings)
  {
    number += meeting.Verdict == knotwork::IntersectionVerdict::Found ? 1 : 0;
  }
  const auto count = [&](const char* name, std::int64_t value)
  { AddColumn<vtkTypeInt64Array>(table, name, value); };
  AddColumn<vtkStringArray>(table, "Verdict", ToString(found.Verdict));
  count("Found", number);
  count("Undecided", static_cast<std::int64_t>(found.Meetings.size()) - number);
  count("Faces", static_cast<std::int64_t>(faces));
  count("PairsOfFaces", found.PairsOfFaces);
  count("Pairs", found.Pairs);
  AddColumn<vtkDoubleArray>(table, "Tolerance", found.Tolerance);
}
}

vtkFaceIntersections::vtkFaceIntersections()
{
  this->SetOutputTypes({ "vtkPolyData", "vtkTable" });
}

knotwork::Status vtkFaceIntersections::Compute(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  std::vector<std::string> warnings;
  const auto model =
    knotwork::DecodeTrimmedModel(vtkDataObject::GetData(inputs[0], 0), nullptr, &warnings);
  if (!model)
  {
    return model.Status;
  }
  this->ReportWarnings(warnings);
  knotwork::FaceIntersectionParams params;
  params.Tolerance = this->Tolerance;
  params.MaxPairs = this->MaximumPairs;
  params.Threads = this->KernelThreads();
  params.Progress = this->Progress();
  const auto found = knotwork::FindFaceIntersections(model.Value, params);
  if (!found)
  {
    return found.Status;
  }
  EncodeMeetings(found->Meetings, vtkPolyData::GetData(outputs, 0));
  EncodeNumbers(found.Value, model->Faces.size(), vtkTable::GetData(outputs, 1));
  return {};
}
