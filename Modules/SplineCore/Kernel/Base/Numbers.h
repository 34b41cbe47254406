// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>

#include <charconv>
#include <string>

namespace knotwork
{
/// Largest magnitude of coordinates and field values. Beyond the range of a float, and so small
/// that fourth powers (squared lengths of normals) are finite.
inline constexpr double LargestNumber = 1e60;
/// Weights lie in [1 / LargestWeight, LargestWeight].
inline constexpr double LargestWeight = 1e30;

/// True when all values are finite and at most LargestNumber in magnitude.
template <typename Derived>
bool AllWithinLimit(const Eigen::DenseBase<Derived>& values)
{
  return (values.derived().array().abs() <= LargestNumber).all();
}

/// A number for a message.
inline std::string Digits(double value, int significant = 6)
{
  char text[32];
  const auto end =
    std::to_chars(text, text + sizeof text, value, std::chars_format::general, significant).ptr;
  return { text, end };
}

/// The first numbers of a point for a message: "(1, 2.5)".
inline std::string PointText(const double* point, int count)
{
  std::string text = "(";
  for (int i = 0; i < count; ++i)
  {
    text += (i > 0 ? ", " : "") + Digits(point[i]);
  }
  return text + ")";
}

/// What to say about a value beyond the limit.
inline std::string BeyondLimit()
{
  return "a value is larger than " + Digits(LargestNumber) + "; choose a larger unit";
}
}
