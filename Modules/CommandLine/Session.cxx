// SPDX-License-Identifier: BSD-3-Clause
#include "Session.h"

#include "OffFile.h"

#include "CADExchange.h"
#include "FileEnding.h"
#include "ForeignFile.h"
#include "Messages.h"
#include "OneLine.h"
#include "TrimmedGrids.h"
#include "vtkCADReader.h"
#include "vtkCADWriter.h"
#include "vtkDomainBoundaryReader.h"
#include "vtkGismoXMLReader.h"
#include "vtkGismoXMLWriter.h"
#include "vtkGoToolsG2Reader.h"
#include "vtkGoToolsG2Writer.h"
#include "vtkPointCloudReader.h"
#include "vtkPointCloudWriter.h"

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkDataObject.h>
#include <vtkDelimitedTextWriter.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPartitionedDataSetCollectionWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>

#include <sys/resource.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace knotwork
{
namespace
{
double Now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double CpuNow()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Largest memory of the process so far.
long long PeakBytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024LL * usage.ru_maxrss;
}

template <typename Reader>
vtkSmartPointer<vtkDataObject> ReadWith(const std::string& file)
{
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutputDataObject(0);
}

bool IsEmpty(vtkDataObject* data)
{
  return data->GetNumberOfElements(vtkDataObject::POINT) == 0 &&
    data->GetNumberOfElements(vtkDataObject::ROW) == 0;
}

/// Text of a point a line.
bool IsPointEnding(const std::string& ending)
{
  return ending == ".xyz" || ending == ".txt" || ending == ".csv";
}

bool HoldsPoints(const std::string& file)
{
  vtkNew<vtkPointCloudReader> reader;
  return reader->CanReadFile(file.c_str()) != 0;
}

/// @param curves  set to the trimming curves of a STEP, IGES or g2 file.
vtkSmartPointer<vtkDataObject> ReadByEnding(
  const std::string& file, const std::string& ending, vtkSmartPointer<vtkDataObject>& curves)
{
  if (ending == ".xml")
  {
    return ReadWith<vtkGismoXMLReader>(file);
  }
  if (IsPointEnding(ending) || (ending == ".g2" && HoldsPoints(file)))
  {
    return ReadWith<vtkPointCloudReader>(file);
  }
  if (ending == ".g2")
  {
    vtkNew<vtkGoToolsG2Reader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    curves = IsEmpty(reader->GetOutputDataObject(1)) ? nullptr : reader->GetOutputDataObject(1);
    return reader->GetOutputDataObject(0);
  }
  if (HasCADEnding(file))
  {
    vtkNew<vtkCADReader> reader;
    reader->SetFileName(file.c_str());
    reader->TriangulationOff();
    reader->Update();
    curves = reader->GetOutputDataObject(1);
    return reader->GetOutputDataObject(0);
  }
  if (ending == ".json")
  {
    return ReadWith<vtkDomainBoundaryReader>(file);
  }
  return nullptr;
}

template <typename Writer>
bool WriteWith(vtkDataObject* data, const fs::path& file, const std::string& encoding)
{
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  if (encoding == "ascii")
  {
    writer->SetDataModeToAscii();
  }
  else if (encoding == "binary")
  {
    writer->SetDataModeToBinary();
  }
  else
  {
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
  }
  return writer->Write() == 1;
}

template <typename Writer>
bool WriteFile(vtkDataObject* data, const fs::path& file)
{
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  return writer->Write() == 1;
}

bool WriteG2(vtkDataObject* data, vtkDataObject* curves, const fs::path& file)
{
  vtkNew<vtkGoToolsG2Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  if (curves)
  {
    writer->SetCurvesData(curves);
  }
  return writer->Write() == 1;
}

void PrintProgress(vtkObject* caller, unsigned long, void*, void*)
{
  const double share = static_cast<vtkAlgorithm*>(caller)->GetProgress();
  std::fprintf(stderr, "\r%3d %%", static_cast<int>(100.0 * share));
  std::fflush(stderr);
}

}

Session::~Session()
{
  for (const StagedFile& staged : this->Staged)
  {
    std::error_code ignored;
    fs::remove_all(staged.Folder, ignored);
  }
}

Result<vtkSmartPointer<vtkDataObject>> Session::Read(const std::string& file)
{
  return this->ReadWith(file, HasVTKEnding(file),
    [&](const std::string& known) { return ReadByEnding(file, known, this->Curves); });
}

Result<vtkSmartPointer<vtkDataObject>> Session::ReadPoints(const std::string& file)
{
  if (LowerEnding(file) != ".ply")
  {
    return this->Read(file);
  }
  return this->ReadWith(
    file, false, [&](const std::string&) { return knotwork::ReadWith<vtkPointCloudReader>(file); });
}

