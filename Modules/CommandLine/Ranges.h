// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <CLI/CLI.hpp>

#include <limits>
#include <sstream>
#include <string>
#include <type_traits>

namespace knotwork
{
/// Refuses numbers outside [low, high]. Bounds that stand for none are not shown: help and errors
/// say "0 to 9", "at least 0" or "at most 0".
template <typename T>
CLI::Validator InRange(T low, T high)
{
  // VTK's largest double is far below the type's
  constexpr T Largest = std::is_floating_point_v<T> ? T(1e299) : std::numeric_limits<T>::max();
  const auto text = [](T bound)
  {
    std::ostringstream stream;
    stream << bound;
    return stream.str();
  };
  const std::string range = high >= Largest ? "at least " + text(low)
    : low <= -Largest                       ? "at most " + text(high)
                                            : text(low) + " to " + text(high);
  const auto check = [low, high, range](const std::string& word)
  {
    T value{};
    // NaN is for the filter to refuse
    const bool isOutside = !CLI::detail::lexical_cast(word, value) || value < low || value > high;
    return isOutside ? "'" + word + "' is no number in the range: " + range : std::string();
  };
  return CLI::Validator(check, range);
}
}
