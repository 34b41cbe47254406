// SPDX-License-Identifier: BSD-3-Clause
#include "ValueRange.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

namespace knotwork
{
namespace
{
double Below(double x)
{
  return std::nextafter(x, -std::numeric_limits<double>::infinity());
}
double Above(double x)
{
  return std::nextafter(x, std::numeric_limits<double>::infinity());
}

/// x 2^scale, towards minus infinity where it is not exact.
double ScaledDown(double x, int scale)
{
  const double y = std::ldexp(x, scale);
  return std::fabs(y) < 2.0 * DBL_MIN || std::isinf(y) ? Below(y) : y;
}
}

double ValueRange::Lower(double coefficient) const
{
  double x = ScaledDown(coefficient, this->Scale);
  if (this->WeightLower != 1.0 || this->WeightUpper != 1.0)
  {
    x = Below(x / (x >= 0.0 ? this->WeightUpper : this->WeightLower));
  }
  if (this->Root)
  {
    x = x <= 0.0 ? 0.0 : std::max(Below(std::sqrt(x)), 0.0);
  }
  return x;
}

double ValueRange::Upper(double coefficient) const
{
  double x = -ScaledDown(-coefficient, this->Scale);
  if (this->WeightLower != 1.0 || this->WeightUpper != 1.0)
  {
    x = Above(x / (x >= 0.0 ? this->WeightLower : this->WeightUpper));
  }
  if (this->Root)
  {
    x = x <= 0.0 ? 0.0 : Above(std::sqrt(x));
  }
  return x;
}

ValueRange WeightRange(const double* weights, int count, int power)
{
  ValueRange range;
  const auto ends = std::minmax_element(weights, weights + count);
  for (int k = 0; k < power; ++k)
  {
    range.WeightLower = Below(range.WeightLower * *ends.first);
    range.WeightUpper = Above(range.WeightUpper * *ends.second);
  }
  return range;
}
}
