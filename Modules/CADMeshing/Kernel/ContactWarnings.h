// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/CADModel/CADTopology.h>

namespace knotwork
{
/// A sentence on solids that touch in faces which they do not share, with the first pairs; none
/// where there are no such (CADTopology::TouchingSolids).
std::vector<std::string> ContactWarnings(const CADTopology& model);
}
