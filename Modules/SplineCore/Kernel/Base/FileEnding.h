// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

namespace knotwork
{
/// The extension of a file name in lower case, with its dot; empty without one.
/// Points of folders do not count.
std::string LowerEnding(const std::string& file);
}
