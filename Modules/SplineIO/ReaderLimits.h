// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>

namespace knotwork
{
/// What a process may take that reads a file: far above what sound files need.
struct ReaderLimits
{
  std::uint64_t Memory = 0; ///< bytes of data; also of what it hands over
  int CpuSeconds = 0;       ///< of all its threads
  int Seconds = 0;          ///< until it has ended
};

/// @param bytes  of the file and what belongs to it.
inline ReaderLimits LimitsOfReader(std::uint64_t bytes)
{
  const int megabytes = static_cast<int>(bytes >> 20U < 10'000 ? bytes >> 20U : 10'000);
  ReaderLimits limits;
  limits.Memory = (std::uint64_t{ 1 } << 30U) + 64 * bytes;
  limits.CpuSeconds = 20 + 20 * megabytes;
  limits.Seconds = 55 + 60 * megabytes; // others may want the processors too
  return limits;
}
}
