// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
struct TrimmedMeshParams
{
  double Tolerance = 0.0; ///< largest distance between triangles and faces, unit of the points, > 0
  int MaxTriangles = 5000000; ///< over all faces, >= 1
  int Threads = 0;
  ProgressCallback Progress;
};

/// Triangles of trimmed faces, watertight along common edges.
struct TrimmedMesh
{
  PointMatrix Points;  ///< n x 3; a point of an edge is stored once and lies on the edge's curve
  PointMatrix Normals; ///< n x 3 unit; at edges of several faces that of the first one
  std::vector<std::array<int, 3>> Triangles; ///< counterclockwise seen against the face's normal
  std::vector<int> TriangleFace;
  std::vector<std::array<std::array<double, 2>, 3>>
    TriangleUV; ///< parameters of the corners in the triangle's face
  /// Of the distance of triangles to faces and of faces to triangles, proved. Above Tolerance only
  /// where MaxTriangles stopped, or where curves of edges are further than half of it from the
  /// surface.
  double Bound = 0.0;
};

/// Constrained Delaunay triangulations in the parameter planes, refined until the chordal deviation
/// is within the tolerance: edges are sampled once for all faces along them, faces at the corners
/// of cells within which linear interpolation is good enough (ChordalBound.h), and every triangle
/// is bounded, by the second derivatives around it, by how far chords are from the curves of edges
/// and by how far those are from the surface. Polygons that cross although their curves do not are
/// divided. Triangles are not flipped in the parameter plane. The result does not depend on
/// threads.
/// @return failures of TrimmedModel::Check; InvalidParameter; InvalidTopology for loops that cross;
/// TooLarge; Aborted.
Result<TrimmedMesh> TriangulateFaces(const TrimmedModel& model, const TrimmedMeshParams& params);

/// The same where the tolerance may be finer too: loops whose curves do not cross may have polygons
/// that do, at one fineness and not at another; up to three times it is lowered by a fifth then.
Result<TrimmedMesh> TriangulateFacesFiner(const TrimmedModel& model, TrimmedMeshParams params);
}
