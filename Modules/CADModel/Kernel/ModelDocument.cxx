// SPDX-License-Identifier: BSD-3-Clause
#include "ModelDocument.h"

#include "CADDocument.h"
#include "CADFile.h"
#include "STEPLoops.h"

#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRep_Builder.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_DocumentTool.hxx>

#include <algorithm>

namespace knotwork
{
namespace
{
ShapeAttributes AttributesOf(const Handle(XCAFDoc_ColorTool) & colors, const TDF_Label& label)
{
  ShapeAttributes attributes;
  attributes.Name = NameOf(label);
  const auto color = ColorOf(colors, label);
  attributes.HasColor = color.has_value();
  attributes.Color = color.value_or(std::array<double, 3>{});
  return attributes;
}

bool IsEmpty(const ShapeAttributes& attributes)
{
  return attributes.Name.empty() && !attributes.HasColor;
}

/// Of a STEP file; others than those of LengthUnit are millimetres.
LengthUnit UnitOf(STEPControl_Reader& reader)
{
  TColStd_SequenceOfAsciiString lengths;
  TColStd_SequenceOfAsciiString angles;
  TColStd_SequenceOfAsciiString solidAngles;
  reader.FileUnits(lengths, angles, solidAngles);
  std::string name = lengths.IsEmpty() ? std::string() : lengths.First().ToCString();
  for (char& letter : name)
  {
    letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  constexpr std::pair<const char*, LengthUnit> Names[] = { { "micrometre", LengthUnit::Micrometre },
    { "centimetre", LengthUnit::Centimetre }, { "metre", LengthUnit::Metre },
    { "inch", LengthUnit::Inch }, { "foot", LengthUnit::Foot } };
  for (const auto& [text, unit] : Names)
  {
    if (name == text)
    {
      return unit;
    }
  }
  return LengthUnit::Millimetre;
}
}

ModelDocument::ModelDocument(const Handle(TDocStd_Document) & document)
  : Shapes(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
    Colors(XCAFDoc_DocumentTool::ColorTool(document->Main()))
{
}

void ModelDocument::Copy(const TDF_Label& from, const TDF_Label& to)
{
  this->Set(AttributesOf(this->Colors, from), to);
}

ModelBodies ModelDocument::Take()
{
  ModelBodies model;
  TDF_LabelSequence roots;
  this->Shapes->GetFreeShapes(roots);
  for (const TDF_Label& root : roots)
  {
    this->TakeLabel(root, {}, model);
  }
  return model;
}

void ModelDocument::TakeLabel(
  const TDF_Label& label, const TopLoc_Location& location, ModelBodies& model)
{
  if (!XCAFDoc_ShapeTool::IsAssembly(label))
  {
    this->Instances.push_back({ label, location });
    this->TakeProduct(this->Instances.back(), model);
    return;
  }
  TDF_LabelSequence components;
  XCAFDoc_ShapeTool::GetComponents(label, components);
  for (const TDF_Label& component : components)
  {
    TDF_Label product;
    if (XCAFDoc_ShapeTool::GetReferredShape(component, product))
    {
      this->TakeLabel(product, location * XCAFDoc_ShapeTool::GetLocation(component), model);
    }
  }
}

void ModelDocument::TakeProduct(const Instance& instance, ModelBodies& model)
{
  AttributesOfShapes attributes;
  TDF_LabelSequence parts;
  XCAFDoc_ShapeTool::GetSubShapes(instance.Product, parts);
  for (const TDF_Label& part : parts)
  {
    attributes.Bind(XCAFDoc_ShapeTool::GetShape(part), AttributesOf(this->Colors, part));
  }
  const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(instance.Product);
  const auto take = [&](const TopoDS_Shape& body)
  {
    ModelBody taken;
    taken.Shape = body.Moved(instance.Location);
    taken.Instance = static_cast<int>(this->Instances.size()) - 1;
    if (const ShapeAttributes* own = attributes.Seek(body))
    {
      taken.Attributes = *own;
    }
    model.Bodies.push_back(taken);
    for (TopExp_Explorer face(body, TopAbs_FACE); face.More(); face.Next())
    {
      const ShapeAttributes* own = attributes.Seek(face.Current());
      if (own && !IsEmpty(*own))
      {
        model.Faces.Bind(face.Current().Moved(instance.Location), *own);
      }
    }
  };
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
  {
    take(solid.Current());
  }
  for (TopExp_Explorer shell(shape, TopAbs_SHELL, TopAbs_SOLID); shell.More(); shell.Next())
  {
    take(shell.Current());
  }
  for (TopExp_Explorer face(shape, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
  {
    take(face.Current());
  }
}

void ModelDocument::Set(const ShapeAttributes& attributes, const TDF_Label& label)
{
  if (!attributes.Name.empty())
  {
    SetName(label, attributes.Name);
  }
  if (attributes.HasColor)
  {
    SetColor(this->NewColors, label, attributes.Color);
  }
}

void ModelDocument::SetPart(
  const TDF_Label& product, const TopoDS_Shape& part, const ShapeAttributes& attributes)
{
  if (IsEmpty(attributes) || part.IsNull())
  {
    return;
  }
  const TDF_Label label = this->NewShapes->AddSubShape(product, part);
  if (!label.IsNull())
  {
    this->Set(attributes, label);
  }
}

TDF_Label ModelDocument::PutProduct(const TDF_Label& label, int instance, const ModelBodies& model)
{
  const TopLoc_Location back =
    this->Instances[static_cast<std::size_t>(instance)].Location.Inverted();
  std::vector<const ModelBody*> bodies;
  bool isChanged = false;
  for (const ModelBody& body : model.Bodies)
  {
    if (body.Instance == instance)
    {
      bodies.push_back(&body);
      isChanged = isChanged || body.IsChanged;
    }
  }
  if (bodies.empty() && TopExp_Explorer(XCAFDoc_ShapeTool::GetShape(label), TopAbs_FACE).More())
  {
    return {}; // others hold what it was
  }
  if (const TDF_Label* known = isChanged ? nullptr : this->Unchanged.Seek(label))
  {
    return *known;
  }
  if (!isChanged)
  {
    const TDF_Label product = this->NewShapes->AddShape(XCAFDoc_ShapeTool::GetShape(label), false);
    this->Copy(label, product);
    for (const ModelBody* body : bodies)
    {
      this->SetParts(product, *body, model.Faces,
        [&back](const TopoDS_Shape& shape) { return shape.Moved(back); });
    }
    this->Unchanged.Bind(label, product);
    return product;
  }
  // shapes of products have no place of their own, else they become components: what still lies
  // where the instance does is moved back, other bodies are made anew
  const bool areAtHome = std::all_of(bodies.begin(), bodies.end(),
    [&](const ModelBody* body) { return body->Shape.Moved(back).Location().IsIdentity(); });
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const ModelBody* body : bodies)
  {
    builder.Add(compound, areAtHome ? body->Shape.Moved(back) : body->Shape);
  }
  // a copy: what other instances keep has no part in the names
  const TopoDS_Shape moved = areAtHome
    ? BRepBuilderAPI_Copy(compound).Shape()
    : BRepBuilderAPI_Transform(compound, back.Transformation(), true).Shape();
  // both have their parts in the same order; the transformation finds none that lies elsewhere
  TopTools_IndexedMapOfShape olds;
  TopTools_IndexedMapOfShape news;
  TopExp::MapShapes(compound, olds);
  TopExp::MapShapes(moved, news);
  const auto place = [&](const TopoDS_Shape& shape)
  {
    const int index = olds.FindIndex(areAtHome ? shape.Moved(back) : shape);
    return index > 0 && index <= news.Extent() ? news(index) : TopoDS_Shape();
  };
  const TopoDS_Shape single = bodies.size() == 1 ? place(bodies[0]->Shape) : TopoDS_Shape();
  const bool isSingle = !single.IsNull() && single.Location().IsIdentity();
  const TDF_Label product = this->NewShapes->AddShape(isSingle ? single : moved, false);
  this->Copy(label, product);
  for (const ModelBody* body : bodies)
  {
    this->SetParts(product, *body, model.Faces, place);
  }
  return product;
}

void ModelDocument::SetParts(const TDF_Label& product, const ModelBody& body,
  const AttributesOfShapes& faces, const std::function<TopoDS_Shape(const TopoDS_Shape&)>& place)
{
  this->SetPart(product, place(body.Shape), body.Attributes);
  for (TopExp_Explorer face(body.Shape, TopAbs_FACE); face.More(); face.Next())
  {
    if (const ShapeAttributes* own = faces.Seek(face.Current()))
    {
      this->SetPart(product, place(face.Current()), *own);
    }
  }
}

TDF_Label ModelDocument::PutLabel(const TDF_Label& label, const ModelBodies& model)
{
  if (!XCAFDoc_ShapeTool::IsAssembly(label))
  {
    return this->PutProduct(label, this->NumPut++, model);
  }
  const TDF_Label assembly = this->NewShapes->NewShape();
  this->Copy(label, assembly);
  TDF_LabelSequence components;
  XCAFDoc_ShapeTool::GetComponents(label, components);
  for (const TDF_Label& component : components)
  {
    TDF_Label product;
    if (XCAFDoc_ShapeTool::GetReferredShape(component, product))
    {
      const TDF_Label made = this->PutLabel(product, model);
      if (!made.IsNull())
      {
        this->Copy(component,
          this->NewShapes->AddComponent(assembly, made, XCAFDoc_ShapeTool::GetLocation(component)));
      }
    }
  }
  return assembly;
}

Handle(TDocStd_Document) ModelDocument::Put(const ModelBodies& model)
{
  Handle(TDocStd_Document) document = NewDocument();
  this->NewShapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  this->NewColors = XCAFDoc_DocumentTool::ColorTool(document->Main());
  this->NumPut = 0;
  TDF_LabelSequence roots;
  this->Shapes->GetFreeShapes(roots);
  for (const TDF_Label& root : roots)
  {
    this->PutLabel(root, model);
  }
  this->NewShapes->UpdateAssemblies();
  return document;
}

Status LoadModel(CADSession& session, const std::string& file, Handle(TDocStd_Document) & document,
  LengthUnit& unit)
{
  document = NewDocument();
  STEPCAFControl_Reader reader;
  int numMended = 0;
  if (Status loaded = LoadCAD(reader.ChangeReader(), CADFormat::STEP, file, numMended); !loaded)
  {
    return loaded;
  }
  unit = UnitOf(reader.ChangeReader());
  session.Set("xstep.cascade.unit", NameOfUnit(unit));
  BeginLoopsAtPoles(reader.ChangeReader().Model());
  if (!reader.Transfer(document))
  {
    return { ErrorCode::InvalidFormat, "'" + file + "': " + FailureOfOpenCASCADE };
  }
  return {};
}
}
