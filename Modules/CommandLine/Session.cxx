// SPDX-License-Identifier: BSD-3-Clause
#include "Session.h"

#include "Termination.h"

#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>
#include <knotwork/SplineIO/DataFile.h>
#include <knotwork/SplineIO/Messages.h>
#include <knotwork/SplineIO/OneLine.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <chrono>
#include <cstdio>
#include <ctime>
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

bool IsEmpty(vtkDataObject* data)
{
  return data->GetNumberOfElements(vtkDataObject::POINT) == 0 &&
    data->GetNumberOfElements(vtkDataObject::ROW) == 0;
}

void PrintProgress(vtkObject* caller, unsigned long, void*, void*)
{
  const double share = static_cast<vtkAlgorithm*>(caller)->GetProgress();
  std::fprintf(stderr, "\r%3d %%", static_cast<int>(100.0 * share));
  std::fflush(stderr);
}

}

Session::Session() : Files(std::make_shared<Termination::Folders>()) {}

Result<vtkSmartPointer<vtkDataObject>> Session::Read(const std::string& file, bool asTable)
{
  const double begin = Now();
  if (Status status = this->Files.CheckInput(file); !status)
  {
    return status;
  }
  auto found = asTable ? ReadTableFile(file) : ReadDataFile(file);
  if (!found)
  {
    return found.Status;
  }
  for (const std::string& part : found->LeftOut)
  {
    this->LeftOut.push_back("'" + file + "': " + part);
  }
  this->Curves = found->Curves;
  this->Warn(found->Warnings);
  this->SecondsOfFiles += Now() - begin;
  return found->Data;
}

Status Session::Measure(const std::function<Status()>& work)
{
  const double begin = Now();
  const double cpuBegin = CpuNow();
  Status status = work();
  this->Seconds += Now() - begin;
  this->CpuSeconds += CpuNow() - cpuBegin;
  return status;
}

void Session::NoteReader(vtkAlgorithm* reader, const std::string& file)
{
  auto* own = vtkSplineAlgorithm::SafeDownCast(reader);
  for (int i = 0; own && i < own->GetNumberOfPartsLeftOut(); ++i)
  {
    this->LeftOut.push_back("'" + file + "': " + own->GetPartLeftOut(i));
  }
}

Status Session::Run(
  vtkAlgorithm* filter, const std::string& what, int port, std::vector<std::string>* warnings)
{
  vtkNew<vtkCallbackCommand> progress;
  progress->SetCallback(PrintProgress);
  const bool show = !this->Quiet && isatty(STDERR_FILENO) == 1;
  if (show)
  {
    filter->AddObserver(vtkCommand::ProgressEvent, progress);
  }
  MessageCapture messages;
  this->Measure(
    [filter]
    {
      filter->Update();
      return Status();
    });
  if (show)
  {
    filter->RemoveObserver(progress);
    std::fputs("\r     \r", stderr);
  }
  if (messages.HasError() || filter->GetErrorCode() != 0)
  {
    const std::string error = messages.FirstError();
    const bool isNamed = error.find(what) != std::string::npos; // readers name their file
    return { CodeOfFilter(filter), isNamed ? error : what + ": " + error };
  }
  if (IsEmpty(filter->GetOutputDataObject(port)))
  {
    return { ErrorCode::EmptyInput, what + ": there are no cells to work on; check the input" };
  }
  if (warnings)
  {
    *warnings = messages.Warnings();
  }
  else
  {
    this->Warn(messages.Warnings());
  }
  return {};
}

void Session::Warn(const std::vector<std::string>& warnings) const
{
  for (const std::string& warning : warnings)
  {
    std::cerr << (this->Quiet ? "" : OneLine(warning) + "\n");
  }
}

Status Session::CheckGridFormat(vtkDataObject* like, const std::string& file, bool asCurves) const
{
  return vtkPolyData::SafeDownCast(like) ? Status() : this->CheckFormat(like, file, asCurves);
}

Status Session::CheckFormat(vtkDataObject* like, const std::string& file, bool asCurves) const
{
  return file.empty() ? Status() : CheckDataFormat(like, file, asCurves, this->Threads);
}

Status Session::Write(vtkDataObject* data, const std::string& file, const std::string& encoding)
{
  const double begin = Now();
  if (Status status = CheckDataEnding(data, file); !status)
  {
    return status;
  }
  Result<fs::path> staged = this->Files.Stage(file);
  if (!staged)
  {
    return staged.Status;
  }
  DataFileParams params;
  params.Curves = this->BoundaryCurves;
  params.Encoding = encoding;
  auto written = WriteDataFile(data, staged->string(), params);
  this->Warn(written.Value);
  this->SecondsOfFiles += Now() - begin;
  return AboutFile(written.Status, file, staged->string());
}

Status Session::WriteText(const std::string& text, const std::string& file)
{
  Result<fs::path> staged = this->Files.Stage(file);
  return staged ? AboutFile(PutText(text, staged->string()), file, staged->string())
                : staged.Status;
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
  Result<fs::path> staged = this->Files.Stage(file);
  if (!staged)
  {
    return staged.Status;
  }
  auto model = DecodeTrimmedModel(surfaces, curves);
  Status status = model ? WriteCAD(model.Value, staged->string()) : model.Status;
  if (status)
  {
    auto summary = CheckWrittenCAD(model.Value, staged->string());
    status = summary.Status;
    found = std::move(summary.Value);
    std::error_code ignored;
    this->Report["file_bytes"] = fs::file_size(staged.Value, ignored);
  }
  this->SecondsOfFiles += Now() - begin;
  return AboutFile(status, file, staged->string());
}

Status Session::Commit()
{
  constexpr int PartLeftOut = 5;
  this->ExitStatus =
    this->ExitStatus == 0 && !this->LeftOut.empty() ? PartLeftOut : this->ExitStatus;
  this->Report["left_out"] = this->LeftOut;
  if (!this->ReportFile.empty())
  {
    this->Report["seconds"] = this->Seconds;
    this->Report["cpu_seconds"] = this->CpuSeconds;
    this->Report["seconds_io"] = this->SecondsOfFiles;
    this->Report["peak_bytes"] = PeakBytes();
    // not all text of a report need be sound: names of files are bytes
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    const std::string text = this->Report.dump(2, ' ', false, replace) + "\n";
    if (Status status = this->WriteText(text, this->ReportFile); !status)
    {
      return status;
    }
  }
  return this->Files.Commit();
}
}
