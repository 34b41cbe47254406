// SPDX-License-Identifier: BSD-3-Clause
// Solids that are divided into one grid of hexahedra at each of their corners.
#pragma once
#include "FaceMesher.h"

#include <optional>

namespace knotwork
{
/// A side of a face between two of its corners, or the same of the face beside it.
struct CornerSide
{
  std::vector<int> Edges;     ///< ascending
  std::array<int, 2> Faces{}; ///< that it lies between
};

/// A corner with the three sides that end there.
struct SolidCorner
{
  int Vertex = 0;
  std::array<int, 3> Sides{};
  std::array<int, 3> Faces{}; ///< Faces[i] lies between Sides[i] and Sides[(i + 1) % 3]
};

struct CornerSolid
{
  std::vector<CornerSide> Sides;
  std::vector<SolidCorner> Corners;
};

/// The corners of a solid whose faces are rectangles and polygons with one loop, three of which
/// meet at each corner, and whose edges are convex and not smooth; else nothing. Whether what is
/// inside of such a solid sees all of its faces is not asked.
/// @source  Li, McKeag, Armstrong, Comput. Methods Appl. Mech. Eng. 127 (1995) 157 (midpoint
/// subdivision).
std::optional<CornerSolid> CornersOf(const CADTopology& model, const FaceMesher& faces, int body);
}
