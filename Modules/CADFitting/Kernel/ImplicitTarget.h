// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADFitting/FitTarget.h>

#include <functional>

namespace knotwork
{
/// Value of a function whose zero set is the surface, and its gradient.
/// @param point  3 values. @param gradient  3 values, to set. Called from several threads.
using ImplicitFunction = std::function<double(const double* point, double* gradient)>;

struct ImplicitTargetParams
{
  int MaxIterations = 100;  ///< of a closest point, >= 1
  double Tolerance = 1e-13; ///< of a step, relative to the query's coordinates, > 0
  /// Box in which Samples looks for the surface; empty (lower > upper): none, no samples.
  std::array<double, 3> Lower{ 0.0, 0.0, 0.0 };
  std::array<double, 3> Upper{ -1.0, -1.0, -1.0 };
};

/// The zero set of a function as a target of one face without curves, closed. Closest points along
/// the gradient onto the surface, then on it along the query's difference in the tangent plane, as
/// long as that comes nearer: local least distances, those of the nearest part where the query is
/// nearer than the surface's radii.
/// @return EmptyInput without a function; InvalidParameter.
/// @source  Hartmann, The Visual Computer 15 (1999) 95-108 (foot points of implicit surfaces).
Result<FitTargetPtr> MakeImplicitTarget(
  ImplicitFunction function, const ImplicitTargetParams& params = {});
}
