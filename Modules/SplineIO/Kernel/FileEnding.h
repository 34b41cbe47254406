// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

namespace knotwork
{
/// What follows the last point of a file's name, with the point, in small letters; empty without.
/// Points of folders do not count.
std::string LowerEnding(const std::string& file);
}
