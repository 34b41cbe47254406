// SPDX-License-Identifier: BSD-3-Clause
// Triangles and parts of a surface that go or are turned over, private to the kernel.
#pragma once
#include "OngoingRepair.h"

namespace knotwork
{
/// Takes triangles without an area away and turns the others alike; where the surface is not closed
/// or its triangles do not run alike, of those on top of each other one stays.
/// @return EmptyInput: nothing is left; InvalidTopology of OrientSoup.
Status CleanSoup(RepairSoup& soup, OngoingRepair& repair);

/// Of triangles of the same corners the first one stays.
void DropDuplicates(RepairSoup& soup, OngoingRepair& repair);

/// Turns triangles so that they run alike.
/// @return InvalidTopology: the surface has one side.
Status OrientSoup(RepairSoup& soup, OngoingRepair& repair);

/// Edges and heights that are all but nothing go, with the triangles that have them.
/// @return whether there were any.
bool DropSlivers(RepairSoup& soup, OngoingRepair& repair);

/// Parts of a smaller diameter than SmallestPart go; of a closed surface the others are turned so
/// that those in an even number of others enclose a volume, those in an odd number a void - but not
/// where this is all that is wrong and concerns every part.
/// @return InvalidTopology: nothing is left.
Status SettleParts(RepairSoup& soup, OngoingRepair& repair);
}
