// SPDX-License-Identifier: BSD-3-Clause
// Hexahedra between layers of one quadrilateral mesh.
#pragma once
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/Status.h>

#include <vector>

namespace knotwork
{
/// Layers of a swept mesh lie one behind the other: point v of layer k has number k * n + v where
/// the source has n points, hexahedron q of layer k number k * m + q.
struct SweptMesh
{
  CellMesh<3> Mesh; ///< right-handed where the layers move that way
  PointMatrix Points;
  int Layers = 0; ///< of hexahedra
  /// The last layer of points is the first one, and is not there twice.
  bool IsRing = false;
};

struct PathSweepParams
{
  /// Where the sweep goes, m x 3, m >= 2; one whose last point is its first one closes to a ring.
  PointMatrix Path;
  int Layers = 8;     ///< >= 1, of a ring >= 3; of equal length
  double Twist = 0.0; ///< degrees about the path, from its begin to its end; of a ring times of 360
  double Scale = 1.0; ///< of the end, about the path, > 0; of a ring 1
  ProgressCallback Progress;
};

/// Moves quadrilaterals along a path: they keep their place in a frame that turns with the path as
/// little as can be (rotation minimizing; what a ring does not close by, is turned back bit by
/// bit). The source lies where it is, at the begin of the path or beside it.
/// @param points  n x 3.
/// @return EmptyInput; InvalidParameter; NonFiniteInput with the point; InvalidTopology: corners
/// that are no points, a path without length or that turns back on itself; TooLarge; Aborted.
/// Cells may be folded where the path turns more sharply than the source is wide: certify them.
/// @complexity O(n Layers)
/// @source  Wang, Juettler, Zheng, Liu, ACM TOG 27 (2008) 2 (double reflection).
Result<SweptMesh> SweepAlongPath(
  const CellMesh<2>& mesh, const PointMatrixView& points, const PathSweepParams& params);

struct LinkedSweepParams
{
  /// Where the rim of the source goes: points of the source, those of its rim at least.
  std::vector<int> Rim;
  /// For each of them its places layer by layer, the first one its own: as many as layers and one.
  std::vector<PointMatrix> Columns;
  /// Where points of the source arrive, n x 3; empty: they follow the rim.
  PointMatrix Target;
  ProgressCallback Progress;
};

/// Fills what lies between a source and a target, and columns of points between their rims. Inner
/// points of a layer lie where the affine map of one end's rim to the layer's rim puts those of
/// that end, corrected by the harmonic function of the mesh that makes it right on the rim; both
/// ends count by their nearness.
/// @return as SweepAlongPath; SizeMismatch: columns of other lengths; InvalidTopology: a point of
/// the mesh's rim is not in Rim; NotConverged: the equations cannot be solved.
/// @complexity one factorization of a matrix of n rows, and 6 solutions a layer.
/// @source  Staten, Canann, Owen, Engineering with Computers 15 (1999) 212-218 (BMSweep).
Result<SweptMesh> SweepBetween(
  const CellMesh<2>& mesh, const PointMatrixView& points, const LinkedSweepParams& params);
}
