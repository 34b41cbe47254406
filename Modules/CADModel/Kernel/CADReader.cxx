// SPDX-License-Identifier: BSD-3-Clause
#include "CADBody.h"
#include "CADDocument.h"
#include "CADSession.h"
#include "LoadedDocument.h"

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>
#include <NCollection_DataMap.hxx>
#include <TDF_LabelSequence.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <cmath>
#include <optional>

namespace knotwork
{
namespace
{
constexpr double DefaultTolerance = 1e-6;   ///< of the model's size
constexpr const char* OwnName = "Knotwork"; ///< CADWriteParams::Name

using Color = std::optional<std::array<double, 3>>;

struct Attributes
{
  std::string Name;
  knotwork::Color Color;
};

/// Walks through the products of a document.
class DocumentReader
{
public:
  DocumentReader(const Handle(TDocStd_Document) & document, EntityNames names, double tolerance,
    CADContents& contents)
    : Shapes(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
      Colors(XCAFDoc_DocumentTool::ColorTool(document->Main())), Names(std::move(names)),
      Tolerance(tolerance), Contents(contents)
  {
  }
  void Read();

private:
  Color ColorOf(const TDF_Label& label) const { return knotwork::ColorOf(this->Colors, label); }
  void ReadLabel(const TDF_Label& label, const TopLoc_Location& location, const Color& color);
  void ReadProduct(const TDF_Label& label, const TopLoc_Location& location, const Color& color);

  Handle(XCAFDoc_ShapeTool) Shapes;
  Handle(XCAFDoc_ColorTool) Colors;
  EntityNames Names;
  double Tolerance;
  CADContents& Contents;
  int NumBodies = 0;
};

void DocumentReader::ReadLabel(
  const TDF_Label& label, const TopLoc_Location& location, const Color& outer)
{
  const Color own = this->ColorOf(label);
  const Color color = outer ? outer : own; // an instance's colour before its product's
  if (XCAFDoc_ShapeTool::IsAssembly(label))
  {
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(label, components);
    for (const TDF_Label& component : components)
    {
      TDF_Label product;
      if (XCAFDoc_ShapeTool::GetReferredShape(component, product))
      {
        const Color instance = this->ColorOf(component);
        this->ReadLabel(product, location * XCAFDoc_ShapeTool::GetLocation(component),
          instance ? instance : color);
      }
    }
    return;
  }
  this->ReadProduct(label, location, color);
}

void DocumentReader::ReadProduct(
  const TDF_Label& label, const TopLoc_Location& location, const Color& color)
{
  NCollection_DataMap<TopoDS_Shape, Attributes, TopTools_ShapeMapHasher> attributes;
  TDF_LabelSequence parts;
  XCAFDoc_ShapeTool::GetSubShapes(label, parts);
  for (const TDF_Label& part : parts)
  {
    attributes.Bind(XCAFDoc_ShapeTool::GetShape(part), { NameOf(part), this->ColorOf(part) });
  }
  const std::string product = NameOf(label);
  const auto readBody = [&](const TopoDS_Shape& body, const TopoDS_Shape& shell)
  {
    std::vector<CADFace> faces;
    for (TopExp_Explorer explorer(body, TopAbs_FACE); explorer.More(); explorer.Next())
    {
      CADFace face;
      const TopoDS_Shape& shape = explorer.Current();
      face.Face = TopoDS::Face(shape.Moved(location));
      Color found;
      const Attributes* own = attributes.Seek(shape);
      face.Name = own ? own->Name : std::string();
      for (const Attributes* level : { own, attributes.Seek(shell), attributes.Seek(body) })
      {
        found = !found && level ? level->Color : found;
      }
      found = found ? found : color;
      if (face.Name.empty() && this->Names)
      {
        face.Name = this->Names(shape);
      }
      if (face.Name.empty() && product != OwnName)
      {
        face.Name = product;
      }
      face.HasColor = found.has_value();
      face.Color = found.value_or(std::array<double, 3>{});
      faces.push_back(face);
    }
    AppendBody(faces, this->NumBodies++, this->Tolerance, this->Contents);
  };
  const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
  {
    TopExp_Explorer shell(solid.Current(), TopAbs_SHELL);
    readBody(solid.Current(), shell.More() ? shell.Current() : solid.Current());
  }
  for (TopExp_Explorer shell(shape, TopAbs_SHELL, TopAbs_SOLID); shell.More(); shell.Next())
  {
    readBody(shell.Current(), shell.Current());
  }
  for (TopExp_Explorer face(shape, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
  {
    readBody(face.Current(), face.Current());
  }
}

void DocumentReader::Read()
{
  TDF_LabelSequence roots;
  this->Shapes->GetFreeShapes(roots);
  if (this->Tolerance == 0.0)
  {
    Bnd_Box box;
    for (const TDF_Label& root : roots)
    {
      BRepBndLib::Add(XCAFDoc_ShapeTool::GetShape(root), box, false);
    }
    this->Tolerance = box.IsVoid() ? 1.0 : DefaultTolerance * std::sqrt(box.SquareExtent());
  }
  for (const TDF_Label& root : roots)
  {
    this->ReadLabel(root, {}, {});
  }
}
}

Result<CADContents> ReadCAD(const std::string& file, const CADReadParams& params)
{
  if (!(params.Tolerance >= 0.0 && std::isfinite(params.Tolerance)))
  {
    return { ErrorCode::InvalidParameter, "Tolerance must not be negative" };
  }
  CADContents contents;
  const std::string place = "'" + file + "'";
  CADSession session(params.Unit);
  const Status status = session.Run(place,
    [&]() -> Status
    {
      LoadedDocument loaded;
      if (Status read = LoadDocument(session, file, params.Unit, loaded); !read)
      {
        return read;
      }
      if (loaded.NumMended > 0)
      {
        contents.Warnings.push_back("the knots of " + std::to_string(loaded.NumMended) +
          (loaded.NumMended == 1 ? " curve" : " curves") +
          " are damaged; found anew: pcurves from curves in space, or these from pcurves");
      }
      DocumentReader(loaded.Document, loaded.Names, params.Tolerance, contents).Read();
      if (contents.Model.Faces.empty())
      {
        return { ErrorCode::EmptyInput,
          place + ": there is no face in it" +
            (contents.LeftOut.empty() ? std::string() : "; " + contents.LeftOut.front()) };
      }
      return contents.Model.Check();
    });
  return status ? Result<CADContents>(std::move(contents)) : Result<CADContents>(status);
}
}
