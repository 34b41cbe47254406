// SPDX-License-Identifier: BSD-3-Clause
// Where the surface of a mesh belongs on a target, private to the kernel.
#pragma once
#include "FitTarget.h"
#include "SurfaceMesh.h"

#include <set>

namespace knotwork
{
/// A curve or corner of the target that the mesh has no edges or point for.
struct UnmatchedFeature
{
  TargetPart Part;
  std::array<double, 3> Place{}; ///< in the middle of the curve, or the corner
};

struct MeshClassification
{
  std::vector<TargetPart> PointParts; ///< of every point of the mesh; Surface for others
  std::vector<int> CurveOf;           ///< of every edge of the surface, -1: none
  std::vector<int> FaceOf;            ///< of every quadrilateral of the surface, -1: any
  std::vector<UnmatchedFeature> Unmatched;
};

struct ClassificationParams
{
  /// Distance of a point of the mesh from its corner or curve at most, in mean edges at the point.
  double MaxMove = 0.5;
  bool Faces = true;     ///< whether quadrilaterals are matched with faces
  std::set<int> LeftOut; ///< curves that are not looked for
  std::set<int> LeftOutCorners;
  int Threads = 0;
};

/// Corners go to the nearest points of the mesh; curves to the paths of edges between them that are
/// the shortest when edges that are far from the curve count more; what these enclose to the faces
/// that most of it is next to, but for parts behind unmatched curves. A corner that is farther away
/// than MaxMove, a curve with a path that leaves it by as much or that passes only a part of it, is
/// unmatched.
/// @complexity O(points log(points)) and, a curve, O(points near it log).
Result<MeshClassification> ClassifyMesh(const SurfaceMesh& surface, const PointMatrix& points,
  const FitTarget& target, const ClassificationParams& params = {});
}
