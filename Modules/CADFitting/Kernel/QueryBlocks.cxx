// SPDX-License-Identifier: BSD-3-Clause
#include "QueryBlocks.h"

#include <knotwork/SplineCore/Parallel.h>

#include <algorithm>
#include <string>
#include <vector>

namespace knotwork
{
namespace
{
constexpr std::size_t ChunkSize = 64;
constexpr std::size_t AtOnce = 8192;
}

ProgressCallback PartOf(const ProgressCallback& whole, double begin, double end)
{
  if (!whole)
  {
    return {};
  }
  return [whole, begin, end](double share) { return whole(begin + (end - begin) * share); };
}

Status RunInBlocks(std::size_t count, int threads, const ProgressCallback& progress,
  const char* what, const std::function<Status(Eigen::Index begin, Eigen::Index end)>& chunk)
{
  for (std::size_t first = 0; first < count; first += AtOnce)
  {
    if (progress && !progress(static_cast<double>(first) / static_cast<double>(count)))
    {
      return { ErrorCode::Aborted, std::string(what) + " stopped" };
    }
    const std::size_t here = std::min(AtOnce, count - first);
    std::vector<Status> statuses((here + ChunkSize - 1) / ChunkSize);
    ParallelFor(here, ChunkSize, threads,
      [&](std::size_t begin, std::size_t end)
      {
        statuses[begin / ChunkSize] =
          chunk(static_cast<Eigen::Index>(first + begin), static_cast<Eigen::Index>(first + end));
      });
    for (const Status& status : statuses)
    {
      if (!status)
      {
        return status;
      }
    }
  }
  return {};
}
}
