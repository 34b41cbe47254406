// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GluingState.h"

/// Private to the injectivity proof: sides and edges that are points.
namespace knotwork
{
/// Sides whose image has no area count for nothing in the degree; what they identify is joined.
void RemoveCollapsed(GluingState& state);

/// An edge with glued sides alone around it is inside of the solid; when it is a point, all of
/// its points have one image. Edges of sides that dropped out, or that finer sides cover, may lie
/// on the boundary: they are left alone.
void FindInnerPoint(GluingState& state);
}
