// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPointCloudReader.h"

#include "FileText.h"
#include "ForeignFile.h"
#include "PointData.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineIO/FileFormats.h>
#include <knotwork/SplineIO/GoToolsG2.h>
#include <knotwork/SplineIO/MeshFiles.h>
#include <knotwork/SplineIO/PlyPoints.h>
#include <knotwork/SplineIO/PointText.h>

#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

vtkStandardNewMacro(vtkPointCloudReader);

namespace
{
using namespace knotwork;

Result<PointFile> Parse(const std::string& ending, const std::string& text, int threads)
{
  if (IsEndingOf(FormatFamily::PointText, ending))
  {
    return ReadPointText(text, threads);
  }
  if (ending == ".g2")
  {
    return ReadG2Points(text);
  }
  if (ending == ".ply")
  {
    return ReadPly(text);
  }
  if (ending == ".off")
  {
    return ReadOff(text);
  }
  if (ending == ".obj")
  {
    return ReadObj(text);
  }
  if (ending == ".stl")
  {
    return ReadStl(text);
  }
  return { ErrorCode::InvalidParameter,
    "the ending '" + ending + "' is none of " + JoinEndings(EndingsThatRead(PointContent)) };
}
}

vtkPointCloudReader::vtkPointCloudReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkPointCloudReader::~vtkPointCloudReader()
{
  this->SetFileName(nullptr);
}

int vtkPointCloudReader::CanReadFile(const char* fileName)
{
  const std::string ending = LowerEnding(fileName ? fileName : "");
  const std::string beginning = BeginningOfFile(fileName ? fileName : "");
  return (IsEndingOf(FormatFamily::PointText, ending) && LooksLikePointText(beginning)) ||
      (ending == ".g2" && BeginsWithG2Points(beginning)) ||
      (ending == ".ply" && beginning.compare(0, 3, "ply") == 0) ||
      (ending == ".off" && beginning.find("OFF") != std::string::npos) ||
      ((ending == ".obj" || ending == ".stl" || ending == ".vtp") && !beginning.empty())
    ? 1
    : 0;
}

int vtkPointCloudReader::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  return 1;
}

int vtkPointCloudReader::RequestDataObject(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  return this->MakeDeclaredOutputs(outputs);
}

knotwork::Status vtkPointCloudReader::Compute(vtkInformationVector**, vtkInformationVector* outputs)
{
  auto* output = vtkPolyData::GetData(outputs);
  const std::string file = this->FileName ? this->FileName : "";
  if (LowerEnding(file) == ".vtp")
  {
    const auto read = ReadVTKFile(file);
    auto* points = vtkPolyData::SafeDownCast(read.Value);
    if (!points)
    {
      return read ? Status(ErrorCode::EmptyInput, "'" + file + "' holds no points") : read.Status;
    }
    output->ShallowCopy(points);
    return output->GetNumberOfPoints() > 0
      ? Status()
      : Status(ErrorCode::EmptyInput, "'" + file + "' holds no points");
  }
  Result<std::string> text = TextOfFile(file);
  if (!text)
  {
    return text.Status;
  }
  Result<PointFile> points = Parse(LowerEnding(file), text.Value, this->KernelThreads());
  text.Value = {};
  if (!points)
  {
    return { points.Status.Code, "'" + file + "': " + points.Status.Detail };
  }
  this->ReportLeftOut(points->LeftOut);
  this->ReportWarnings(points->Warnings);
  EncodePoints(points.Value, output);
  return {};
}
