// SPDX-License-Identifier: BSD-3-Clause
#include "Session.h"

#include "DataCheck.h"
#include "PolygonText.h"

#include <knotwork/CADModel/CADExchange.h>
#include <knotwork/SplineCore/FileEnding.h>
#include <knotwork/SplineCore/FileOutput.h>
#include <knotwork/SplineGrid/FilterErrorCode.h>
#include <knotwork/SplineGrid/SplineModel.h>
#include <knotwork/SplineGrid/vtkSplineAlgorithm.h>
#include <knotwork/SplineIO/FileFormats.h>
#include <knotwork/SplineIO/ForeignFile.h>
#include <knotwork/SplineIO/Messages.h>
#include <knotwork/SplineIO/OneLine.h>
#include <knotwork/SplineIO/vtkCADReader.h>
#include <knotwork/SplineIO/vtkCADWriter.h>
#include <knotwork/SplineIO/vtkDomainBoundaryReader.h>
#include <knotwork/SplineIO/vtkGismoXMLReader.h>
#include <knotwork/SplineIO/vtkGismoXMLWriter.h>
#include <knotwork/SplineIO/vtkGoToolsG2Reader.h>
#include <knotwork/SplineIO/vtkGoToolsG2Writer.h>
#include <knotwork/SplineIO/vtkPointCloudReader.h>
#include <knotwork/SplineIO/vtkPointCloudWriter.h>
#include <knotwork/SurfaceTrimming/TrimmedGrids.h>

#include <vtkAlgorithm.h>
#include <vtkBase64Utilities.h>
#include <vtkCallbackCommand.h>
#include <vtkDataAssembly.h>
#include <vtkDataObject.h>
#include <vtkDelimitedTextWriter.h>
#include <vtkImageData.h>
#include <vtkIndent.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkTable.h>
#include <vtkUnstructuredGrid.h>
#include <vtkWriter.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <system_error>

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
vtkSmartPointer<vtkDataObject> ReadWith(const std::string& file, Session& session)
{
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  session.NoteReader(reader, file);
  return reader->GetOutputDataObject(0);
}

bool IsEmpty(vtkDataObject* data)
{
  return data->GetNumberOfElements(vtkDataObject::POINT) == 0 &&
    data->GetNumberOfElements(vtkDataObject::ROW) == 0;
}

bool HoldsPoints(const std::string& file)
{
  vtkNew<vtkPointCloudReader> reader;
  return reader->CanReadFile(file.c_str()) != 0;
}

/// Sets the session's Curves to the trimming curves of a STEP, IGES or g2 file.
vtkSmartPointer<vtkDataObject> ReadByFormat(
  const std::string& file, FormatFamily family, Session& session)
{
  switch (family)
  {
    case FormatFamily::GismoXML:
      return ReadWith<vtkGismoXMLReader>(file, session);
    case FormatFamily::PointText:
    case FormatFamily::PolygonFile:
      return ReadWith<vtkPointCloudReader>(file, session);
    case FormatFamily::GoToolsG2:
    {
      if (HoldsPoints(file))
      {
        return ReadWith<vtkPointCloudReader>(file, session);
      }
      vtkNew<vtkGoToolsG2Reader> reader;
      reader->SetFileName(file.c_str());
      reader->Update();
      session.NoteReader(reader, file);
      vtkDataObject* curves = reader->GetOutputDataObject(1);
      session.Curves = IsEmpty(curves) ? nullptr : curves;
      return reader->GetOutputDataObject(0);
    }
    case FormatFamily::CAD:
    {
      vtkNew<vtkCADReader> reader;
      reader->SetFileName(file.c_str());
      reader->TriangulationOff();
      reader->Update();
      session.NoteReader(reader, file);
      session.Curves = reader->GetOutputDataObject(1);
      return reader->GetOutputDataObject(0);
    }
    case FormatFamily::BoundaryJSON:
      return ReadWith<vtkDomainBoundaryReader>(file, session);
    case FormatFamily::VTKPolyData: // in a process of their own
    case FormatFamily::VTKGrid:
    case FormatFamily::VTKCollection:
    case FormatFamily::VTKLegacy:
    case FormatFamily::VTKImage:
      break;
  }
  return nullptr;
}

