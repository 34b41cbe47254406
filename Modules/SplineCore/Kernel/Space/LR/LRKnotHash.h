// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>

namespace knotwork
{
/// Hash of n indices of knots.
inline std::uint64_t LRKnotHash(const int* knots, int n)
{
  std::uint64_t h = 0x9e3779b97f4a7c15ULL;
  for (int i = 0; i < n; ++i)
  {
    h = (h ^ static_cast<std::uint64_t>(knots[i])) * 0xff51afd7ed558ccdULL;
    h ^= h >> 32;
  }
  return h;
}
}
