// SPDX-License-Identifier: BSD-3-Clause
// Distances between a spline on a mesh and a target, private to the kernel.
#pragma once
#include "FitDistances.h"
#include "MeshClassification.h"

#include <knotwork/SplineCore/BezierForm.h>

namespace knotwork
{
struct SampledDistanceParams
{
  int Samples = 0;       ///< Gauss points a direction of an element, [1, 16]; 0: degree + 2
  int TargetSamples = 0; ///< points on the target at least; 0: distances from it are not measured
  bool Surfaces = true;  ///< false: curves and rims alone
  int Threads = 0;
  ProgressCallback Progress;
};

/// @param surface  element i is quadrilateral i of the mesh. @param points  of the mesh as given.
/// @param corners  local parameters of the corners of quadrilateral i on element i: 8 numbers each.
/// @return the target's errors; Aborted.
Result<FitDistances> MeasureDistances(const Spline<2>& surface, const SurfaceMesh& mesh,
  const std::vector<std::array<double, 8>>& corners, const MeshClassification& parts,
  const PointMatrix& points, const FitTarget& target, const SampledDistanceParams& params);
}
