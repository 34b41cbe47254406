// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/AnalyticPatch.h>
#include <knotwork/SplineCore/FitCircle.h>
#include <knotwork/SplineCore/Status.h>

#include <vector>

/// Private to ModelRegions: curves along which analytic surfaces meet.
namespace knotwork
{
/// The nearest point that lies on all surfaces, about: Gauss-Newton steps of least length. Surfaces
/// that touch, that meet in less than five degrees, or that meet farther away than stated, count as
/// one, with the mean of their distances.
Eigen::Vector3d MoveOnto(
  const std::vector<AnalyticSurface>& surfaces, const Eigen::Vector3d& point, double farthest);

enum class EdgeShapeKind
{
  Line,
  Circle,
  Spline
};

/// A curve over [0, 1].
struct EdgeShape
{
  EdgeShapeKind Kind = EdgeShapeKind::Line;
  std::array<Eigen::Vector3d, 2> Ends; ///< exact
  CircularArc Arc;                     ///< of a circle
  Spline<1> Curve;                     ///< of a spline

  /// @param t  n x 1.
  PointMatrix Points(const PointMatrix& t) const;
  /// Where the shape is next to points along it; rising from 0 to 1, the ends are the ends.
  std::vector<double> SharesOf(const std::vector<Eigen::Vector3d>& points) const;
  /// A bound of how far points along the shape are from it.
  double DistanceOf(const std::vector<Eigen::Vector3d>& points) const;
};

struct EdgeShapeParams
{
  double Farthest = 0.0; ///< way of points to where surfaces meet
  double Exact = 0.0;    ///< distance from a surface that counts as none
  double Loose = 0.0;    ///< a line or circle that comes so near is taken rather than a spline
  /// Largest distance of the chain's points from its curve, finite where surfaces alone do not say
  /// where that is.
  double Along = HUGE_VAL;
};

/// The curve along a chain of points on one surface, or between two: a line, a circle, or a quintic
/// spline, the first that lies on them.
/// @param points  three or more, or two that differ; the first and the last one are the ends.
EdgeShape FindEdgeShape(const std::vector<Eigen::Vector3d>& points,
  const std::vector<AnalyticSurface>& surfaces, const EdgeShapeParams& params);

/// The line, circle or profile on a patch along which one parameter is fixed.
EdgeShape IsoparametricShape(
  const AnalyticPatch& patch, const std::array<Eigen::Vector2d, 2>& ends, int fixed);

/// The image of an edge on a patch.
struct EdgeOnPatch
{
  const AnalyticPatch* Patch = nullptr;
  std::array<Eigen::Vector2d, 2> Ends; ///< parameters of the surface at the shape's ends, exact
  int Fixed = -1; ///< the parameter that is that of the first end all along; -1: none
};

/// A curve with its images, over one space.
struct EdgeSpline
{
  Spline<1> Curve;
  std::vector<PointMatrix> UV; ///< pcurves in the space of the curve, one an image
  double Gap = 0.0;            ///< largest distance of curve and images at samples
};

/// An edge with its pcurves over one space: linear where that is exact, else quintic with knots
/// where spans of patches meet, halved until the images are within a distance beyond that of the
/// shape from the surfaces.
/// @return SingularSystem.
Result<EdgeSpline> MakeEdgeSpline(
  const EdgeShape& shape, const std::vector<EdgeOnPatch>& images, double exact);

/// The same of a curve that is given with images on splines: its knots are kept, and inserted
/// between, until the images on patches are as near; then it is moved halfway to these.
/// @param given  UV of images over the curve's space; they come after those on patches.
/// @return SingularSystem.
Result<EdgeSpline> FollowCurve(const Spline<1>& curve, const std::vector<EdgeOnPatch>& images,
  const std::vector<PointMatrix>& given, double exact);
}
