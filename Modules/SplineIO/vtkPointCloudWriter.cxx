// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPointCloudWriter.h"

#include "FileFormats.h"
#include "FileText.h"
#include "PointData.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineIO/GoToolsG2.h>
#include <knotwork/SplineIO/PointText.h>

#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPointSet.h"

vtkStandardNewMacro(vtkPointCloudWriter);

vtkPointCloudWriter::vtkPointCloudWriter() = default;

vtkPointCloudWriter::~vtkPointCloudWriter()
{
  this->SetFileName(nullptr);
}

int vtkPointCloudWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
  return 1;
}

knotwork::Status vtkPointCloudWriter::MakeText(std::string& text)
{
  using namespace knotwork;
  const std::string ending = LowerEnding(this->FileName);
  const bool asG2 = ending == ".g2";
  if (!asG2 && ending != ".csv" && ending != ".xyz" && ending != ".txt")
  {
    return { ErrorCode::InvalidParameter,
      std::string("'") + this->FileName + "': points are written as .xyz .txt .csv .g2" };
  }
  const PointFile file = DecodePoints(vtkPointSet::SafeDownCast(this->GetInput()));
  if (asG2 && !file.Names.empty())
  {
    vtkWarningMacro("the point arrays are left out: the format has none");
  }
  Result<std::string> made =
    asG2 ? WriteG2Points(file) : WritePointText(file, ending == ".csv" ? ',' : ' ');
  text = std::move(made.Value);
  return made.Status;
}

void vtkPointCloudWriter::WriteData()
{
  const knotwork::WriteOutcome outcome = knotwork::WriteText(
    this->GetInput(), this->FileName, [this](std::string& text) { return this->MakeText(text); });
  this->SetErrorCode(outcome.Code);
  if (!outcome.Message.empty())
  {
    vtkErrorMacro("" << outcome.Message);
  }
}
