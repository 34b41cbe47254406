// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <array>
#include <vector>

namespace knotwork
{
/// Triangles in space as they are given.
struct TriangleMesh
{
  PointMatrix Points;                        ///< n x 3
  std::vector<std::array<int, 3>> Triangles; ///< rows of Points
};

/// @param triangle  rows of points, n x 3.
double TriangleArea(const PointMatrix& points, const std::array<int, 3>& triangle);

/// A part of a mesh.
struct MeshComponent
{
  TriangleMesh Mesh;
  std::vector<int> PointIds;    ///< of the whole
  std::vector<int> TriangleIds; ///< of the whole
};

/// Parts that hang together by common edges; points that are equal are one, as in files that have
/// the corners of every triangle for themselves. Triangles of two equal corners are in none. A mesh
/// with points that are not finite, or corners that are no points, is one part: CheckComponent says
/// what is wrong with it.
/// @complexity O(n log n).
std::vector<MeshComponent> ConnectedComponents(const TriangleMesh& mesh);

/// A checked mesh: one component of an oriented manifold, and what its algorithms ask for; of
/// CheckMesh a disc with holes. Points and triangles may be fewer than those of the input.
struct DiscMesh
{
  PointMatrix Points;
  std::vector<std::array<int, 3>> Triangles; ///< oriented alike
  std::vector<int> PointIds;                 ///< of the input's points
  std::vector<int> TriangleIds;              ///< of the input's triangles
  int Reversed = 0;                          ///< triangles that were turned over
  int Components = 1;                        ///< of the input

  /// Neighbours of vertex v, counterclockwise: Fan[FanStart[v]] ... Fan[FanStart[v + 1] - 1].
  /// Triangles of v are (v, Fan[j], Fan[j + 1]); at an inner vertex the last one closes the fan.
  std::vector<int> FanStart;
  std::vector<int> Fan;
  std::vector<double> Spokes; ///< length of v - Fan[j]
  std::vector<double> Rims;   ///< length of Fan[j] - next of the fan; 0 at the end of an open fan
  std::vector<char> OnBoundary;
  /// Boundary loops, the longest one first; triangles lie to the left.
  std::vector<std::vector<int>> Loops;
  double Area = 0.0;

  int NumPoints() const { return static_cast<int>(this->OnBoundary.size()); }
  Eigen::Vector3d Point(int v) const { return this->Points.row(v).transpose(); }
};

/// Checks a mesh, which may be closed and have handles, and finds its boundary loops.
/// @param largestComponent  keep the component of the most triangles and drop unreferenced points,
///        instead of refusing several components and such points.
/// @return EmptyInput; NonFiniteInput (ids of points); InvalidTopology: a corner that is no point,
/// degenerate triangles (height below 1e-12 of the longest edge), an edge of three triangles, a
/// vertex where fans of triangles touch, a surface of one side, unreferenced points, several
/// components. Details name up to five ids of the input.
/// @complexity O(n log n).
Result<DiscMesh> CheckSurface(const TriangleMesh& mesh, bool largestComponent = false);

/// The same of a part of a mesh; points and triangles have their numbers in the whole, points also
/// in messages.
Result<DiscMesh> CheckComponent(const TriangleMesh& mesh, const MeshComponent& component);

/// Whether a checked surface is a disc with holes.
/// @return InvalidTopology: a closed surface, handles.
Status CheckDisc(const DiscMesh& surface);

/// CheckSurface and CheckDisc.
Result<DiscMesh> CheckMesh(const TriangleMesh& mesh, bool largestComponent = false);
}
