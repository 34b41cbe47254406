// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <charconv>
#include <string>

namespace knotwork
{
/// A number for a sentence: six significant digits.
inline std::string NumberText(double value)
{
  char text[32];
  const auto end =
    std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr;
  return std::string(text, end);
}
}
