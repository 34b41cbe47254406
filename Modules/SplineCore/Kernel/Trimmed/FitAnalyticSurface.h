// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/AnalyticSurface.h>

#include <limits>
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

/// The axis of a circle along which points lie, as those of a long and narrow piece of a torus; its
/// Point is the centre. @return false: the points lie on a line.
bool GuessCircleAxis(const std::vector<Eigen::Vector3d>& points, AnalyticSurface& surface);

/// The torus about an axis: the circle next to the points where these are turned into one plane.
/// @param surface  Point and Axis on the axis; result. @return false: the points lie on a line.
bool GuessTorusAbout(const std::vector<Eigen::Vector3d>& points, AnalyticSurface& surface);

/// Least squares of the points' distances from a surface on, by damped Gauss-Newton steps.
/// @param hopeless  a root mean square distance: where it is more after 8 steps, these are the
/// last.
/// @param steps  at most: narrow pieces of large tori take hundreds.
/// @return false: it degenerates (a radius above 1e3 sizes of the points, a cone flatter than 85
/// degrees, a torus that runs through its axis).
/// @complexity O(points) a step.
/// @source Lukacs, Martin, Marshall, ECCV (1998) 671 (faithful least squares).
bool FitSurface(const std::vector<Eigen::Vector3d>& points, AnalyticSurface& surface,
  double hopeless = std::numeric_limits<double>::infinity(), int steps = 60);

/// What a fit leaves as it is.
struct HeldParameters
{
  bool Direction = false; ///< of the axis or normal
  bool Position = false;  ///< of planes that along the normal; of others Point keeps to its axis
  bool Size = false;      ///< the radius, of tori the minor one, of cones the angle
};

/// The same with parts of the surface held, but for rounding.
bool FitSurface(
  const std::vector<Eigen::Vector3d>& points, const HeldParameters& held, AnalyticSurface& surface);

/// Sum of the squares of the points' distances.
double SumOfSquaredDistances(
  const std::vector<Eigen::Vector3d>& points, const AnalyticSurface& surface);

/// Largest distance of the points.
double MaxDistance(const std::vector<Eigen::Vector3d>& points, const AnalyticSurface& surface);
}
