// SPDX-License-Identifier: BSD-3-Clause
// Fewer triangles of the same surface, private to the kernel.
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

#include <vector>

namespace knotwork
{
/// Collapses edges of a closed manifold, those first that change shape and volume least, until so
/// many triangles are left or no edge can be collapsed without changing the topology or turning a
/// triangle over. Points that are no longer used go.
/// @param wanted  triangles, >= 4; with as many or fewer nothing is done.
/// @source  Lindstrom, Turk, Fast and memory efficient polygonal simplification, IEEE Visualization
/// 1998, as CGAL has it.
void CollapseEdges(int wanted, PointMatrix& points, std::vector<MeshTriangle>& triangles);
}
