// SPDX-License-Identifier: BSD-3-Clause
// Positions of elements on whole-number grids, private to the kernel.
#pragma once
#include "Types.h"

#include <array>
#include <cstdint>

namespace knotwork
{
/// Chart coordinates: a level-0 cell is 2^ChartBits wide; 24 levels, 10 halvings and a middle point
/// stay whole numbers.
inline constexpr int ChartBits = 36;

/// Position of an element on the dyadic grid of its chart. A chart is a patch with a parameter
/// domain or a single element of a patch without.
template <int Dim>
struct ChartCell
{
  int Chart = 0;
  int Level = 0;
  std::array<std::int64_t, Dim> Lower{};
  std::array<std::int64_t, Dim> Size{};
  std::array<bool, Dim> RimLow{};
  std::array<bool, Dim> RimHigh{};
};
}
