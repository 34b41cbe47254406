// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshParameterization.h"

namespace knotwork
{
/// Places images of charts in rows, the highest ones first, longer axes along u, so that their
/// boxes have gaps between them; centred at the origin. A single one stays as it is.
void PlaceSideBySide(std::vector<MeshParameterization>& charts);
}
