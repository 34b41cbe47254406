// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/AnalyticSurface.h>

#include <array>

namespace knotwork
{
/// A bound of the distance of a triangle's points from an analytic surface, proved: distances from
/// planes, cylinders, spheres and cones are convex, so they are largest at corners and nowhere
/// below a tangent plane; the second derivative of those from tori, and from profiles by their
/// curvature, is bounded. Triangles are quartered three times. Infinite for a torus whose circle of
/// centres, or axis, may be met, and so where centres of curvature of a profile may be.
double BoundDistance(const AnalyticSurface& surface, const std::array<Eigen::Vector3d, 3>& corners);

/// Largest distance of the middles of a triangle and of its edges.
double MaxMiddleDistance(
  const AnalyticSurface& surface, const std::array<Eigen::Vector3d, 3>& corners);
}
