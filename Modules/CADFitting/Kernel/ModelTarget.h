// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/FitTarget.h>
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// Angles in degrees.
struct ModelTargetParams
{
  /// Between the normals of faces, in the mean along a common edge, from which on it is sharp,
  /// (0, 180).
  double SharpAngle = 20.0;
  double CornerAngle = 60.0; ///< turn of sharp edges from which on there is a corner, (0, 180]
  /// Of every face of the model the group that it belongs to: faces of one group are one, whatever
  /// the angle between them; negative: none. Empty: no groups.
  std::vector<int> Groups;
};

/// The trimmed faces of a CAD model, or whole spline surfaces, as a target. Its faces are what
/// faces of the model that meet smoothly make, its curves the sharp edges and rims; seams are
/// neither. Sides of faces without loops are one where they agree within 1e-6 of the model's size.
///
/// A query's closest point on a face is that on its surface where the loops enclose it, else that
/// on its edges: the nearest for queries that are nearer than the surface's radii, and for plane
/// faces.
/// @return EmptyInput for a model without faces; TrimmedModel::Check; the errors of
/// ClosestPointSearch and TrimmedRegion; InvalidParameter; SizeMismatch for groups that are not one
/// a face.
Result<FitTargetPtr> MakeModelTarget(
  const TrimmedModel& model, const ModelTargetParams& params = {});

/// Spline curves in space as a target without a surface: corners where they end or meet, unless two
/// meet without a corner.
/// @return EmptyInput; SizeMismatch for curves of other than 3 coordinates; those of
/// ClosestPointSearch.
Result<FitTargetPtr> MakeCurveTarget(
  const std::vector<Spline<1>>& curves, double cornerAngle = 60.0);
}
