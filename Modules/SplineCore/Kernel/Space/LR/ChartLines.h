// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <vector>

namespace knotwork
{
/// Whole-number positions of mesh lines of any spacing, for charts of locally refined spaces: they
/// ascend, are multiples of 2^12, and a line halfway between others is exactly halfway between
/// their numbers, so that the points of elements which halve each other meet. Other positions are
/// proportional to the values up to rounding, 2^-30 of the whole.
/// @param values  strictly ascending, at least 2.
std::vector<std::int64_t> ChartLines(const std::vector<double>& values);
}
