// SPDX-License-Identifier: BSD-3-Clause
#include "Session.h"

#include "Termination.h"

#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/Processes.h>
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>
#include <knotwork/SplineIO/Messages.h>
#include <knotwork/SplineIO/OneLine.h>
#include <knotwork/SplineIO/PieceFiles.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <map>
#include <string>

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

/// Largest memory of the program so far, in bytes.
struct PeakMemory
{
  long long All = 0;
  /// Without pages of files, most of them libraries, and what it shares with other processes.
  long long Own = 0;
};

/// Not getrusage's, which begins with that of the process that has started this one.
PeakMemory FindPeakMemory()
{
  std::ifstream status("/proc/self/status");
  std::map<std::string, long long> kilobytes;
  for (std::string line; std::getline(status, line);)
  {
    for (const char* name : { "VmHWM:", "RssFile:", "RssShmem:" })
    {
      if (line.rfind(name, 0) == 0)
      {
        kilobytes[name] = std::atoll(line.c_str() + std::strlen(name));
      }
    }
  }
  const long long all = 1024 * kilobytes["VmHWM:"];
  if (all > 0)
  {
    return { all, all - 1024 * (kilobytes["RssFile:"] + kilobytes["RssShmem:"]) };
  }
  rusage usage{}; // there is no /proc
  getrusage(RUSAGE_SELF, &usage);
  return { 1024LL * usage.ru_maxrss, 1024LL * usage.ru_maxrss };
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
  return this->ReadWith(asTable ? ReadTableFile : ReadDataFile, file);
}

Result<vtkSmartPointer<vtkDataObject>> Session::ReadPieces(const std::string& file)
{
  return this->ReadWith(ReadDataPieces, file);
}

