// SPDX-License-Identifier: BSD-3-Clause
// What a target leaves open of the place of a scan, private to the kernel.
#pragma once
#include "PoseSearch.h"

namespace knotwork
{
/// Independent motions at which the scan stays on the target: what it shows is slid along what its
/// equations do not hold.
/// @param found  Motion and OutlierDistance. @return the target's errors.
Result<int> CountFreeMotions(const AlignmentSamples& samples, const FitTarget& target,
  const RigidAlignment& found, int threads);

/// Poses at which the scan lies as well as where it was found, that one included.
/// @param poses  others to look at, the best first. @param found  as CountFreeMotions.
/// @return the target's errors; Aborted.
Result<int> CountEqualPoses(const TriangleMesh& scan, const AlignmentSamples& samples,
  const FitTarget& target, const AlignmentParams& params, const std::vector<Pose>& poses,
  const RigidAlignment& found);
}