Result<vtkSmartPointer<vtkDataObject>> Session::ReadWith(
  const std::string& file, bool isForeign, const Reading& reading)
{
  const double begin = Now();
  std::error_code error;
  if (!fs::is_regular_file(file, error))
  {
    return { ErrorCode::EmptyInput, "'" + file + "' is not a file; check the name" };
  }
  if (!std::ifstream(file))
  {
    return { ErrorCode::EmptyInput, "'" + file + "' cannot be read; check its permissions" };
  }
  const std::string ending = LowerEnding(file);
  vtkSmartPointer<vtkDataObject> data;
  if (ending == ".off")
  {
    auto mesh = ReadOffFile(file);
    if (!mesh)
    {
      return mesh.Status;
    }
    if (IsEmpty(mesh.Value))
    {
      return { ErrorCode::EmptyInput, "'" + file + "' holds no points" };
    }
    this->SecondsOfFiles += Now() - begin;
    return vtkSmartPointer<vtkDataObject>(mesh.Value);
  }
  MessageCapture messages;
  if (isForeign)
  {
    auto read = ReadVTKFile(file);
    if (!read)
    {
      return read.Status;
    }
    data = read.Value;
  }
  else
  {
    try
    {
      data = reading(ending);
    }
    catch (const std::exception& failure) // out of memory: sizes in the file are wrong
    {
      return { ErrorCode::TooLarge,
        "'" + file + "' is damaged, or larger than the memory: " + failure.what() };
    }
  }
  if (!data)
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "' has the ending '" + ending +
        "'; formats that can be read: .vtu .vtp .vtpc .vtk .xml .g2 .json .step .iges .off .obj "
        ".ply .stl .xyz .txt .csv" };
  }
  if (messages.HasError())
  {
    return { ErrorCode::InvalidFormat, messages.FirstError() }; // names the file
  }
  if (IsEmpty(data))
  {
    return { ErrorCode::EmptyInput, "'" + file + "' holds no points" };
  }
  this->SecondsOfFiles += Now() - begin;
  return data;
}

Status Session::Run(vtkAlgorithm* filter, const std::string& what, int port)
{
  vtkNew<vtkCallbackCommand> progress;
  progress->SetCallback(PrintProgress);
  const bool show = !this->Quiet && isatty(STDERR_FILENO) == 1;
  if (show)
  {
    filter->AddObserver(vtkCommand::ProgressEvent, progress);
  }
  const double begin = Now();
  const double cpuBegin = CpuNow();
  MessageCapture messages;
  filter->Update();
  this->Seconds += Now() - begin;
  this->CpuSeconds += CpuNow() - cpuBegin;
  if (show)
  {
    filter->RemoveObserver(progress);
    std::fputs("\r     \r", stderr);
  }
  if (messages.HasError() || filter->GetErrorCode() != 0)
  {
    const std::string error = messages.FirstError();
    const bool isNamed = error.find(what) != std::string::npos; // readers name their file
    return { ErrorCode::InvalidTopology, isNamed ? error : what + ": " + error };
  }
  if (IsEmpty(filter->GetOutputDataObject(port)))
  {
    return { ErrorCode::EmptyInput, what + ": there are no cells to work on; check the input" };
  }
  this->Warn(messages.Warnings());
  return {};
}

void Session::Warn(const std::vector<std::string>& warnings) const
{
  for (const std::string& warning : warnings)
  {
    std::cerr << (this->Quiet ? "" : OneLine(warning) + "\n");
  }
}

Result<fs::path> Session::Stage(const std::string& file)
{
  const fs::path target = fs::absolute(file);
  const fs::path folder = target.parent_path();
  std::error_code error;
  if (target.filename().empty() || !fs::is_directory(folder, error))
  {
    return { ErrorCode::InvalidParameter, "'" + file + "': there is no folder for it" };
  }
  std::string name = (folder / ".knotwork-XXXXXX").string();
  if (!mkdtemp(name.data()))
  {
    return { ErrorCode::InvalidParameter, "'" + file + "': the folder cannot be written to" };
  }
  this->Staged.push_back({ name, folder });
  return fs::path(name) / target.filename();
}

