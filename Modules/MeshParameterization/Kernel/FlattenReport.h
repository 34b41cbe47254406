// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshParameterization.h"

namespace knotwork
{
/// Matrix J of the map of triangle t from its own plane (LayTriangle) to UV.
Eigen::Matrix2d TriangleJacobian(const DiscMesh& mesh, const PointMatrix& uv, std::size_t t);

/// Triangles of zero or negative area in UV, when the sign of the larger part of the area counts
/// as positive.
int CountFlips(const DiscMesh& mesh, const PointMatrix& uv);

/// U <- U E[J J']^(-1/2), E the mean by area: of all linear images of U the one whose mean metric
/// is that of the mesh.
void NormalizeAffinely(const DiscMesh& mesh, PointMatrix& uv);

/// Mirrors UV if most of its area is negative, scales it to the best isometry (least squares of
/// singular values), centres it at the origin, turns it by half a turn if point 0 has u < 0.
void NormalizeSimilarity(const DiscMesh& mesh, PointMatrix& uv);

/// Turns the longer principal axis along u: what eigenvectors of a double eigenvalue leave open.
void TurnToAxes(PointMatrix& uv);

/// max(s1, 1 / s2) over all triangles; infinite when one is flipped (NaN values count as flipped).
double LargestStretch(const DiscMesh& mesh, const PointMatrix& uv);

/// All measures of a map that has been normalized.
/// @param estimator  of the distances that DistanceError compares with.
FlattenMeasures MeasureMap(
  const DiscMesh& mesh, const PointMatrix& uv, GeodesicEstimator estimator);
}
