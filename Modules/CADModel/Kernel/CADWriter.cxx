// SPDX-License-Identifier: BSD-3-Clause
#include "CADDocument.h"
#include "CADExchange.h"
#include "CADFile.h"
#include "CADSession.h"
#include "CADShapes.h"
#include <knotwork/SplineCore/FileOutput.h>

#include <APIHeaderSection_MakeHeader.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESData_IGESWriter.hxx>
#include <IGESData_Protocol.hxx>
#include <IGESSelect_WorkLibrary.hxx>
#include <Interface_FloatWriter.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <Standard_OStream.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <TCollection_HAsciiString.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <functional>
#include <sstream>

namespace knotwork
{
namespace
{
/// Where the formats want the time of writing.
constexpr const char* NoTime = "1970-01-01T00:00:00";
constexpr const char* NoDate = "19700101.000000";

/// Shapes with the names and colours of faces.
Handle(TDocStd_Document)
  MakeDocument(const TrimmedModel& model, const CADShapes& shapes, const CADWriteParams& params)
{
  Handle(TDocStd_Document) document = NewDocument();
  XCAFDoc_DocumentTool::SetLengthUnit(document, Millimetres(params.Unit) / 1000.0);
  const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colors = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const TDF_Label root = tool->AddShape(shapes.Shape, false);
  SetName(root, params.Name);
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const TrimmedFace& face = model.Faces[f];
    if (face.Name.empty() && !face.HasColor)
    {
      continue;
    }
    const TDF_Label label = tool->AddSubShape(root, shapes.Faces[f]);
    if (label.IsNull())
    {
      continue;
    }
    if (!face.Name.empty())
    {
      SetName(label, face.Name);
    }
    if (face.HasColor)
    {
      SetColor(colors, label, face.Color);
    }
  }
  return document;
}

/// Seventeen digits, so that reading gives the same numbers; zeros at the end stay, as numbers of
/// this length may not be shortened there.
void SetFormat(Interface_FloatWriter& format)
{
  format.SetFormat("%#.17G");
  format.SetZeroSuppress(false);
  format.SetFormatForRange("%#.17G", 0.0, 0.0);
}

Handle(TCollection_HAsciiString) Text(const char* text)
{
  return new TCollection_HAsciiString(text);
}

bool WriteIGES(const Handle(TDocStd_Document) & document, std::ostream& stream)
{
  IGESCAFControl_Writer writer;
  if (!writer.Transfer(document))
  {
    return false;
  }
  writer.ComputeModel();
  IGESData_GlobalSection header = writer.Model()->GlobalSection();
  header.SetSendName(Text("Knotwork"));
  header.SetDate(Text(NoDate));
  header.SetLastChangeDate(Text(NoDate));
  header.SetAuthorName(Text(""));
  header.SetCompanyName(Text(""));
  header.SetSystemId(Text("Knotwork"));
  header.SetFileName(Text("Knotwork.igs"));
  writer.Model()->SetGlobalSection(header);
  IGESData_IGESWriter text(writer.Model());
  SetFormat(text.FloatWriter());
  text.SendModel(IGESSelect_WorkLibrary::DefineProtocol());
  return text.Print(stream);
}

/// @return failures of MakeShapes; InvalidFormat: OpenCASCADE makes no text, or reads another
/// geometry in it.
Status TextOf(const TrimmedModel& model, const CADWriteParams& params, CADFormat format,
  LoopBegin begin, CADSession& session, std::string& text)
{
  const auto shapes = MakeShapes(model, params.SewTolerance, begin);
  if (!shapes)
  {
    return shapes.Status;
  }
  session.Set("write.surfacecurve.mode", shapes->HasPlanesOnly ? 0 : 1); // pcurves
  // readers keep a pcurve whose ends are that near to the curve
  session.Set("write.precision.val", std::max(2.0 * shapes->MaxGap, 1e-7));
  std::ostringstream stream;
  bool written = false;
  if (format == CADFormat::STEP)
  {
    session.Set("write.step.schema", params.Schema == STEPSchema::AP242 ? 5 : 4);
    session.Set("write.step.unit", NameOfUnit(params.Unit));
    session.Set("write.stepcaf.subshapes.name", 1);
    written =
      WriteSTEP(MakeDocument(model, shapes.Value, params), "Trimmed spline surfaces", stream);
  }
  else
  {
    session.Set("write.iges.unit", NameOfUnit(params.Unit));
    session.Set("write.iges.brep.mode", 1); // solids, shells and faces with edges
    written = WriteIGES(MakeDocument(model, shapes.Value, params), stream);
  }
  if (!written)
  {
    return { ErrorCode::InvalidFormat, "OpenCASCADE made no text" };
  }
  text = stream.str();
  if (format != CADFormat::STEP || !(shapes->HasPoles || shapes->HasCurvedTypes))
  {
    return {};
  }
  CADSummary summary;
  const Status status = CheckSTEPText(text, summary);
  return status ? CompareCAD(model, summary) : status;
}
}