Status Session::Write(vtkDataObject* data, const std::string& file, const std::string& encoding)
{
  const double begin = Now();
  const std::string ending = LowerEnding(file);
  const auto grid = vtkUnstructuredGrid::SafeDownCast(data);
  const auto polydata = vtkPolyData::SafeDownCast(data);
  const auto collection = vtkPartitionedDataSetCollection::SafeDownCast(data);
  const auto table = vtkTable::SafeDownCast(data);
  const auto image = vtkImageData::SafeDownCast(data);
  const char* expected = grid ? ".vtu"
    : polydata                ? ".vtp"
    : collection              ? ".vtpc"
    : image                   ? ".vti"
                              : ".csv";
  const bool asSplines = grid && (ending == ".xml" || ending == ".g2");
  const bool asCAD = (grid || collection) && HasCADEnding(file);
  const bool asPoints = polydata && (IsPointEnding(ending) || ending == ".g2");
  if (ending != expected && !asSplines && !asCAD && !asPoints)
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "': this output is written as " + expected +
        (grid          ? ", .xml, .g2, .step or .iges"
            : polydata ? ", its points as .xyz, .txt, .csv or .g2"
                       : "") +
        "; change the ending" };
  }
  Result<fs::path> staged = this->Stage(file);
  if (!staged)
  {
    return staged.Status;
  }
  MessageCapture messages;
  bool written = true;
  if (asCAD)
  {
    written = WriteFile<vtkCADWriter>(data, staged.Value);
    this->Warn(messages.HasError() ? std::vector<std::string>() : messages.Warnings());
  }
  else if (asSplines)
  {
    written = ending == ".xml" ? WriteFile<vtkGismoXMLWriter>(data, staged.Value)
                               : WriteG2(data, this->BoundaryCurves, staged.Value);
  }
  else if (asPoints)
  {
    written = WriteFile<vtkPointCloudWriter>(data, staged.Value);
    this->Warn(messages.HasError() ? std::vector<std::string>() : messages.Warnings());
  }
  else if (grid)
  {
    written = WriteWith<vtkXMLUnstructuredGridWriter>(data, staged.Value, encoding);
  }
  else if (polydata)
  {
    written = WriteWith<vtkXMLPolyDataWriter>(data, staged.Value, encoding);
  }
  else if (image)
  {
    written = WriteWith<vtkXMLImageDataWriter>(data, staged.Value, encoding);
  }
  else if (collection)
  {
    written = WriteWith<vtkXMLPartitionedDataSetCollectionWriter>(data, staged.Value, encoding);
  }
  else
  {
    vtkNew<vtkDelimitedTextWriter> writer;
    writer->SetFileName(staged.Value.c_str());
    writer->SetInputDataObject(table);
    written = writer->Write() == 1;
  }
  if (!written || messages.HasError())
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "' cannot be written: " + messages.FirstError() };
  }
  this->SecondsOfFiles += Now() - begin;
  return {};
}

Status Session::WriteOutputs(vtkAlgorithm* filter, const std::vector<std::string>& files)
{
  for (std::size_t port = 0; port < files.size(); ++port)
  {
    if (files[port].empty())
    {
      continue;
    }
    vtkDataObject* output = filter->GetOutputDataObject(static_cast<int>(port));
    if (Status status = this->Write(output, files[port]); !status)
    {
      return status;
    }
  }
  return {};
}

Status Session::WriteFaces(
  vtkDataObject* surfaces, vtkDataObject* curves, const std::string& file, CADSummary& found)
{
  const double begin = Now();
  Result<fs::path> staged = this->Stage(file);
  if (!staged)
  {
    return staged.Status;
  }
  auto model = DecodeTrimmedModel(surfaces, curves);
  Status status = model ? WriteCAD(model.Value, staged->string()) : model.Status;
  if (status)
  {
    auto summary = CheckCAD(staged->string());
    status = summary.Status;
    found = std::move(summary.Value);
  }
  this->SecondsOfFiles += Now() - begin;
  return status ? status
                : Status(status.Code, "'" + file + "' cannot be written: " + status.Detail);
}

Status Session::Commit()
{
  if (!this->ReportFile.empty())
  {
    this->Report["seconds"] = this->Seconds;
    this->Report["cpu_seconds"] = this->CpuSeconds;
    this->Report["seconds_io"] = this->SecondsOfFiles;
    this->Report["peak_bytes"] = PeakBytes();
    Result<fs::path> staged = this->Stage(this->ReportFile);
    if (!staged)
    {
      return staged.Status;
    }
    std::ofstream stream(staged.Value);
    // names of files may be any bytes
    stream << this->Report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
    if (!stream.flush())
    {
      return { ErrorCode::InvalidParameter, "'" + this->ReportFile + "' cannot be written" };
    }
  }
  for (const StagedFile& staged : this->Staged)
  {
    for (const fs::directory_entry& entry : fs::directory_iterator(staged.Folder))
    {
      const fs::path target = staged.Target / entry.path().filename();
      std::error_code error;
      if (entry.is_directory())
      {
        fs::remove_all(target, error); // the pieces of an older .vtpc
      }
      fs::rename(entry.path(), target, error);
      if (error)
      {
        return { ErrorCode::InvalidParameter,
          "'" + target.string() + "' cannot be written: " + error.message() };
      }
    }
  }
  return {};
}
}
