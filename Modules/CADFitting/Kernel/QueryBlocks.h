// SPDX-License-Identifier: BSD-3-Clause
// Loops over many queries that can be stopped, private to the kernel.
#pragma once
#include <knotwork/SplineCore/Status.h>
#include <knotwork/SplineCore/Types.h>

#include <functional>

namespace knotwork
{
/// A stage of a whole as a share of its progress; none where there is none.
ProgressCallback PartOf(const ProgressCallback& whole, double begin, double end);

/// Chunks of [0, count) in parallel; between blocks of them the progress is told and may stop.
/// @param what  stands in the message, as "the search for closest points".
/// @return that of the first chunk that fails; Aborted.
Status RunInBlocks(std::size_t count, int threads, const ProgressCallback& progress,
  const char* what, const std::function<Status(Eigen::Index begin, Eigen::Index end)>& chunk);
}
