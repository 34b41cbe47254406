// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include <vector>

namespace knotwork
{
struct EdgeUse
{
  int Edge = 0;
  bool Reversed = false; ///< as seen with the face's normal
};

struct ShellInput
{
  std::vector<TopoDS_Face> Faces;         ///< turned where neighbours disagree
  std::vector<int> Bodies;                ///< of the faces
  std::vector<std::vector<EdgeUse>> Uses; ///< of a face, without degenerate edges
  int NumEdges = 0;
};

/// Shells of faces of one body that hang together by edges, turned so that they agree on their
/// normals (faces that cannot agree are shells of their own). Closed shells are solids with normals
/// outward; a closed shell that is turned inward and lies in another one of its body is a cavity of
/// it. Several results are a compound.
TopoDS_Shape MakeBodies(ShellInput& input);
}
