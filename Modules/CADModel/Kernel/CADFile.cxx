// SPDX-License-Identifier: BSD-3-Clause
#include "CADFile.h"

#include "IGESSplines.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_InterfaceModel.hxx>
#include <OSD_FileSystem.hxx>
#include <Standard_IStream.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <sstream>

namespace knotwork
{
namespace
{
/// First and last characters of a file.
struct Ends
{
  bool Opened = false;
  std::string First;
  std::string Last;
};

Ends ReadEnds(const std::string& file)
{
  constexpr std::streamoff Length = 2048;
  Ends ends;
  const auto stream =
    OSD_FileSystem::DefaultFileSystem()->OpenIStream(file.c_str(), std::ios::in | std::ios::binary);
  if (!stream || !*stream)
  {
    return ends;
  }
  const auto read = [&](std::streamoff count)
  {
    std::string text(static_cast<std::size_t>(count), '\0');
    stream->read(text.data(), count);
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(stream->gcount(), 0)));
    stream->clear();
    return text;
  };
  ends.First = read(Length);
  ends.Opened = true;
  stream->seekg(0, std::ios::end);
  const std::streamoff size = stream->tellg();
  if (size > 0)
  {
    stream->seekg(std::max<std::streamoff>(size - Length, 0));
    ends.Last = read(std::min(size, Length));
  }
  return ends;
}

/// The last line of a BREP file names the shape that it holds: its orientation and number, and its
/// location.
bool EndsWithShape(const std::string& text)
{
  const std::size_t end = text.find_last_not_of(" \r\n\t");
  const std::size_t line = end == std::string::npos ? end : text.find_last_of("\r\n", end);
  if (line == std::string::npos)
  {
    return false;
  }
  std::istringstream words(text.substr(line + 1, end - line));
  char orientation = 0;
  int shape = 0;
  int location = -1;
  return words >> orientation >> shape >> location &&
    std::string("+-ie").find(orientation) != std::string::npos && shape > 0 && location >= 0;
}

Status CheckBREPText(const Ends& ends)
{
  if (ends.First.find("CASCADE Topology V") == std::string::npos)
  {
    return { ErrorCode::InvalidFormat,
      "this is not a BREP file of text: no 'CASCADE Topology' at its begin" };
  }
  if (!EndsWithShape(ends.Last))
  {
    return { ErrorCode::InvalidFormat, "the file is truncated: no shape is named at its end" };
  }
  return {};
}

/// What OpenCASCADE would read as far as it goes without a word.
Status CheckText(const Ends& ends, CADFormat format)
{
  if (format == CADFormat::STEP)
  {
    if (ends.First.find("ISO-10303-21") == std::string::npos)
    {
      return { ErrorCode::InvalidFormat, "this is not a STEP file: no ISO-10303-21 at its begin" };
    }
    if (ends.Last.find("END-ISO-10303-21") == std::string::npos)
    {
      return { ErrorCode::InvalidFormat, "the file is truncated: no END-ISO-10303-21 at its end" };
    }
    return {};
  }
  if (format == CADFormat::BREP)
  {
    return CheckBREPText(ends);
  }
  // lines of 80 characters, the section's letter in column 73
  constexpr std::size_t Column = 72;
  if (ends.First.size() <= Column || ends.First[Column] != 'S')
  {
    return { ErrorCode::InvalidFormat, "this is not an IGES file: no start section" };
  }
  const std::size_t end = ends.Last.find_last_not_of(" \r\n\t\0");
  const std::size_t begin = ends.Last.find_last_of("\r\n", end);
  const std::size_t line = begin == std::string::npos ? 0 : begin + 1;
  if (ends.Last.size() <= line + Column || ends.Last[line + Column] != 'T')
  {
    return { ErrorCode::InvalidFormat, "the file is truncated: no terminate section" };
  }
  return {};
}

