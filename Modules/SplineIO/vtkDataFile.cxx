// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDataFile.h"

#include "DataFile.h"
#include "OutputFiles.h"
#include <knotwork/SplineGrid/FilterErrorCode.h>

#include "vtkDataObject.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDataFile);

void vtkDataFile::SetCurves(vtkDataObject* curves)
{
  if (this->Curves != curves)
  {
    this->Curves = curves;
    this->Modified();
  }
}

vtkDataObject* vtkDataFile::GetCurves()
{
  return this->Curves;
}

void vtkDataFile::Begin()
{
  this->ErrorCode = 0;
  this->ErrorText.clear();
  this->Warnings.clear();
  this->LeftOut.clear();
}

bool vtkDataFile::End(const knotwork::Status& status)
{
  if (!status)
  {
    this->ErrorCode = knotwork::FilterErrorCode(status);
    this->ErrorText = status.Message();
  }
  return static_cast<bool>(status);
}

bool vtkDataFile::GetErrorIsOfFile()
{
  using namespace knotwork;
  return this->ErrorCode == FilterErrorCode(Status(knotwork::ErrorCode::FileError, ""));
}

vtkDataObject* vtkDataFile::Read(const std::string& file)
{
  this->Begin();
  this->Data = nullptr;
  this->SetCurves(nullptr);
  auto found = knotwork::ReadDataFile(file);
  if (this->End(found.Status))
  {
    this->Data = found->Data;
    this->SetCurves(found->Curves);
    this->Warnings = found->Warnings;
    this->LeftOut = found->LeftOut;
  }
  return this->Data;
}

bool vtkDataFile::Write(vtkDataObject* data, const std::string& file)
{
  this->Begin();
  return this->End(this->Put(data, file));
}

knotwork::Status vtkDataFile::Put(vtkDataObject* data, const std::string& file)
{
  using namespace knotwork;
  if (!data)
  {
    return { ErrorCode::EmptyInput, "there are no data to write" };
  }
  if (this->Encoding != "ascii" && this->Encoding != "binary" && this->Encoding != "appended")
  {
    return { ErrorCode::InvalidParameter,
      "there is no encoding '" + this->Encoding + "'; choose ascii, binary or appended" };
  }
  if (Status status = CheckDataFormat(data, file); !status)
  {
    return status;
  }
  OutputFiles files;
  auto staged = files.Stage(file);
  if (!staged)
  {
    return staged.Status;
  }
  DataFileParams params;
  params.Curves = this->Curves;
  params.Encoding = this->Encoding;
  auto written = WriteDataFile(data, staged->string(), params);
  if (!written)
  {
    return AboutFile(written.Status, file, staged->string());
  }
  this->Warnings = written.Value;
  return files.Commit();
}
