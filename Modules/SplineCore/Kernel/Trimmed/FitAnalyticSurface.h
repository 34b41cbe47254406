// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/AnalyticSurface.h>

#include <vector>

namespace knotwork
{
/// A flat piece of a surface: its centre and its normal of length 1.
struct FlatPiece
{
  Eigen::Vector3d Centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d Normal = Eigen::Vector3d::UnitZ();
};

/// Parameters that a surface of a type has; 0 of free form and of those with a profile.
int NumSurfaceParameters(SurfaceType type);

/// A first guess: planes and spheres by linear least squares of the points, axes of the others by
/// the pieces' normals.
/// @return false: too few or degenerate points or pieces; a type with a profile.
/// @source Pottmann, Randrup, Computing 60 (1998) 307 (axes of revolution as linear complexes).
bool GuessSurface(SurfaceType type, const std::vector<Eigen::Vector3d>& points,
  const std::vector<FlatPiece>& pieces, AnalyticSurface& surface);

/// The axis of a surface of revolution, its Point on it, by the pieces' normals.
/// @return false: the normals are those of a cylinder or plane.
/// @source Pottmann, Randrup, Computing 60 (1998) 307.
bool GuessAxis(const std::vector<Eigen::Vector3d>& points, const std::vector<FlatPiece>& pieces,
  AnalyticSurface& surface);

/// Least squares of the points' distances from a surface on, by damped Gauss-Newton steps.
/// @return false: it degenerates (a radius above 1e3 sizes of the points, a cone flatter than 85
/// degrees, a torus that runs through its axis).
/// @complexity O(points) a step, at most 60 steps.
/// @source Lukacs, Martin, Marshall, ECCV (1998) 671 (faithful least squares).
bool FitSurface(const std::vector<Eigen::Vector3d>& points, AnalyticSurface& surface);

/// Largest distance of the points.
double MaxDistance(const std::vector<Eigen::Vector3d>& points, const AnalyticSurface& surface);
}
