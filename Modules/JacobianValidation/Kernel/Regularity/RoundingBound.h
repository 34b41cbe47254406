// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>

/// What error bounds of doubles are made with.
namespace knotwork
{
/// |a| and max(a, b) of the arithmetics that need error bounds.
inline double Magnitude(double a)
{
  return std::fabs(a);
}
inline double Larger(double a, double b)
{
  return a > b ? a : b;
}

/// u = 2^-53, and r u / (1 - r u) with the factor that covers the rounding of magnitudes.
inline constexpr double UnitRoundoff = 0x1p-53;
inline double RoundingFactor(int roundings)
{
  const double ru = roundings * UnitRoundoff;
  return ru / (1.0 - ru) * (1.0 + 0x1p-30);
}
}
