// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/TargetDistances.h>
#include <knotwork/MeshParameterization/TriangleMesh.h>

namespace knotwork
{
struct DeviationMapParams
{
  int Samples = 20000; ///< points of the model at least, [100, 10000000]
  /// Model points that are farther from the scan have no distance: nobody scanned them; 0: all have
  /// one.
  double MaximumDistance = 0.0;
  int Threads = 0;
  ProgressCallback Progress;
};

/// Distances are positive where the scan lies outside of the model (of an open one on the side that
/// its normals point to), both ways. Those of the model's points are by the scan's own inside and
/// outside where its triangles are a surface, else by the side of the model's normal.
struct DeviationMap
{
  TargetDistances OfScan; ///< of the scan's points from the model
  DistanceProfile ScanProfile;
  TriangleMesh Model; ///< its triangles, divided; points lie on the model
  /// Of the model's points from the scan's triangles, or its points where it has none; NaN beyond
  /// MaximumDistance.
  Eigen::VectorXd OfModel;
  PointMatrix ScanPoints;       ///< of the scan, nearest to the model's
  DistanceProfile ModelProfile; ///< by area
  int NumWithout = 0;           ///< model points without a distance
};

/// Compares a scan with a model both ways.
/// @param triangles  of the target, close to it.
/// @return EmptyInput: no points, no triangles; NonFiniteInput with the point; InvalidTopology: a
/// corner that is no point; InvalidParameter: an option, no point of the model within
/// MaximumDistance; TooLarge: the triangles make more than 20,000,000 points; Aborted; the target's
/// errors.
Result<DeviationMap> MapDeviation(const TriangleMesh& scan, const FitTarget& target,
  TriangleMesh triangles, const DeviationMapParams& params = {});
}
