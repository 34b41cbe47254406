// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleSag.h"
#include <knotwork/SplineCore/SurfaceProfile.h>

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int Quarterings = 3;

using Corners = std::array<Eigen::Vector3d, 3>;

/// Of the second derivative of a torus' distance in the triangle; infinite when there is none.
double CurvatureBound(const AnalyticSurface& torus, const Corners& corners)
{
  // no point of the triangle is farther from its corners than the longest edge
  double reach = 0.0;
  double nearest = HUGE_VAL; // to the circle of centres
  double out = HUGE_VAL;     // to the axis
  for (std::size_t k = 0; k < 3; ++k)
  {
    reach = std::max(reach, (corners[k] - corners[(k + 1) % 3]).norm());
    nearest = std::min(nearest, torus.Distance(corners[k]) + torus.MinorRadius);
    const Eigen::Vector3d offset = corners[k] - torus.Point;
    out = std::min(out, (offset - offset.dot(torus.Axis) * torus.Axis).norm());
  }
  nearest -= reach;
  out -= reach;
  return nearest > 0.0 && out > 0.0 ? std::max(1.0 / nearest, 1.0 / out) : HUGE_VAL;
}

/// The same of the distance from a profile, in its plane.
double CurvatureBoundOfProfile(const AnalyticSurface& surface, const Corners& corners)
{
  double reach = 0.0;
  double farthest = 0.0;
  double out = HUGE_VAL;   // to the axis
  double begin = HUGE_VAL; // on the profile
  double end = -HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const double place = surface.Profile->Nearest(surface.InProfile(corners[k]));
    begin = std::min(begin, place);
    end = std::max(end, place);
    const Eigen::Vector2d at = surface.InProfile(corners[k]);
    reach = std::max(reach, (at - surface.InProfile(corners[(k + 1) % 3])).norm());
    farthest = std::max(farthest, std::abs(surface.Distance(corners[k])));
    out = std::min(out, at[0]);
  }
  if (surface.Type == SurfaceType::Revolution)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      reach = std::max(reach, (corners[k] - corners[(k + 1) % 3]).norm());
    }
  }
  // the nearest points are next to those of corners, parameters about lengths
  const double curvature = surface.Profile->MaxCurvature(begin - 2.0 * reach, end + 2.0 * reach);
  const double left = 1.0 - curvature * (farthest + reach); // of the way to a centre of curvature
  const double inPlane = left > 0.0 ? curvature / left : HUGE_VAL;
  if (surface.Type == SurfaceType::Extrusion)
  {
    return inPlane;
  }
  out -= reach;
  return out > 0.0 ? std::max(inPlane, 1.0 / out) : HUGE_VAL;
}

/// The square of the longest side, of an extrusion as it is seen along the axis.
double LongestSquare(const AnalyticSurface& surface, const Corners& corners)
{
  const bool isSeen = surface.Type == SurfaceType::Extrusion;
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    const Eigen::Vector3d side = corners[k] - corners[(k + 1) % 3];
    const double along = isSeen ? side.dot(surface.Axis) : 0.0;
    longest = std::max(longest, side.squaredNorm() - along * along);
  }
  return longest;
}

double Bound(const AnalyticSurface& surface, const Corners& corners, int left)
{
  std::array<double, 3> distances{};
  double most = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
  {
    distances[k] = surface.Distance(corners[k]);
    most = std::max(most, std::abs(distances[k]));
  }
  if (surface.Type == SurfaceType::Plane || surface.Type == SurfaceType::FreeForm)
  {
    return most;
  }
  if (left > 0)
  {
    const Eigen::Vector3d ab = 0.5 * (corners[0] + corners[1]);
    const Eigen::Vector3d bc = 0.5 * (corners[1] + corners[2]);
    const Eigen::Vector3d ca = 0.5 * (corners[2] + corners[0]);
    for (const Corners& part : { Corners{ corners[0], ab, ca }, Corners{ ab, corners[1], bc },
           Corners{ ca, bc, corners[2] }, Corners{ ab, bc, ca } })
    {
      most = std::max(most, Bound(surface, part, left - 1));
    }
    return most;
  }
  if (surface.Type == SurfaceType::Torus || HasProfile(surface.Type))
  {
    const double curvature = surface.Type == SurfaceType::Torus
      ? CurvatureBound(surface, corners)
      : CurvatureBoundOfProfile(surface, corners);
    // of a function of second derivatives up to c, from the linear one through the corners: half of
    // c times the sum of l_i l_j e_ij^2 over pairs, and the l_i l_j sum up to a third at most
    return most + curvature * LongestSquare(surface, corners) / 6.0;
  }
  const Eigen::Vector3d centre = (corners[0] + corners[1] + corners[2]) / 3.0;
  const Eigen::Vector3d gradient = surface.Normal(centre);
  double least = HUGE_VAL;
  for (const Eigen::Vector3d& corner : corners)
  {
    least = std::min(least, surface.Distance(centre) + gradient.dot(corner - centre));
  }
  return std::max(most, -least);
}
}

double BoundDistance(const AnalyticSurface& surface, const Corners& corners)
{
  return Bound(surface, corners, Quarterings);
}

double MaxMiddleDistance(const AnalyticSurface& surface, const Corners& corners)
{
  double largest = std::abs(surface.Distance((corners[0] + corners[1] + corners[2]) / 3.0));
  for (std::size_t k = 0; k < 3; ++k)
  {
    largest =
      std::max(largest, std::abs(surface.Distance((corners[k] + corners[(k + 1) % 3]) / 2.0)));
  }
  return largest;
}
}
