// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPointCloudReader.h"

#include "FileFormats.h"
#include "FileText.h"
#include "ForeignFile.h"
#include "PointData.h"
#include "RasterPoints.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineIO/GoToolsG2.h>
#include <knotwork/SplineIO/LasFile.h>
#include <knotwork/SplineIO/MeshFiles.h>
#include <knotwork/SplineIO/PlyPoints.h>
#include <knotwork/SplineIO/PointText.h>
#include <knotwork/SplineIO/SvgPaths.h>

#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"

#include <map>
#include <string_view>

vtkStandardNewMacro(vtkPointCloudReader);

namespace
{
using namespace knotwork;

bool BeginsWithPly(std::string_view beginning)
{
  return beginning.substr(0, 3) == "ply";
}

bool BeginsWithOff(std::string_view beginning)
{
  return beginning.find("OFF") != std::string_view::npos;
}

bool BeginsWithLas(std::string_view beginning)
{
  return beginning.substr(0, 4) == "LASF";
}

bool BeginsWithTiff(std::string_view beginning)
{
  return beginning.substr(0, 2) == "II" || beginning.substr(0, 2) == "MM";
}

bool IsThere(std::string_view beginning)
{
  return !beginning.empty();
}

/// How files of one ending are known and read.
struct PointFormat
{
  bool (*BeginsLikeOne)(std::string_view beginning);
  Result<PointFile> (*Read)(std::string_view text, int threads);
};

template <Result<PointFile> (*ReadText)(std::string_view)>
Result<PointFile> OnOneThread(std::string_view text, int)
{
  return ReadText(text);
}

const PointFormat* FormatOf(const std::string& ending)
{
  static const PointFormat text{ LooksLikePointText, ReadPointText };
  static const PointFormat las{ BeginsWithLas, OnOneThread<ReadLas> };
  static const std::map<std::string, PointFormat> formats = {
    { ".xyz", text },
    { ".txt", text },
    { ".csv", text },
    { ".g2", { BeginsWithG2Points, OnOneThread<ReadG2Points> } },
    { ".las", las },
    { ".laz", las }, // refused by its reader, which names a program that decompresses
    { ".ply", { BeginsWithPly, OnOneThread<ReadPly> } },
    { ".off", { BeginsWithOff, OnOneThread<ReadOff> } },
    { ".obj", { IsThere, OnOneThread<ReadObj> } },
    { ".stl", { IsThere, OnOneThread<ReadStl> } },
    { ".svg", { LooksLikeSvg, OnOneThread<ReadSvg> } },
  };
  const auto found = formats.find(ending);
  return found == formats.end() ? nullptr : &found->second;
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
  const PointFormat* format = FormatOf(ending);
  if (IsRasterEnding(ending))
  {
    return BeginsWithTiff(beginning) ? 1 : 0;
  }
  return (format ? format->BeginsLikeOne(beginning) : (ending == ".vtp" && IsThere(beginning))) ? 1
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
  if (IsRasterEnding(LowerEnding(file)))
  {
    Result<RasterPoints> raster = ReadRasterPoints(file, this->Progress());
    if (raster)
    {
      this->ReportLeftOut(raster->Points.LeftOut);
      EncodePoints(raster->Points, output);
      const auto without = NamedArray<vtkIdTypeArray>("CellsWithoutData");
      without->InsertNextValue(static_cast<vtkIdType>(raster->NumWithoutData));
      output->GetFieldData()->AddArray(without);
    }
    return raster.Status;
  }
  Result<std::string> text = TextOfFile(file);
  if (!text)
  {
    return text.Status;
  }
  const std::string ending = LowerEnding(file);
  const PointFormat* format = FormatOf(ending);
  if (!format)
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "': the ending '" + ending + "' is none of " +
        JoinEndings(EndingsThatRead(PointContent)) };
  }
  Result<PointFile> points = format->Read(text.Value, this->KernelThreads());
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