Result<vtkSmartPointer<vtkDataObject>> Session::ReadWith(
  Result<DataFile> (*read)(const std::string&), const std::string& file)
{
  const double begin = Now();
  Status status = this->Files.CheckInput(file);
  auto found = status ? read(file) : Result<DataFile>(status);
  status = Processes::Agree(found.Status);
  if (!status)
  {
    return status;
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

long long Session::Total(long long own)
{
  long long total = 0;
  for (const auto& one : Processes::Exchange(std::vector<long long>{ own }))
  {
    total += one.front();
  }
  return total;
}

double Session::Largest(double own)
{
  double largest = own;
  for (const auto& one : Processes::Exchange(std::vector<double>{ own }))
  {
    largest = std::max(largest, one.front());
  }
  return largest;
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
  const bool show = !this->Quiet && Processes::Own() == 0 && isatty(STDERR_FILENO) == 1;
  if (show)
  {
    filter->AddObserver(vtkCommand::ProgressEvent, progress);
  }
  MessageCapture messages;
  this->Measure(
    [filter]
    {
      Processes::Count() == 1 ? filter->Update()
                              : static_cast<void>(vtkAlgorithm::SafeDownCast(filter)->UpdatePiece(
                                  Processes::Own(), Processes::Count(), 0));
      return Status();
    });
  if (show)
  {
    filter->RemoveObserver(progress);
    std::fputs("\r     \r", stderr);
  }
  Status outcome;
  if (messages.HasError() || filter->GetErrorCode() != 0)
  {
    const std::string error = messages.FirstError();
    const bool isNamed = error.find(what) != std::string::npos; // readers name their file
    // a failure of all is told by one of them
    outcome = { CodeOfFilter(filter), isNamed || error.empty() ? error : what + ": " + error };
  }
  outcome = Processes::Agree(outcome);
  if (!outcome)
  {
    return outcome;
  }
  if (Session::Total(IsEmpty(filter->GetOutputDataObject(port)) ? 0 : 1) == 0)
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
    std::cerr << (this->Quiet || Processes::Own() != 0 ? "" : OneLine(warning) + "\n");
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

Status Session::Write(vtkDataObject* data, const std::string& file, const DataFileParams& params)
{
  const double begin = Now();
  if (Processes::Count() > 1 && IsPieceIndex(file))
  {
    return this->WriteInPieces(data, file, params.Encoding);
  }
  const Status status = Processes::Agree(CheckDataEnding(data, file));
  const Result<fs::path> staged = status ? this->Stage(file) : Result<fs::path>(status);
  if (!staged || Processes::Own() != 0)
  {
    return staged ? Processes::Agree({}) : staged.Status;
  }
  DataFileParams all = params;
  all.Curves = this->BoundaryCurves;
  all.Threads = this->Threads;
  auto written = WriteDataFile(data, staged->string(), all);
  this->Warn(written.Value);
  this->SecondsOfFiles += Now() - begin;
  return Processes::Agree(AboutFile(written.Status, file, staged->string()));
}

Status Session::WriteInPieces(
  vtkDataObject* data, const std::string& file, const std::string& encoding)
{
  const double begin = Now();
  const auto own = static_cast<std::size_t>(Processes::Own());
  Status status = Processes::Agree(CheckDataEnding(data, file));
  const Result<fs::path> staged = status ? this->Stage(file) : Result<fs::path>(status);
  if (!staged)
  {
    return staged.Status;
  }
  const std::string index = staged->string();
  auto* piece = vtkDataSet::SafeDownCast(data);
  MessageCapture messages;
  status = IsEmpty(data) ? Status() : WritePiece(piece, own, index, encoding, this->Threads);
  if (status.Detail.empty() && !status)
  {
    status.Detail = messages.FirstError();
  }
  status = Processes::Agree(AboutFile(status, file, index));
  // pieces without points are no pieces; the first that has some knows the arrays
  std::vector<std::size_t> numbers;
  std::size_t number = 0;
  for (const int isPiece : Processes::ExchangeNumber(IsEmpty(data) ? 0 : 1))
  {
    if (isPiece != 0)
    {
      numbers.push_back(number);
    }
    ++number;
  }
  if (status && !numbers.empty() && own == numbers.front())
  {
    status = WritePieceIndex(piece, numbers, index);
  }
  this->SecondsOfFiles += Now() - begin;
  return Processes::Agree(AboutFile(status, file, index));
}

Result<fs::path> Session::Stage(const std::string& file)
{
  Result<fs::path> staged;
  if (Processes::Own() == 0)
  {
    staged = this->Files.Stage(file);
  }
  const Status status = Processes::Agree(staged.Status);
  if (!status)
  {
    return status;
  }
  const fs::path place = Processes::Broadcast(staged->string());
  if (Processes::Own() != 0)
  {
    Termination::Folders::Guard(place.parent_path());
  }
  return place;
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
  const Result<fs::path> staged = this->Stage(file);
  if (!staged || Processes::Own() != 0)
  {
    return staged ? Processes::Agree({}) : staged.Status;
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
  return Processes::Agree(AboutFile(status, file, staged->string()));
}

Status Session::Commit()
{
  constexpr int PartLeftOut = 5;
  this->ExitStatus =
    this->ExitStatus == 0 && !this->LeftOut.empty() ? PartLeftOut : this->ExitStatus;
  this->Report["left_out"] = this->LeftOut;
  if (Processes::Count() > 1)
  {
    this->ReportProcesses();
    Termination::Folders::Unguard();
    static_cast<void>(Processes::Agree({})); // all have let go
    if (Processes::Own() != 0)
    {
      return Processes::Agree({});
    }
  }
  Status status;
  if (!this->ReportFile.empty())
  {
    this->Report["seconds"] = this->Seconds;
    this->Report["cpu_seconds"] = this->CpuSeconds;
    this->Report["seconds_io"] = this->SecondsOfFiles;
    const PeakMemory memory = FindPeakMemory();
    this->Report["peak_bytes"] = memory.All;
    this->Report["peak_own_bytes"] = memory.Own;
    // not all text of a report need be sound: names of files are bytes
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    const std::string text = this->Report.dump(2, ' ', false, replace) + "\n";
    status = this->WriteText(text, this->ReportFile);
  }
  return Processes::Agree(status ? this->Files.Commit() : status);
}

void Session::ReportProcesses()
{
  const Processes::Traffic told = Processes::TrafficSoFar();
  const PeakMemory memory = FindPeakMemory();
  const std::vector<double> own{ this->Seconds, this->CpuSeconds, static_cast<double>(memory.All),
    static_cast<double>(memory.Own), static_cast<double>(told.Messages),
    static_cast<double>(told.Bytes) };
  const auto all = Processes::Exchange(own);
  this->Report["ranks"] = Processes::Count();
  std::size_t number = 0;
  for (const char* key : { "rank_seconds", "rank_cpu_seconds", "rank_peak_bytes",
         "rank_peak_own_bytes", "rank_messages", "rank_sent_bytes" })
  {
    std::vector<double> values;
    for (const std::vector<double>& one : all)
    {
      values.push_back(one[number]);
    }
    this->Report[key] = values;
    ++number;
  }
}
}
