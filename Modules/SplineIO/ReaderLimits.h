// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineGrid/WorkerProcess.h>

#include <cstdint>

namespace knotwork
{
/// What a process may take that reads a file: far above what sound files need.
/// @param bytes  of the file and what belongs to it.
inline WorkerLimits LimitsOfReader(std::uint64_t bytes)
{
  const int megabytes = static_cast<int>(bytes >> 20U < 10'000 ? bytes >> 20U : 10'000);
  WorkerLimits limits;
  limits.Memory = (std::uint64_t{ 1 } << 30U) + 64 * bytes;
  limits.CpuSeconds = 20 + 20 * megabytes;
  limits.Seconds = 55 + 60 * megabytes; // others may want the processors too
  return limits;
}
}
