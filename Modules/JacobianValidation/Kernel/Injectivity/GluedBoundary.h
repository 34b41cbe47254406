// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GluingState.h"

/// Private to the injectivity proof: what is left when sides are glued.
namespace knotwork
{
/// The sides that are not glued, with their points, edges and components.
void AssembleBoundary(GluingState& state);
}
