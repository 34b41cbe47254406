// SPDX-License-Identifier: BSD-3-Clause
#include "ParallelStart.h"

#include <cstdlib>

namespace knotwork
{
ParallelStart FindParallelStart()
{
  // Open MPI; MPICH and Intel MPI; MVAPICH
  constexpr const char* variables[][2] = { { "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK" },
    { "PMI_SIZE", "PMI_RANK" }, { "MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK" } };
  ParallelStart start;
  for (const auto& [sizeName, rankName] : variables)
  {
    const char* size = std::getenv(sizeName);
    if (size && std::atol(size) > 1)
    {
      const char* rank = std::getenv(rankName);
      start.First = !rank || std::atol(rank) == 0;
      start.Refusal = std::string("started as one of several processes (") + sizeName + " is " +
        std::to_string(std::atol(size)) +
        "), each of which would do the whole job; start it without mpirun (it uses all cores), or "
        "unset " +
        sizeName;
      return start;
    }
  }
  return start;
}
}
