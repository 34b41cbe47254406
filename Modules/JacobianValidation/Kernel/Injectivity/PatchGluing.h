// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GluingState.h"

/// Private to the injectivity proof: what ids and parameters say.
namespace knotwork
{
/// Corners and edges that ids or parameters identify.
void JoinKnownPoints(GluingState& state);

/// Glues elements of one patch by their boxes.
void GlueBoxes(GluingState& state);
}
