// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>

namespace knotwork
{
void ParallelFor(std::size_t count, std::size_t chunk, int threads,
  const std::function<void(std::size_t begin, std::size_t end)>& body)
{
  chunk = std::max<std::size_t>(chunk, 1);
  const std::size_t chunks = (count + chunk - 1) / chunk;
  const auto one = [&](std::size_t k) { body(k * chunk, std::min(count, (k + 1) * chunk)); };
  if (threads == 1 || chunks <= 1)
  {
    for (std::size_t k = 0; k < chunks; ++k)
    {
      one(k);
    }
    return;
  }
  const auto all = [&]
  { tbb::parallel_for(std::size_t(0), chunks, one, tbb::simple_partitioner()); };
  // a call from a body has the threads of the one around it, no more
  if (threads <= 0 || threads >= tbb::this_task_arena::max_concurrency())
  {
    all();
    return;
  }
  // workers take 50 microseconds to find a new arena: a thread keeps those it has used
  thread_local std::map<int, tbb::task_arena> arenas;
  arenas.try_emplace(threads, threads).first->second.execute(all);
}
}