/// What data of this type are to a file.
unsigned ContentsOf(vtkDataObject* data)
{
  return vtkPolyData::SafeDownCast(data)      ? PointContent | PolylineContent | PolygonContent
    : vtkUnstructuredGrid::SafeDownCast(data) ? SplineGridContent
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
Status CheckSplines(
  vtkDataObject* data, const std::string& file, bool isCAD, bool asCurves, int threads)
{
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
    if (kind == SpaceKind::Bezier)
    {
      return refuse("patch " + std::to_string(patch.Id) +
        " has no knots, and the format needs them; write .vtu or .vtpc");
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
  return {};
}

/// VTK's writers crash now and then when a disk is full, so they write to memory.
template <typename Writer>
std::string XmlText(vtkDataObject* data, const std::string& encoding)
{
  vtkNew<Writer> writer;
  writer->SetInputDataObject(data);
  writer->WriteToOutputStringOn();
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
  return writer->Write() == 1 ? writer->GetOutputString() : std::string();
}

Status PutText(const std::string& text, const std::string& file)
{
  FileOutput output(file);
  output.Stream().write(text.data(), static_cast<std::streamsize>(text.size()));
  return output.Finish();
}

template <typename Writer>
Status WriteXml(vtkDataObject* data, const std::string& file, const std::string& encoding)
{
  const std::string text = XmlText<Writer>(data, encoding);
  return text.empty() ? Status(ErrorCode::LibraryError, "") : PutText(text, file);
}

/// A name as the value of an attribute.
std::string Quoted(const std::string& name)
{
  std::string text;
  for (const char c : name)
  {
    text += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return '"' + text + '"';
}

/// The tree of names of a collection, as its format has it.
std::string AssemblyText(vtkDataAssembly* assembly)
{
  const std::string xml = assembly->SerializeToXML(vtkIndent());
  std::vector<unsigned char> encoded(2 * xml.size() + 4);
  const auto length = vtkBase64Utilities::Encode(
    reinterpret_cast<const unsigned char*>(xml.data()), xml.size(), encoded.data());
  return "    <DataAssembly encoding=\"base64\">\n      " +
    std::string(reinterpret_cast<const char*>(encoded.data()), length) + "\n    </DataAssembly>\n";
}

/// Every piece is a file in a folder of the collection's name.
Status WriteCollection(
  vtkPartitionedDataSetCollection* data, const fs::path& file, const std::string& encoding)
{
  const std::string stem = file.stem().string();
  const fs::path folder = file.parent_path() / stem;
  std::error_code failure;
  if (!fs::create_directory(folder, failure))
  {
    return { ErrorCode::FileError, failure.message() };
  }
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile "
                     "type=\"vtkPartitionedDataSetCollection\" version=\"1.0\">\n"
                     "  <vtkPartitionedDataSetCollection>\n";
  for (unsigned int p = 0; p < data->GetNumberOfPartitionedDataSets(); ++p)
  {
    const char* name =
      data->HasMetaData(p) ? data->GetMetaData(p)->Get(vtkCompositeDataSet::NAME()) : nullptr;
    text += "    <Partitions index=\"" + std::to_string(p) + '"' +
      (name ? " name=" + Quoted(name) : std::string()) + ">\n";
    for (unsigned int i = 0; i < data->GetNumberOfPartitions(p); ++i)
    {
      vtkDataObject* piece = data->GetPartitionAsDataObject(p, i);
      if (!piece)
      {
        continue;
      }
      const bool isPolyData = vtkPolyData::SafeDownCast(piece) != nullptr;
      const std::string own =
        stem + "_" + std::to_string(p) + "_" + std::to_string(i) + (isPolyData ? ".vtp" : ".vtu");
      const std::string path = (folder / own).string();
      const Status status = isPolyData
        ? WriteXml<vtkXMLPolyDataWriter>(piece, path, encoding)
        : WriteXml<vtkXMLUnstructuredGridWriter>(piece, path, encoding);
      if (!status)
      {
        return { status.Code, status.Detail.substr(status.Detail.rfind(": ") + 2) };
      }
      text += "      <DataSet index=\"" + std::to_string(i) +
        "\" file=" + Quoted(stem + "/" + own) + "/>\n";
    }
    text += "    </Partitions>\n";
  }
  vtkDataAssembly* assembly = data->GetDataAssembly();
  text += assembly ? AssemblyText(assembly) : std::string();
  text += "  </vtkPartitionedDataSetCollection>\n</VTKFile>\n";
  return PutText(text, file.string());
}

/// A writer of ours tells why it has failed as an error of VTK.
Status Outcome(vtkWriter* writer)
{
  return writer->Write() == 1 ? Status() : Status(CodeOfFilter(writer), "");
}

template <typename Writer>
Status WriteFile(vtkDataObject* data, const std::string& file)
{
  vtkNew<Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  return Outcome(writer);
}

std::string TextOfTable(vtkDataObject* table)
{
  vtkNew<vtkDelimitedTextWriter> writer;
  writer->SetInputDataObject(table);
  writer->WriteToOutputStringOn();
  writer->Write();
  const std::unique_ptr<char[]> text(writer->RegisterAndGetOutputString());
  return text ? text.get() : "";
}

/// What is said of a staged file, said of the one that was asked for.
Status AboutFile(Status status, const std::string& file, const std::string& staged)
{
  const std::string lead = "'" + staged + "' cannot be written: ";
  const auto at = status.Detail.find(lead);
  if (!status)
  {
    status.Detail = "'" + file + "' cannot be written: " +
      (at == std::string::npos ? status.Detail : status.Detail.substr(at + lead.size()));
  }
  return status;
}

Status WriteG2(vtkDataObject* data, vtkDataObject* curves, const std::string& file)
{
  vtkNew<vtkGoToolsG2Writer> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputDataObject(data);
  if (curves)
  {
    writer->SetCurvesData(curves);
  }
  return Outcome(writer);
}

void PrintProgress(vtkObject* caller, unsigned long, void*, void*)
{
  const double share = static_cast<vtkAlgorithm*>(caller)->GetProgress();
  std::fprintf(stderr, "\r%3d %%", static_cast<int>(100.0 * share));
  std::fflush(stderr);
}

}

Result<vtkSmartPointer<vtkDataObject>> Session::Read(const std::string& file)
{
  const FileFormat* format = FormatOfEnding(LowerEnding(file));
  const bool isRead = format && format->Reads != 0;
  return this->ReadWith(file, isRead && IsOfVTK(format->Family),
    [&](const std::string&)
    { return isRead ? ReadByFormat(file, format->Family, *this) : nullptr; });
}

Result<vtkSmartPointer<vtkDataObject>> Session::ReadWith(
  const std::string& file, bool isForeign, const Reading& reading)
{
  const double begin = Now();
  std::error_code error;
  if (!fs::is_regular_file(file, error))
  {
    return { ErrorCode::FileError, "'" + file + "' is not a file; check the name" };
  }
  if (!std::ifstream(file))
  {
    return { ErrorCode::FileError, "'" + file + "' cannot be read; check its permissions" };
  }
  if (Status status = this->Files.CheckInput(file); !status)
  {
    return status;
  }
  const std::string ending = LowerEnding(file);
  vtkSmartPointer<vtkDataObject> data;
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
    catch (...) // out of memory: sizes in the file are wrong
    {
      const Status failure = StatusOfException();
      return { failure.Code,
        "'" + file + "' is damaged, or larger than the memory: " + failure.Detail };
    }
  }
  if (!data)
  {
    const std::vector<std::string> known = EndingsThatRead(AnyContent);
    return { ErrorCode::InvalidParameter,
      "'" + file + "' has the ending '" + ending + "'" + SuggestEnding(ending, known) +
        "; formats that can be read: " + JoinEndings(known) };
  }
  if (messages.HasError())
  {
    return { this->CodeOfReader, messages.FirstError() }; // names the file
  }
  if (IsEmpty(data))
  {
    return { ErrorCode::EmptyInput, "'" + file + "' holds no points" };
  }
  if (Status status = CheckData(data); !status)
  {
    return { status.Code, "'" + file + "': " + status.Detail };
  }
  this->Warn(messages.Warnings());
  this->SecondsOfFiles += Now() - begin;
  return data;
}

void Session::NoteReader(vtkAlgorithm* reader, const std::string& file)
{
  this->CodeOfReader = CodeOfFilter(reader);
  auto* own = vtkSplineAlgorithm::SafeDownCast(reader);
  for (int i = 0; own && i < own->GetNumberOfPartsLeftOut(); ++i)
  {
    this->LeftOut.push_back("'" + file + "': " + own->GetPartLeftOut(i));
  }
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
    return { CodeOfFilter(filter), isNamed ? error : what + ": " + error };
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

Status Session::CheckGridFormat(vtkDataObject* like, const std::string& file, bool asCurves) const
{
  return vtkPolyData::SafeDownCast(like) ? Status() : this->CheckFormat(like, file, asCurves);
}

Status Session::CheckFormat(vtkDataObject* like, const std::string& file, bool asCurves) const
{
  const std::string ending = LowerEnding(file);
  const FileFormat* format = FormatFor(like, ending);
  if (file.empty())
  {
    return {};
  }
  if (!format)
  {
    const std::vector<std::string> known = EndingsThatWrite(ContentsOf(like));
    return { ErrorCode::InvalidParameter,
      "'" + file + "': this output is written as " + JoinEndings(known) + "; change the ending" +
        SuggestEnding(ending, known) };
  }
  const bool asCAD = format->Family == FormatFamily::CAD;
  const bool asSplines =
    format->Family == FormatFamily::GismoXML || format->Family == FormatFamily::GoToolsG2;
  if (vtkPolyData::SafeDownCast(like) || (!asCAD && !asSplines))
  {
    return {};
  }
  return CheckSplines(like, file, asCAD, asCurves, this->Threads);
}

Status Session::Write(vtkDataObject* data, const std::string& file, const std::string& encoding)
{
  const double begin = Now();
  const FileFormat* format = FormatFor(data, LowerEnding(file));
  if (!format)
  {
    return this->CheckFormat(data, file);
  }
  Result<fs::path> staged = this->Files.Stage(file);
  if (!staged)
  {
    return staged.Status;
  }
  MessageCapture messages;
  Status status = WriteAs(format->Family, data, this->BoundaryCurves, staged->string(), encoding);
  if (status.Detail.empty() && (!status || messages.HasError()))
  {
    status = { status ? ErrorCode::InvalidParameter : status.Code, messages.FirstError() };
  }
  const std::vector<std::string> warnings = messages.Warnings();
  if (status && !warnings.empty() && !IsOfVTK(format->Family))
  {
    this->Warn(warnings);
  }
  this->SecondsOfFiles += Now() - begin;
  return AboutFile(status, file, staged->string());
}

Status Session::WriteAs(FormatFamily family, vtkDataObject* data, vtkDataObject* curves,
  const std::string& file, const std::string& encoding)
{
  switch (family)
  {
    case FormatFamily::CAD:
      return WriteFile<vtkCADWriter>(data, file);
    case FormatFamily::GismoXML:
      return WriteFile<vtkGismoXMLWriter>(data, file);
    case FormatFamily::GoToolsG2:
      return vtkPolyData::SafeDownCast(data) ? WriteFile<vtkPointCloudWriter>(data, file)
                                             : WriteG2(data, curves, file);
    case FormatFamily::PointText:
      return vtkTable::SafeDownCast(data) ? PutText(TextOfTable(data), file)
                                          : WriteFile<vtkPointCloudWriter>(data, file);
    case FormatFamily::PolygonFile:
    {
      const auto text = PolygonText(data, LowerEnding(file));
      return text ? PutText(text.Value, file) : text.Status;
    }
    case FormatFamily::VTKGrid:
      return WriteXml<vtkXMLUnstructuredGridWriter>(data, file, encoding);
    case FormatFamily::VTKPolyData:
      return WriteXml<vtkXMLPolyDataWriter>(data, file, encoding);
    case FormatFamily::VTKImage:
      return WriteXml<vtkXMLImageDataWriter>(data, file, encoding);
    case FormatFamily::VTKCollection:
      return WriteCollection(vtkPartitionedDataSetCollection::SafeDownCast(data), file, encoding);
    case FormatFamily::VTKLegacy:
    case FormatFamily::BoundaryJSON:
      break;
  }
  return { ErrorCode::InvalidParameter, "there is no such format" };
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
    auto summary = CheckCAD(staged->string(), LengthUnit::Millimetre, false); // none reports it
    status = summary ? CompareCAD(model.Value, summary.Value) : summary.Status;
    found = std::move(summary.Value);
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
