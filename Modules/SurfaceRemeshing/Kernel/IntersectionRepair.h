// SPDX-License-Identifier: BSD-3-Clause
// Triangles that meet where they should not come apart, private to the kernel.
#pragma once
#include "OngoingRepair.h"

namespace knotwork
{
/// Divides triangles where they meet, chooses sheets and moves these apart; where they do not come
/// apart, what is around them is closed anew. Slivers go.
/// @return failures of ArrangeSheets; InvalidTopology: an open surface that meets itself, edges
/// that cannot be joined; NotConverged: places where it still meets itself; Aborted.
Status RepairIntersections(RepairSoup& soup, OngoingRepair& repair);
}
