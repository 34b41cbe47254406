// SPDX-License-Identifier: BSD-3-Clause
// Tetrahedra that no curving can make valid, private to the kernel.
#pragma once
#include "SolidMesh.h"

namespace knotwork
{
/// Divides cells with a corner whose three edges all run along the surface and are nearly in a
/// plane there: on a smooth target these edges become tangent to it, so that det J is 0 at the
/// corner, wherever points inside are. The longest edge against the corner that is inside is halved
/// for all its cells, or, where there is none, the cell gets a point in its middle.
/// @param maxPoints  that are added at most. @return how many were.
int DivideFlatCorners(Tetrahedra& mesh, int maxPoints);
}
