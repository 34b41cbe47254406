// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "GluingState.h"

/// Private to the injectivity proof: sides that have the same control points.
namespace knotwork
{
/// Glues sides whose control points agree bit by bit.
void GlueEqual(GluingState& state);

/// Glues what agrees up to rounding.
void GlueNear(GluingState& state);
}
