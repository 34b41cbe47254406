// SPDX-License-Identifier: BSD-3-Clause
#include "PatchDirections.h"

namespace knotwork
{
PatchDirections DirectionsOf(const PatchInterface& interface, int dimension)
{
  const auto& sides = interface.Sides;
  const auto direction = [&](std::size_t side, int along) // of the patch
  { return along < sides[side].Side / 2 ? along : along + 1; };
  PatchDirections found;
  found.Direction[AcrossSide(sides[0].Side)] = sides[1].Side / 2;
  found.Sense[AcrossSide(sides[0].Side)] = sides[0].Side % 2 != sides[1].Side % 2 ? 1 : 0;
  for (int k = 0; k + 1 < dimension; ++k)
  {
    const auto own = static_cast<std::size_t>(k);
    const auto first = static_cast<std::size_t>(direction(0, interface.Orientation.Axis[own]));
    found.Direction[first] = direction(1, k);
    found.Sense[first] = interface.Orientation.Reversed[own] ? 0 : 1;
  }
  return found;
}

bool SetDirections(const PatchDirections& directions, int dimension, PatchInterface& interface)
{
  const std::size_t across = AcrossSide(interface.Sides[0].Side);
  if (directions.Sense[across] != 0 && directions.Sense[across] != 1)
  {
    return false;
  }
  for (const SideOrientation& orientation : SideOrientations(dimension - 1))
  {
    interface.Orientation = orientation;
    PatchDirections made = DirectionsOf(interface, dimension);
    made.Sense[across] = directions.Sense[across];
    if (made.Direction == directions.Direction && made.Sense == directions.Sense)
    {
      return true;
    }
  }
  return false;
}
}
