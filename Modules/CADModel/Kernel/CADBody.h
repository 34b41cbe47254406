// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "CADExchange.h"

#include <TopoDS_Face.hxx>

namespace knotwork
{
/// A face of OpenCASCADE with what a document says of it.
struct CADFace
{
  TopoDS_Face Face;
  std::string Name;
  bool HasColor = false;
  std::array<double, 3> Color{};
};

/// Appends the faces of a body to a model: surfaces, loops, edges and vertices in common. A face
/// that cannot be a spline face is named in LeftOut. May throw OpenCASCADE's exceptions.
/// @param tolerance  of refitted edges, unit of the shapes.
void AppendBody(
  const std::vector<CADFace>& faces, int body, double tolerance, CADContents& contents);
}