namespace
{
/// The first text that OpenCASCADE reads rightly: loops that begin at either pole, then with
/// spheres, cones, tori, extrusions and revolutions as splines. @return the failure of the first
/// one.
Status TextInAnyWay(const TrimmedModel& model, const CADWriteParams& params, CADFormat format,
  CADSession& session, std::string& text)
{
  Status first;
  TrimmedModel splines;
  for (const TrimmedModel* way : { &model, static_cast<const TrimmedModel*>(&splines) })
  {
    if (way == &splines)
    {
      splines = model;
      bool isOther = false;
      for (TrimmedFace& face : splines.Faces)
      {
        const bool isKept = face.Type == SurfaceType::Plane || face.Type == SurfaceType::Cylinder;
        isOther = isOther || (!isKept && face.Type != SurfaceType::FreeForm);
        face.Type = isKept ? face.Type : SurfaceType::FreeForm;
      }
      if (!isOther)
      {
        break;
      }
    }
    for (const LoopBegin begin : { LoopBegin::LowerPole, LoopBegin::UpperPole })
    {
      const Status status = TextOf(*way, params, format, begin, session, text);
      if (status || status.Code != ErrorCode::InvalidFormat)
      {
        return status;
      }
      first = first ? status : first;
    }
  }
  return first;
}
}

bool WriteSTEP(
  const Handle(TDocStd_Document) & document, const char* description, std::ostream& stream)
{
  STEPCAFControl_Writer writer;
  if (!writer.Transfer(document))
  {
    return false;
  }
  const Handle(StepData_StepModel) steps = writer.ChangeWriter().Model();
  APIHeaderSection_MakeHeader header(steps);
  header.SetName(Text("Knotwork"));
  header.SetTimeStamp(Text(NoTime)); // the same model is the same file
  header.SetAuthorValue(1, Text(""));
  header.SetOrganizationValue(1, Text(""));
  header.SetOriginatingSystem(Text("Knotwork"));
  header.SetDescriptionValue(1, Text(description));
  StepData_StepWriter text(steps);
  SetFormat(text.FloatWriter());
  text.SendModel(Handle(StepData_Protocol)::DownCast(writer.ChangeWriter().WS()->Protocol()));
  return text.Print(stream);
}

Status WriteCAD(const TrimmedModel& model, const std::string& file, const CADWriteParams& params)
{
  const CADFormat format = FormatOfFile(file);
  if (format != CADFormat::STEP && format != CADFormat::IGES)
  {
    return { ErrorCode::InvalidParameter,
      "'" + file + "': the ending must be .step, .stp, .iges or .igs" };
  }
  if (!(params.SewTolerance > 0.0 && params.SewTolerance <= 0.1))
  {
    return { ErrorCode::InvalidParameter, "SewTolerance must lie in (0, 0.1]" };
  }
  const std::string place = "'" + file + "'";
  CADSession session(params.Unit);
  session.SetDefaultsOfReading();
  session.Set("write.precision.mode", 2); // the stated uncertainty is the value
  return session.Run(place,
    [&]() -> Status
    {
      std::string text;
      Status status = TextInAnyWay(model, params, format, session, text);
      if (!status)
      {
        return { status.Code,
          (status.Code == ErrorCode::InvalidFormat ? place + " cannot be written: " : "") +
            status.Detail };
      }
      FileOutput output(file);
      output.Stream() << text;
      return output.Finish();
    });
}
}
