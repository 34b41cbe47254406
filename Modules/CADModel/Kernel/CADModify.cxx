// SPDX-License-Identifier: BSD-3-Clause
#include "CADModify.h"

#include "CADDocument.h"
#include "CADFile.h"
#include "CADSession.h"
#include "STEPLoops.h"
#include "ShapeOperations.h"
#include <knotwork/SplineCore/FileOutput.h>

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_OStream.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDF_LabelMap.hxx>
#include <TDF_LabelSequence.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <functional>
#include <sstream>

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

/// The bodies of a document, in ReadCAD's order, and back into a document of the same tree.
class ModelDocument
{
public:
  explicit ModelDocument(const Handle(TDocStd_Document) & document)
    : Shapes(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
      Colors(XCAFDoc_DocumentTool::ColorTool(document->Main()))
  {
  }

  ModelBodies Take();
  Handle(TDocStd_Document) Put(const ModelBodies& model);

private:
  struct Instance
  {
    TDF_Label Product;
    TopLoc_Location Location;
  };

  void TakeLabel(const TDF_Label& label, const TopLoc_Location& location, ModelBodies& model);
  void TakeProduct(const Instance& instance, ModelBodies& model);
  TDF_Label PutLabel(const TDF_Label& label, const ModelBodies& model);
  TDF_Label PutProduct(const TDF_Label& label, int instance, const ModelBodies& model);
  void Copy(const TDF_Label& from, const TDF_Label& to)
  {
    this->Set(AttributesOf(this->Colors, from), to);
  }
  void Set(const ShapeAttributes& attributes, const TDF_Label& label);
  void SetPart(
    const TDF_Label& product, const TopoDS_Shape& part, const ShapeAttributes& attributes);

  void SetParts(const TDF_Label& product, const ModelBody& body, const AttributesOfShapes& faces,
    const std::function<TopoDS_Shape(const TopoDS_Shape&)>& place);

  Handle(XCAFDoc_ShapeTool) Shapes;
  Handle(XCAFDoc_ColorTool) Colors;
  Handle(XCAFDoc_ShapeTool) NewShapes;
  Handle(XCAFDoc_ColorTool) NewColors;
  std::vector<Instance> Instances;
  NCollection_DataMap<TDF_Label, TDF_Label, TDF_LabelMapHasher> Unchanged; ///< new of old products
  int NumPut = 0;                                                          ///< instances
};

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
  if (IsEmpty(attributes))
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
  // shapes of products have no place of their own, else they become components
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const ModelBody* body : bodies)
  {
    builder.Add(compound, body->Shape);
  }
  BRepBuilderAPI_Transform moved(compound, back.Transformation(), true);
  const TDF_Label product = this->NewShapes->AddShape(
    bodies.size() == 1 ? moved.ModifiedShape(bodies[0]->Shape) : moved.Shape(), false);
  this->Copy(label, product);
  for (const ModelBody* body : bodies)
  {
    this->SetParts(product, *body, model.Faces,
      [&moved](const TopoDS_Shape& shape) { return moved.ModifiedShape(shape); });
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
      this->Copy(component,
        this->NewShapes->AddComponent(assembly, made, XCAFDoc_ShapeTool::GetLocation(component)));
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

/// The bodies at their places, with what they share, in millimetres.
void WriteBREP(const ModelBodies& model, double millimetres, std::ostream& stream)
{
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const ModelBody& body : model.Bodies)
  {
    builder.Add(compound, body.Shape);
  }
  gp_Trsf scale;
  scale.SetScale(gp_Pnt(), millimetres);
  BRepTools::Write(
    millimetres == 1.0 ? compound : BRepBuilderAPI_Transform(compound, scale, true).Shape(),
    stream);
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

Result<std::vector<CADStep>> ModifyCAD(const std::string& file, const std::string& output,
  const std::vector<CADOperation>& operations, const CADModifyParams& params)
{
  const std::string place = "'" + file + "'";
  if (operations.empty())
  {
    return { ErrorCode::EmptyInput, "there is no operation; give one or more" };
  }
  if (!(params.VolumeTolerance >= 0.0 && params.VolumeTolerance <= 1.0))
  {
    return { ErrorCode::InvalidParameter, "VolumeTolerance must lie in [0, 1]" };
  }
  const CADFormat format = FormatOfFile(output);
  if (FormatOfFile(file) != CADFormat::STEP)
  {
    return { ErrorCode::InvalidParameter, place + ": the ending must be .step or .stp" };
  }
  if (format != CADFormat::STEP && format != CADFormat::BREP)
  {
    return { ErrorCode::InvalidParameter,
      "'" + output + "': the ending must be .step, .stp or .brep" };
  }
  std::vector<CADStep> steps;
  CADSession session(params.Unit);
  session.SetDefaultsOfReading();
  session.Set("read.stepcaf.subshapes.name", 1);
  session.Set("write.stepcaf.subshapes.name", 1);
  session.Set("write.surfacecurve.mode", 1);
  session.Set("write.step.assembly", 2); // when it is off, names and colours of products are lost
  const Status status = session.Run(place,
    [&]() -> Status
    {
      Handle(TDocStd_Document) document = NewDocument();
      STEPCAFControl_Reader reader;
      int numMended = 0;
      if (Status loaded = LoadCAD(reader.ChangeReader(), CADFormat::STEP, file, numMended); !loaded)
      {
        return loaded;
      }
      // nothing is scaled: numbers that no operation touches stay the same
      const LengthUnit unit = UnitOf(reader.ChangeReader());
      session.Set("xstep.cascade.unit", NameOfUnit(unit));
      session.Set("write.step.unit", NameOfUnit(unit));
      const double scale = Millimetres(params.Unit) / Millimetres(unit);
      BeginLoopsAtPoles(reader.ChangeReader().Model());
      if (!reader.Transfer(document))
      {
        return { ErrorCode::InvalidFormat, place + ": " + FailureOfOpenCASCADE };
      }
      ModelDocument tree(document);
      ModelBodies model = tree.Take();
      if (Status valid = CheckBodies(model); !valid)
      {
        return { valid.Code, place + ": " + valid.Detail + "; heal it first" };
      }
      for (const CADOperation& operation : operations)
      {
        CADStep step;
        if (Status done = RunOperation(operation, scale, model, step); !done)
        {
          return { done.Code,
            place + ", operation " + std::to_string(steps.size() + 1) + ": " + done.Detail };
        }
        if (!(step.VolumeChange <= params.VolumeTolerance))
        {
          std::ostringstream detail;
          detail << place << ", operation " << steps.size() + 1 << ": the volume changes by "
                 << step.VolumeChange << " of itself, more than " << params.VolumeTolerance
                 << "; edges of the file lie off their faces, or the cut runs along a face: move "
                    "it, heal the file or ask for a larger volume tolerance";
          return { ErrorCode::InvalidTopology, detail.str() };
        }
        steps.push_back(std::move(step));
      }
      std::ostringstream text;
      if (format == CADFormat::BREP)
      {
        WriteBREP(model, Millimetres(unit), text);
        return PutText(text.str(), output);
      }
      if (!WriteSTEP(tree.Put(model), "Modified", text))
      {
        return { ErrorCode::InvalidFormat,
          "'" + output + "' cannot be written: OpenCASCADE made no text" };
      }
      CADSummary summary;
      if (Status read = CheckSTEPText(text.str(), summary); !read)
      {
        return read;
      }
      const CADCounts& made = steps.back().After;
      if (!summary.Valid || summary.NumSolids != made.Solids)
      {
        return { ErrorCode::InvalidFormat,
          "'" + output +
            "' is not written: OpenCASCADE reads something else in it; move the last cut" };
      }
      return PutText(text.str(), output);
    });
  return status ? Result<std::vector<CADStep>>(std::move(steps))
                : Result<std::vector<CADStep>>(status);
}
}
