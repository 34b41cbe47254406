// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "MeshParameterization.h"

namespace knotwork
{
/// InvalidParameter for an option outside its range.
Status CheckFlattenParams(const FlattenParams& params);

/// One method, without a fallback. @return failures of the method; coordinates are finite.
Result<FlatMesh> RunFlattenMethod(
  const DiscMesh& mesh, FlattenMethod method, const FlattenParams& params);

/// Outer loop first: the one of the largest area in UV.
void SortLoopsByArea(DiscMesh& mesh, const PointMatrix& uv);
}
