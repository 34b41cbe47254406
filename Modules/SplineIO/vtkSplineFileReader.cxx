// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineFileReader.h"

#include "FileText.h"
#include "SplineFileModel.h"

#include "vtkUnstructuredGrid.h"

vtkSplineFileReader::vtkSplineFileReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkSplineFileReader::~vtkSplineFileReader()
{
  this->SetFileName(nullptr);
}

int vtkSplineFileReader::CanReadFile(const char* fileName)
{
  const std::string beginning = knotwork::BeginningOfFile(fileName ? fileName : "");
  return this->Recognize(beginning) ? 1 : 0;
}

knotwork::Status vtkSplineFileReader::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  using namespace knotwork;
  const Result<std::string> text = TextOfFile(this->FileName ? this->FileName : "");
  if (!text)
  {
    return text.Status;
  }
  const std::string name = std::string("'") + this->FileName + "'";
  const Result<SplineFile> file = this->Parse(text.Value);
  if (!file)
  {
    return { file.Status.Code, name + ": " + file.Status.Detail };
  }
  const Result<SplineModel> model = ModelFromFile(file.Value);
  if (!model)
  {
    return { model.Status.Code, name + ": " + model.Status.Detail };
  }
  this->ReportLeftOut(file->LeftOut);
  this->ReportWarnings(model->Warnings);
  auto* grid = vtkUnstructuredGrid::GetData(outputs);
  const Status status = EncodeSplineGrid(model.Value, grid);
  return status ? this->EncodeMore(file.Value, outputs) : status;
}
