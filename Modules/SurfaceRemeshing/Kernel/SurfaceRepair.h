// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/MeshParameterization/TriangleMesh.h>

#include <string>
#include <vector>

namespace knotwork
{
/// What was done to a surface at a place.
enum class RepairKind
{
  DegenerateFace = 0, ///< a triangle without an area was taken away
  DuplicateFace,      ///< a triangle on top of another one was taken away
  LooseFace,          ///< triangles of an open piece that hangs on the surface or beside it
  TurnedFace,         ///< a triangle was turned over
  Junction,           ///< an edge of one triangle that others meet was divided and joined
  Hole,               ///< closed with new triangles
  Intersection,       ///< two triangles that met were divided and joined without crossing
  DividedEdge,        ///< an edge of more than two triangles became several
  DividedPoint,       ///< a point where fans of triangles touch became several
  CutTip,             ///< a point of touching fans that could not be moved apart was cut off
  Overlap,            ///< a sheet of an overlap, nearer to the surface than OverlapDepth, went
  InnerWall,          ///< a sheet of a deeper overlap stayed, as a wall of its own
  SmallPart,          ///< a part smaller than SmallestPart went
  Patch ///< triangles around sheets that did not come apart went, and the hole was closed
};
inline constexpr int NumRepairKinds = static_cast<int>(RepairKind::Patch) + 1;

/// In words of the report: "degenerate_faces".
const char* ToString(RepairKind kind);

struct RepairAction
{
  RepairKind Kind;
  Eigen::Vector3d Place;
  double Size =
    0.0; ///< an area, of DividedEdge, DividedPoint and CutTip none, of Hole and Patch the diameter
};

struct SurfaceRepairParams
{
  /// Farthest that the result may be from the input, and the input from the result, share of the
  /// diagonal of the input's box, [0, 1].
  double Limit = 0.01;
  /// Holes of up to this diameter are closed, share of the diagonal, [0, 1]; 0: none.
  double LargestHole = 0.0;
  bool AllowOpen = false; ///< holes that stay are no error
  /// Overlaps of less depth go, deeper ones become inner walls; share of the diagonal, [0, 1].
  double OverlapDepth = 0.0005;
  /// Parts of less diameter go, share of the diagonal, [0, 1]; 0: none.
  double SmallestPart = 0.0;
  /// What cannot be repaired gets a surface around it, which is no repair: all points are new,
  /// holes and inner parts that a ball of WrapAlpha does not reach are lost, Limit does not count.
  bool AlphaWrap = false;
  double WrapAlpha = 0.02;   ///< radius of the ball, share of the diagonal, ]0, 1]
  double WrapOffset = 0.001; ///< distance of the surface from the triangles, the same
  int Threads = 0;
  ProgressCallback Progress;
};

struct RepairNumbers
{
  int Points = 0;
  int Triangles = 0;
  int Parts = 0;
  int Euler = 0; ///< points - edges + triangles, of points that are used, equal ones being one
  double Area = 0.0;
  double Volume = 0.0; ///< signed sum, of a closed surface its volume
};

struct SurfaceRepair
{
  TriangleMesh Mesh;
  std::vector<int> PointIds;    ///< of the input, -1: new; one a point
  std::vector<int> TriangleIds; ///< of the input's triangle that it is a part of, -1: new
  std::vector<RepairAction> Actions;
  int MergedPoints = 0; ///< that were equal to others
  bool Changed = false; ///< false: points and triangles are those of the input
  bool Closed = true;
  bool Wrapped = false;   ///< an alpha wrap, no repair: everything is new, there are no actions
  std::string WrapReason; ///< why it could not be repaired
  RepairNumbers Before;
  RepairNumbers After;
  double DistanceFromInput =
    0.0; ///< farthest that the result is from the input and from what closed its holes
  double DistanceToInput = 0.0; ///< farthest that the input is from the result
  double Diagonal = 0.0;        ///< of the input's box

  int Count(RepairKind kind) const;
};

/// Makes a closed, oriented surface whose triangles meet in common edges and corners only, of
/// triangles that should be one. Points that nothing is wrong with stay where they are, to the bit.
/// @return EmptyInput; NonFiniteInput with the point; InvalidTopology: corners that are no points,
/// holes that stay (places and diameters), one-sided surfaces, edges that cannot be joined;
/// NotConverged: intersections that stay (places), the limit (place); InvalidParameter; Aborted.
Result<SurfaceRepair> RepairSurface(
  const TriangleMesh& mesh, const SurfaceRepairParams& params = {});
}
