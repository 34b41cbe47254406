// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADModify.h"

#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>

#include <NCollection_DataMap.hxx>

namespace knotwork
{
/// A colour and a name of a shape in a document; empty where there is none.
struct ShapeAttributes
{
  std::string Name;
  bool HasColor = false;
  std::array<double, 3> Color{}; ///< sRGB
};

using AttributesOfShapes =
  NCollection_DataMap<TopoDS_Shape, ShapeAttributes, TopTools_ShapeMapHasher>;

/// A solid (or a shell or face outside of solids) at its place in the assembly.
struct ModelBody
{
  TopoDS_Shape Shape;
  int Instance = -1; ///< of the document
  ShapeAttributes Attributes;
  bool IsChanged = false;
};

/// Bodies in the order in which ReadCAD numbers their faces.
struct ModelBodies
{
  std::vector<ModelBody> Bodies;
  AttributesOfShapes Faces;
};

CADCounts CountBodies(const ModelBodies& model);

/// @return the failure of the first defect that BRepCheck_Analyzer finds.
Status CheckBodies(const ModelBodies& model);

/// One operation. May throw OpenCASCADE's exceptions.
/// @param scale  lengths of the operation times it are those of the model; the step's are the
/// operation's.
/// @return failures of ModifyCAD.
Status RunOperation(const CADOperation& operation, double scale, ModelBodies& model, CADStep& step);
}
