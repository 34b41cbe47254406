// SPDX-License-Identifier: BSD-3-Clause
// Triangles around faults are replaced, private to the kernel.
#pragma once
#include "OngoingRepair.h"

namespace knotwork
{
/// The last way where sheets do not come apart: triangles around faults go and the holes are
/// closed, each time with more around what is left.
/// @return whether there are no faults any more.
/// @source Attene, A lightweight approach to repairing digitized polygon meshes, The Visual
/// Computer 26 (2010) 1393.
bool PatchFaults(RepairSoup& soup, OngoingRepair& repair);
}
