// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>

namespace knotwork
{
/// The name nearest to a word, by the fewest letters changed, inserted, left out or exchanged;
/// empty where none is near.
std::string NearestName(const std::string& word, const std::vector<std::string>& names);
}
