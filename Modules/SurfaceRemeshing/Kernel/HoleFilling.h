// SPDX-License-Identifier: BSD-3-Clause
// Triangles between the points of a rim, private to the kernel.
#pragma once
#include <knotwork/SplineCore/TriangleIndex.h>

namespace knotwork
{
/// Triangles of numbers in the rim, of least angles between them and with the surface beside it;
/// they run with the rim. Empty when there are none.
/// @param apexes  third corners of the surface's triangles at the edges that begin at the points.
/// @source Liepa, SGP 2003; Zou, Ju, Carr, CGF 32 (2013) 157.
std::vector<MeshTriangle> FillRim(const PointMatrix& rim, const PointMatrix& apexes);
}
