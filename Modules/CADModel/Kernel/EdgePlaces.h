// SPDX-License-Identifier: BSD-3-Clause
// Edges of solids with their angles, and the surfaces along which concave ones can be cut.
#pragma once
#include "ShapeImages.h"

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Pnt.hxx>

namespace knotwork
{
/// Lengths are those of the shapes.
struct EdgePlace
{
  TopoDS_Edge Edge;
  int Faces[2] = {}; ///< ids
  double Length = 0.0;
  gp_Pnt Middle;
  double Angle = 0.0; ///< largest one between the normals
  bool IsConcave = false;
};

inline Eigen::Vector3d ToVector(const gp_XYZ& p)
{
  return { p.X(), p.Y(), p.Z() };
}

/// The diagonal of the bodies' box; 0: there is nothing.
double SizeOf(const ModelBodies& model);

/// Of its edges.
double LengthOf(const TopoDS_Shape& shape);

/// Edges between two different faces of a body, and, if asked for, all others without an angle.
/// @param tolerance  angle above which an edge is concave, radians.
std::vector<EdgePlace> EdgesOf(
  const ModelBodies& model, const std::vector<FacePlace>& faces, double tolerance, bool all);

/// Whether two faces lie on one plane or cylinder.
bool AreSame(const TopoDS_Face& a, const TopoDS_Face& b, double nearness);

/// A face whose surface, extended, may divide a solid at a concave edge.
struct CutTool
{
  int Face = 0; ///< id
  gp_Pnt Place; ///< in the middle of the edge
};

/// One of every surface, those at the longest edges first.
/// @param size  of the model.
std::vector<CutTool> CutTools(
  const std::vector<EdgePlace>& edges, const std::vector<FacePlace>& faces, double size);
}
