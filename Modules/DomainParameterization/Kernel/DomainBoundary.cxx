// SPDX-License-Identifier: BSD-3-Clause
#include "DomainBoundary.h"
#include "DomainParameterization.h"

namespace knotwork
{
template <>
std::string SideName<2>(int side)
{
  constexpr const char* names[4] = { "west (u = 0)", "east (u = 1)", "south (v = 0)",
    "north (v = 1)" };
  return side >= 0 && side < 4 ? names[side] : "no side";
}
template <>
std::string SideName<3>(int side)
{
  constexpr const char* names[6] = { "face u = 0", "face u = 1", "face v = 0", "face v = 1",
    "face w = 0", "face w = 1" };
  return side >= 0 && side < 6 ? names[side] : "no side";
}
}
