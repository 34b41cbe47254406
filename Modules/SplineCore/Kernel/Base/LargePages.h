// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>

namespace knotwork
{
/// Asks the system for large pages below an array of many megabytes that is about to be written for
/// the first time: the first touch of each page costs a microsecond, and scattered access finds
/// large ones faster. A request: no effect where the system has none.
void PreferLargePages(void* array, std::size_t bytes);
}
