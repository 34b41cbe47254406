// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/Types.h>

#include <cstddef>

namespace knotwork
{
/// Calls visit(begin, end) for blocks of [0, count) in turn and tells the progress after each.
/// @return false: stopped.
template <class Visit>
bool VisitBlocks(std::size_t count, const ProgressCallback& progress, Visit&& visit)
{
  constexpr std::size_t blocks = 16;
  for (std::size_t block = 0; block < blocks; ++block)
  {
    visit(block * count / blocks, (block + 1) * count / blocks);
    if (progress && !progress(static_cast<double>(block + 1) / static_cast<double>(blocks)))
    {
      return false;
    }
  }
  return true;
}
}
