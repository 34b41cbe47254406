// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// The use of an edge by a face: curve in space and pcurve need not be in one space here.
struct BoundaryCurve
{
  Spline<1> Curve;
  Spline<1> Parameters; ///< on the domain of Curve
  int Edge = 0;         ///< in [0, NumEdges)
  std::array<int, 2> Vertices{ 0, 0 };
  bool Reversed = false;
  bool Degenerate = false; ///< the curve is a point
};

using BoundaryLoop = std::vector<BoundaryCurve>;

/// Boundaries of all faces of a model, also of those without loops.
struct SewnBoundary
{
  std::vector<std::vector<BoundaryLoop>> Faces;
  int NumEdges = 0;
  int NumVertices = 0;
};

/// Loops of faces that have some, the four sides of the surface of those that have none. Sides of
/// faces of one body within the tolerance of each other are one edge: the curve of the first one
/// counts. Bodies do not share edges in the result.
/// @pre model.Check() is Ok and the surfaces of faces without loops have clamped knots.
SewnBoundary SewBoundary(const TrimmedModel& model, double tolerance);
}
