// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "TriangleMesh.h"

namespace knotwork
{
/// Whether boundary edges cross each other in the plane (common ends do not count). A map without
/// flips whose boundary does not cross itself is injective.
/// @complexity O(n log n) when few edges are near each other.
bool LoopsCross(const DiscMesh& mesh, const PointMatrix& uv);
}
