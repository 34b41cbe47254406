// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceSides.h"

#include <functional>

namespace knotwork
{
struct FittedNormals
{
  std::vector<Eigen::Vector3d> Normals; ///< one a triangle
  std::vector<double> Deviations;       ///< standard deviations of their directions, radians
  std::vector<double> Areas;            ///< of their patches; 0: of the triangle alone
};

struct NormalFitParams
{
  double Noise = 0.0;     ///< standard deviation of the points, >= 0
  double Precision = 0.0; ///< of a normal, radians: patches grow until it is reached
  double Bend = 0.0;      ///< radians: what turns by more, noise apart, is another side
  double Known = 0.0;     ///< radians: deviation from which on nothing is known of a normal
  int Threads = 0;        ///< 0: all cores
  ProgressCallback Progress;
};

/// Normals of planes through patches around the triangles, as large as the noise asks for. Without
/// noise, or where triangles are large enough, they are the triangles' own.
///
/// A patch grows from a triangle to the nearest ones, until the standard deviation of its normal is
/// Precision; triangles whose points lie off the plane, or whose own normal differs from its by
/// more than Bend, by more than three standard deviations do not belong to it. Of all patches that
/// have a triangle, the nearest one gives its normal whose points lie on its plane as the noise
/// says, else the one that is least off: at a sharp edge one that lies on the triangle's own side.
/// @param barrier  whether patches must not grow over side k of triangle t.
/// @return Aborted.
/// @complexity O(n p log p) with p triangles in a patch.
Result<FittedNormals> FitNormals(const SurfaceParts& parts, const NormalFitParams& params,
  const std::function<bool(std::size_t t, std::size_t k)>& barrier);
}
