// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/MultiPatch.h>
#include <knotwork/SplineCore/TrimmedModel.h>

namespace knotwork
{
/// What the edges of a model state of whole sides of its surfaces: two sides are one where one edge
/// runs along both of them from end to end, at equal shares of their domains (but for 1e-9).
/// Patches are the faces.
PatchTopology SharedEdges(const TrimmedModel& model);
}
