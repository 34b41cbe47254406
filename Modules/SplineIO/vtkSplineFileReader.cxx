// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSplineFileReader.h"

#include "PatchTopology.h"
#include "SplineFileModel.h"

#include "vtkUnstructuredGrid.h"

#include <filesystem>
#include <fstream>
#include <system_error>

vtkSplineFileReader::vtkSplineFileReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkSplineFileReader::~vtkSplineFileReader()
{
  this->SetFileName(nullptr);
}

void vtkSplineFileReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
}

int vtkSplineFileReader::CanReadFile(const char* fileName)
{
  std::ifstream stream(fileName ? fileName : "", std::ios::binary);
  std::string beginning(4096, '\0');
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  return this->Recognize(beginning) ? 1 : 0;
}

knotwork::Status vtkSplineFileReader::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  using namespace knotwork;
  if (!this->FileName || this->FileName[0] == '\0')
  {
    return { ErrorCode::EmptyInput, "there is no file name" };
  }
  const std::string name = std::string("'") + this->FileName + "'";
  std::ifstream stream(this->FileName, std::ios::binary | std::ios::ate);
  std::error_code ignored;
  const bool opened = stream && !std::filesystem::is_directory(this->FileName, ignored);
  const std::streamoff size = opened ? static_cast<std::streamoff>(stream.tellg()) : -1;
  std::string text;
  if (size >= 0)
  {
    text.resize(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(text.data(), size);
  }
  if (size < 0 || !stream)
  {
    return { ErrorCode::EmptyInput, name + " cannot be read; check its name and permissions" };
  }
  const Result<SplineFile> file = this->Parse(text);
  if (!file)
  {
    return { file.Status.Code, name + ": " + file.Status.Detail };
  }
  const Result<SplineModel> model = ModelFromFile(file.Value);
  if (!model)
  {
    return { model.Status.Code, name + ": " + model.Status.Detail };
  }
  this->ReportWarnings(model->Warnings);
  auto* grid = vtkUnstructuredGrid::GetData(outputs);
  const Status status = EncodeSplineGrid(model.Value, grid);
  if (status)
  {
    SetPatchTopology(file.Value, grid);
  }
  return status;
}
