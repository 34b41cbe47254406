// SPDX-License-Identifier: BSD-3-Clause
#include "DataFile.h"

#include "DataCheck.h"
#include "FileFormats.h"
#include "FileText.h"
#include "Messages.h"
#include "PieceFiles.h"
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineGrid/NamedArray.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineIO/NumberTable.h>

#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

namespace knotwork
{
namespace
{
/// What data of this type are to a file.
unsigned ContentsOf(vtkDataObject* data)
{
  return vtkPolyData::SafeDownCast(data)      ? PointContent | PolylineContent | PolygonContent
    : vtkUnstructuredGrid::SafeDownCast(data) ? SplineGridContent | GridContent
    : vtkPartitionedDataSetCollection::SafeDownCast(data)
    ? SplineCollectionContent | PolygonCollectionContent
    : vtkImageData::SafeDownCast(data) ? ImageContent
    : vtkTable::SafeDownCast(data)     ? TableContent
                                       : 0U;
}

/// The format of an ending that data of this type can be written in; null: none.
const FileFormat* FormatFor(vtkDataObject* data, const std::string& ending)
{
  const FileFormat* format = FormatOfEnding(ending);
  return format && (format->Writes & ContentsOf(data)) != 0 ? format : nullptr;
}

/// Whether a format takes the splines of a grid. Grids without splines are no concern of ours.
Status CheckSplines(vtkDataObject* data, const std::string& file, const FileFormat& format,
  bool asCurves, int threads)
{
  if ((format.Writes & SplineGridContent) == 0)
  {
    return {}; // meshes: the writer knows its cells
  }
  const bool isCAD = (format.Writes & SplineCurveContent) == 0;
  const bool takesElements = (format.Writes & SplineElementContent) != 0;
  const auto refuse = [&file](const std::string& reason)
  { return Status(ErrorCode::InvalidParameter, "'" + file + "': " + reason); };
  if (isCAD && asCurves)
  {
    return refuse("curves alone are no CAD model; write .vtu, .xml or .g2");
  }
  const Result<SplineModel> model = DecodeSplineModel(data, threads);
  if (!model)
  {
    return {}; // the job's own error
  }
  std::array<bool, 3> has{};
  for (const SplinePatch& patch : model->Patches)
  {
    has[patch.Geometry.index()] = true;
    const SpaceKind kind =
      std::visit([](const auto& spline) { return spline.Space->Kind; }, patch.Geometry);
    if (!takesElements && (kind == SpaceKind::Bezier || kind == SpaceKind::Explicit))
    {
      return refuse("patch " + std::to_string(patch.Id) +
        " has no knots, and the format needs them; write .vtu, .vtpc or .bext");
    }
  }
  if (isCAD && has[0])
  {
    return refuse("curves alone are no CAD model; write .vtu, .xml or .g2");
  }
  if (isCAD && has[1] && has[2])
  {
    return refuse("surfaces and volumes are written to CAD files of their own");
  }
  if (takesElements && std::count(has.begin(), has.end(), true) > 1)
  {
    return refuse("curves, surfaces and volumes are written to BEXT files of their own");
  }
  return {};
}

Status CheckReadable(const std::string& file)
{
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
  {
    return { ErrorCode::FileError, "'" + file + "' is not a file; check the name" };
  }
  return std::ifstream(file)
    ? Status()
    : Status(ErrorCode::FileError, "'" + file + "' cannot be read; check its permissions");
}

/// Sets what a file of a known format holds.
Status ReadFormat(const FileFormat& format, const std::string& file, DataFile& found)
{
  MessageCapture messages;
  Status status;
  try
  {
    status = format.Read(file, found);
  }
  catch (...) // out of memory: sizes in the file are wrong
  {
    const Status failure = StatusOfException();
    return { failure.Code,
      "'" + file + "' is damaged, or larger than the memory: " + failure.Detail };
  }
  if (status.Detail.empty()) // what our readers say are errors of VTK, and name the file
  {
    status = messages.HasError()
      ? Status(status ? ErrorCode::LibraryError : status.Code, messages.FirstError())
      : Status();
  }
  if (!status)
  {
    return status;
  }
  found.Warnings = messages.Warnings();
  return {};
}
}

Result<DataFile> ReadTableFile(const std::string& file)
{
  const std::string ending = LowerEnding(file);
  if (ending != ".csv" && ending != ".txt")
  {
    return ReadDataFile(file);
  }
  if (Status status = CheckReadable(file); !status)
  {
    return status;
  }
  const Result<std::string> text = TextOfFile(file);
  const Result<NumberTable> read = text ? ReadNumberTable(text.Value) : text.Status;
  if (!read)
  {
    return { read.Status.Code,
      text ? "'" + file + "': " + read.Status.Detail : read.Status.Detail };
  }
  vtkNew<vtkTable> table;
  for (std::size_t c = 0; c < read->Names.size(); ++c)
  {
    const auto column = NamedArray<vtkDoubleArray>(read->Names[c].c_str());
    for (Eigen::Index row = 0; row < read->Numbers.rows(); ++row)
    {
      column->InsertNextValue(read->Numbers(row, static_cast<Eigen::Index>(c)));
    }
    table->AddColumn(column);
  }
  DataFile found;
  found.Data = table;
  return found;
}

Result<DataFile> ReadDataPieces(const std::string& file)
{
  Status status = CheckReadable(file);
  const auto index =
    status ? ReadPieceIndex(file) : Result<std::vector<std::filesystem::path>>(status);
  if (!index)
  {
    return index.Status;
  }
  const Processes::Part part =
    Processes::PartOf(index->size(), Processes::Own(), Processes::Count());
  MessageCapture messages;
  auto read = ReadPieces(file, part.Begin, part.End);
  status = read ? CheckData(read.Value) : read.Status;
  if (!status)
  {
    return { status.Code, read ? "'" + file + "': " + status.Detail : status.Detail };
  }
  DataFile found;
  found.Data = read.Value;
  found.Warnings = messages.Warnings();
  return found;
}

Result<DataFile> ReadDataFile(const std::string& file)
{
  if (Status status = CheckReadable(file); !status)
  {
    return status;
  }
  const std::string ending = LowerEnding(file);
  const FileFormat* format = FormatOfEnding(ending);
  if (!format || format->Reads == 0)
  {
    const std::vector<std::string> known = EndingsThatRead(AnyContent);
    return { ErrorCode::InvalidParameter,
      "'" + file + "' has the ending '" + ending + "'" + SuggestEnding(ending, known) +
        "; formats that can be read: " + JoinEndings(known) };
  }
  DataFile found;
  if (Status status = ReadFormat(*format, file, found); !status)
  {
    return status;
  }
  if (found.Data->GetNumberOfElements(vtkDataObject::POINT) == 0 &&
    found.Data->GetNumberOfElements(vtkDataObject::ROW) == 0)
  {
    return { ErrorCode::EmptyInput, "'" + file + "' holds no points" };
  }
  if (Status status = CheckData(found.Data); !status)
  {
    return { status.Code, "'" + file + "': " + status.Detail };
  }
  return found;
}

Status CheckDataEnding(vtkDataObject* like, const std::string& file)
{
  const std::string ending = LowerEnding(file);
  if (FormatFor(like, ending))
  {
    return {};
  }
  const std::vector<std::string> known = EndingsThatWrite(ContentsOf(like));
  return { ErrorCode::InvalidParameter,
    "'" + file + "': this output is written as " + JoinEndings(known) + "; change the ending" +
      SuggestEnding(ending, known) };
}

Status CheckDataFormat(vtkDataObject* like, const std::string& file, bool asCurves, int threads)
{
  if (Status status = CheckDataEnding(like, file); !status)
  {
    return status;
  }
  const FileFormat* format = FormatOfEnding(LowerEnding(file));
  constexpr unsigned splines = SplineGridContent | SplineCollectionContent;
  if (vtkPolyData::SafeDownCast(like) || format->IsOfVTK || (format->Writes & splines) == 0)
  {
    return {};
  }
  return CheckSplines(like, file, *format, asCurves, threads);
}

Result<std::vector<std::string>> WriteDataFile(
  vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  if (Status status = CheckDataEnding(data, file); !status)
  {
    return status;
  }
  const FileFormat* format = FormatOfEnding(LowerEnding(file));
  MessageCapture messages;
  Status status = format->Write(data, file, params);
  if (status.Detail.empty() && (!status || messages.HasError()))
  {
    status = { status ? ErrorCode::InvalidParameter : status.Code, messages.FirstError() };
  }
  if (!status)
  {
    return status;
  }
  return format->IsOfVTK ? std::vector<std::string>() : messages.Warnings();
}
}
