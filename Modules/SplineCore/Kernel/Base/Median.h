// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace knotwork
{
/// @return values[n / 2] of the sorted values; the order changes.
/// @pre there are some.
/// @complexity O(n).
inline double Median(std::vector<double>& values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// As Median; values become their absolute differences from it.
inline double MedianDeviation(std::vector<double>& values, double median)
{
  for (double& value : values)
  {
    value = std::fabs(value - median);
  }
  return Median(values);
}
}