/// A message of OpenCASCADE without what it says to itself: after a colon, or nothing.
std::string Reason(std::string text)
{
  const auto remove = [&text](const std::string& part, const std::string& instead)
  {
    if (const std::size_t at = text.find(part); at != std::string::npos)
    {
      text.replace(at, part.size(), instead);
    }
  };
  remove("Undefined Parsing: ", "");
  remove(" Process continues.", "");
  remove("parameter %d", "a parameter");
  if (text.find("Unknown message") != std::string::npos)
  {
    return {};
  }
  if (const std::size_t at = text.find("** Exception Raised"); at != std::string::npos)
  {
    text.replace(at, std::string::npos, "its references cannot be followed");
  }
  while (!text.empty() && (text.back() == '.' || text.back() == ' '))
  {
    text.pop_back();
  }
  return text.empty() ? text : ": " + text;
}

Status Damaged(const std::string& what)
{
  return { ErrorCode::InvalidFormat, "the file is damaged" + what + "; write it again" };
}

/// Failures of syntax and of geometry or topology: OpenCASCADE would go on with what is missing.
Status CheckEntities(const XSControl_Reader& reader)
{
  Interface_CheckIterator checks = reader.WS()->ModelCheckList(true);
  for (checks.Start(); checks.More(); checks.Next())
  {
    const Handle(Interface_Check)& check = checks.Value();
    if (!check->HasFailed())
    {
      continue;
    }
    const std::string text = check->CFail(1);
    if (checks.Number() <= 0)
    {
      if (text.find("syntax") != std::string::npos)
      {
        return Damaged(Reason(text));
      }
      continue;
    }
    const std::string type = reader.Model()->Value(checks.Number())->DynamicType()->Name();
    for (const char* prefix : { "StepGeom_", "StepShape_", "StepRepr_", "IGESGeom_", "IGESSolid_" })
    {
      if (type.rfind(prefix, 0) == 0)
      {
        return Damaged(": " + type.substr(type.find('_') + 1) + Reason(text));
      }
    }
  }
  return {};
}

/// What the name and the first and last characters of a file tell.
Status CheckEnds(const std::string& file, CADFormat format)
{
  const std::string place = "'" + file + "'";
  if (format == CADFormat::Unknown)
  {
    return { ErrorCode::InvalidParameter,
      place + ": the ending must be .step, .stp, .iges, .igs or .brep" };
  }
  const Ends ends = ReadEnds(file);
  if (!ends.Opened || ends.First.empty())
  {
    return { ends.Opened ? ErrorCode::EmptyInput : ErrorCode::FileError,
      place +
        (ends.Opened ? " is empty or a folder"
                     : " cannot be read; check its name and permissions") };
  }
  const Status status = CheckText(ends, format);
  return status ? status : Status(status.Code, place + ": " + status.Detail);
}
}

Status LoadCAD(XSControl_Reader& reader, CADFormat format, const std::string& file, int& numMended)
{
  numMended = 0;
  const std::string place = "'" + file + "'";
  if (Status status = CheckEnds(file, format); !status)
  {
    return status;
  }
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone)
  {
    return { ErrorCode::InvalidFormat, place + ": it is damaged; write it again" };
  }
  const auto iges = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  Status status = iges.IsNull() ? Status() : MendIGESSplines(iges, numMended);
  if (status)
  {
    status = CheckEntities(reader);
  }
  if (!status)
  {
    return { status.Code, place + ": " + status.Detail };
  }
  return {};
}

Status LoadBREP(const std::string& file, LengthUnit unit, TopoDS_Shape& shape)
{
  if (Status status = CheckEnds(file, CADFormat::BREP); !status)
  {
    return status;
  }
  const auto stream =
    OSD_FileSystem::DefaultFileSystem()->OpenIStream(file.c_str(), std::ios::in | std::ios::binary);
  TopoDS_Shape read;
  BRepTools::Read(read, *stream, BRep_Builder());
  if (read.IsNull() || stream->fail())
  {
    const Status status = Damaged("");
    return { status.Code, "'" + file + "': " + status.Detail };
  }
  gp_Trsf scale;
  scale.SetScaleFactor(1.0 / Millimetres(unit));
  shape =
    unit == LengthUnit::Millimetre ? read : BRepBuilderAPI_Transform(read, scale, true).Shape();
  return {};
}
}
