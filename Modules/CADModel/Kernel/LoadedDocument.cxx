// SPDX-License-Identifier: BSD-3-Clause
#include "LoadedDocument.h"

#include "CADDocument.h"
#include "CADFile.h"
#include "STEPLoops.h"

#include <IGESCAFControl_Reader.hxx>
#include <IGESData_IGESEntity.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TCollection_HAsciiString.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <memory>

namespace knotwork
{
namespace
{
/// They live as long as the reader does.
EntityNames NamesOfIGES(const std::shared_ptr<IGESCAFControl_Reader>& reader)
{
  return [reader](const TopoDS_Shape& shape)
  {
    const Handle(XSControl_TransferReader) transfer = reader->WS()->TransferReader();
    const auto entity =
      Handle(IGESData_IGESEntity)::DownCast(transfer->EntityFromShapeResult(shape, -1));
    const Handle(TCollection_HAsciiString) name =
      entity.IsNull() ? Handle(TCollection_HAsciiString)() : entity->NameValue();
    std::string text = name.IsNull() ? "" : name->ToCString();
    return text.erase(0, text.find_first_not_of(' '));
  };
}
}

Status LoadDocument(
  CADSession& session, const std::string& file, LengthUnit unit, LoadedDocument& loaded)
{
  session.SetDefaultsOfReading();
  session.Set("read.stepcaf.subshapes.name", 1);
  loaded.Document = NewDocument();
  const CADFormat format = FormatOfFile(file);
  Status status;
  if (format == CADFormat::BREP)
  {
    TopoDS_Shape shape;
    status = LoadBREP(file, unit, shape);
    if (status)
    {
      XCAFDoc_DocumentTool::ShapeTool(loaded.Document->Main())->AddShape(shape, false);
    }
  }
  else if (format == CADFormat::IGES)
  {
    const auto reader = std::make_shared<IGESCAFControl_Reader>();
    reader->SetNameMode(false); // it stumbles over entities without a name
    loaded.Names = NamesOfIGES(reader);
    status = LoadCAD(*reader, format, file, loaded.NumMended);
    if (status && !reader->Transfer(loaded.Document))
    {
      loaded.Document = NewDocument();
    }
  }
  else
  {
    STEPCAFControl_Reader reader;
    status = LoadCAD(reader.ChangeReader(), format, file, loaded.NumMended);
    if (status)
    {
      BeginLoopsAtPoles(reader.ChangeReader().Model());
    }
    if (status && !reader.Transfer(loaded.Document))
    {
      loaded.Document = NewDocument();
    }
  }
  return status;
}
}
