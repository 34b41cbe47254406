// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

namespace knotwork
{
/// A start of several processes at once (mpirun, mpiexec): each of them would do the whole job and
/// write the same files.
struct ParallelStart
{
  std::string Refusal; ///< one sentence with the variable that says so; empty for a single process
  bool First = true;   ///< the process that speaks for all
};

ParallelStart FindParallelStart();
}
