// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

namespace knotwork
{
/// A message as one line of valid UTF-8 that a terminal shows as it is: control characters, marks
/// that turn the direction of writing and bytes that are no UTF-8 are written as `\n`, `\t`, `\x1b`
/// or `\u202e`; words of more than 300 bytes and messages of more than 2000 lose their middle.
/// @complexity linear
std::string OneLine(const std::string& message);
}
