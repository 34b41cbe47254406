// SPDX-License-Identifier: BSD-3-Clause
// Edges of one triangle are joined to others or closed, private to the kernel.
#pragma once
#include "OngoingRepair.h"

#include <map>

namespace knotwork
{
/// Joins open edges to what they meet, takes loose pieces away and closes holes.
/// @return failures of DivideTriangles and OrientSoup; InvalidTopology: open edges that make no
/// rim, holes that stay and may not.
Status CloseOpenEdges(RepairSoup& soup, OngoingRepair& repair);

/// Third corners of triangles by their open edges, as they run.
std::map<std::pair<int, int>, int> ApexesOf(const RepairSoup& soup, const SoupDefects& defects);

/// Adds triangles between the points of a rim.
/// @param rim  of TraceRims. @param apexes  of ApexesOf.
/// @return whether there are any; if not, nothing is added.
bool FillHole(
  RepairSoup& soup, std::vector<int> rim, const std::map<std::pair<int, int>, int>& apexes);
}
