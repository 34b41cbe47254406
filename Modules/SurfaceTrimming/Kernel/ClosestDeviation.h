// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FaceCertificate.h"

namespace knotwork
{
struct ClosestDeviationParams
{
  /// Bounds that are not larger are left as they are, > 0.
  double Enough = 0.0;
  /// Others are refined until they are at most so many times the largest distance found, > 1.
  double Ratio = 1.1;
  /// Parts of triangles looked at before the rest is left as it is.
  int MaxPieces = 20000;
  int Threads = 0; ///< 0: all cores; the result does not depend on it
  ProgressCallback Progress;
};

/// Bounds by closest points instead of equal parameters, where the latter say much more than the
/// distance: the surface has slid along itself there, or another face lies nearer.
///
/// A triangle has two parts to prove: that its points are near the faces, and that the surface over
/// it is near the mesh. For the first one the triangle, for the second one its image in the plane
/// is quartered again and again, the worst piece first. A piece of the mesh is paired with a
/// triangle within the plane triangle of any chart, a piece of the plane with one within any
/// triangle of the mesh: the closest points of its corners. The affine map between both stays
/// within the partner, which is convex, so that DeviationSearch's bound of the distance of partners
/// holds for the piece.
/// @param faces  of the charts: surfaces of tensor spaces.
/// @param deviations  of BoundDeviation, one a chart: TriangleBound, TriangleFound, PointDeviation
///        and the largest ones become smaller, the sums stay.
/// @return Aborted.
/// @complexity some dozens of distances and bounds a piece.
Status RefineDeviations(const std::vector<ChartMesh>& charts, const std::vector<TrimmedFace>& faces,
  const ClosestDeviationParams& params, std::vector<ChartDeviation>& deviations);
}
