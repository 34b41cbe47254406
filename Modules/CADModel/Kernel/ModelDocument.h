// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADSession.h"
#include "ShapeOperations.h"

#include <NCollection_DataMap.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelMapHasher.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <functional>

namespace knotwork
{
/// The bodies of a document, in ReadCAD's order, and back into a document of the same tree.
class ModelDocument
{
public:
  explicit ModelDocument(const Handle(TDocStd_Document) & document);

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
  // null: nothing of it is left
  TDF_Label PutLabel(const TDF_Label& label, const ModelBodies& model);
  TDF_Label PutProduct(const TDF_Label& label, int instance, const ModelBodies& model);
  void Copy(const TDF_Label& from, const TDF_Label& to);
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

/// Reads a STEP file within a session, in the file's own unit, which becomes the session's: numbers
/// that no operation touches stay the same.
/// @return as LoadCAD.
Status LoadModel(CADSession& session, const std::string& file, Handle(TDocStd_Document) & document,
  LengthUnit& unit);
}
