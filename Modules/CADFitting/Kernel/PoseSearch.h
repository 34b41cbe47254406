// SPDX-License-Identifier: BSD-3-Clause
// Search for the poses of a scan on its target, private to the kernel.
#pragma once
#include "AlignmentSamples.h"
#include "AlignmentSteps.h"

#include <limits>

namespace knotwork
{
// shares of the target's size
inline constexpr double LastSearchDistance = 0.03; ///< of outliers
inline constexpr double SamePose = 0.03;

struct Pose
{
  RigidMotion Motion;
  double Score = std::numeric_limits<double>::infinity();
};

/// Poses in which the scan fits nearly as well as in the best one, the best first: from principal
/// axes, and from rotations spread evenly where axes are ambiguous or do not fit.
/// @param poses  result. @return the target's errors; Aborted.
/// @source  Alexa, CVPR (2022) 8281-8290 (even rotations).
Status SearchPoses(const AlignmentSamples& samples, const FitTarget& target,
  const AlignmentParams& params, std::vector<Pose>& poses);
}
