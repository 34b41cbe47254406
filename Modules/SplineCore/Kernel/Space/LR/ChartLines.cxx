// SPDX-License-Identifier: BSD-3-Clause
#include "ChartLines.h"

#include <algorithm>
#include <cmath>

namespace knotwork
{
namespace
{
constexpr int HalvingBits = 12;          // of one element: 10 halvings and a middle point
constexpr int PositionBits = 58;         // of the whole chart
constexpr int MaxRounds = 18;            // of lines taken out because they lie halfway
constexpr double MiddleTolerance = 1e-6; // of the distance to the neighbours

struct Middle
{
  std::size_t Line;
  std::size_t Below;
  std::size_t Above;
};
}

std::vector<std::int64_t> ChartLines(const std::vector<double>& values)
{
  // lines halfway between their neighbours go, the finest spacing first, until none is left
  std::vector<std::size_t> left(values.size());
  for (std::size_t i = 0; i < left.size(); ++i)
  {
    left[i] = i;
  }
  std::vector<Middle> middles;
  int rounds = 0;
  for (; rounds < MaxRounds; ++rounds)
  {
    const auto gap = [&](std::size_t i) { return values[left[i + 1]] - values[left[i]]; };
    const auto isMiddle = [&](std::size_t i)
    { return std::fabs(gap(i) - gap(i - 1)) <= MiddleTolerance * gap(i); };
    double finest = values.back() - values.front();
    for (std::size_t i = 1; i + 1 < left.size(); ++i)
    {
      finest = isMiddle(i) ? std::min(finest, gap(i)) : finest;
    }
    std::vector<std::size_t> kept{ left[0] };
    for (std::size_t i = 1; i < left.size(); ++i)
    {
      if (i + 1 < left.size() && kept.back() == left[i - 1] && isMiddle(i) &&
        gap(i) <= finest * (1.0 + MiddleTolerance))
      {
        middles.push_back({ left[i], left[i - 1], left[i + 1] });
      }
      else
      {
        kept.push_back(left[i]);
      }
    }
    if (kept.size() == left.size())
    {
      break;
    }
    left.swap(kept);
  }
  std::vector<std::int64_t> positions(values.size());
  const double unit = std::ldexp(1.0, PositionBits - HalvingBits - rounds);
  std::int64_t last = -1;
  for (const std::size_t i : left)
  {
    const double share = (values[i] - values.front()) / (values.back() - values.front());
    last = std::max<std::int64_t>(last + 1, std::llround(share * unit));
    positions[i] = last * (std::int64_t{ 1 } << (HalvingBits + rounds));
  }
  for (auto middle = middles.rbegin(); middle != middles.rend(); ++middle)
  {
    positions[middle->Line] =
      positions[middle->Below] + (positions[middle->Above] - positions[middle->Below]) / 2;
  }
  return positions;
}
}
