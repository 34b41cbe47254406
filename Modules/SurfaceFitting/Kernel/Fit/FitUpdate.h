// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementFunctions.h"
#include "FitDivision.h"
#include "FitPoints.h"

namespace knotwork
{
/// What of a fit with a start stays: 1 where a function's coefficients are those of the start,
/// because no point that counts lies in its support, or because it does not vanish on a held edge
/// (for FitEdge::Derivatives: or its derivative across the edge does not).
std::vector<std::uint8_t> FindFixedFunctions(const SplineSpace<2>& space,
  const ElementFunctions& functions, const FitPoints& points, const std::array<FitEdge, 4>& edges,
  const FitDivision& division);

/// Whether a point lies on a held edge.
/// @param distance  from the edge that counts as on it, by direction.
bool IsOnHeldEdge(const ParametricBox<2>& domain, const std::array<FitEdge, 4>& edges,
  const RealArray<2>& distance, double u, double v);

/// The parameters with what the start decides: degree, domain, kind of the space.
/// @pre CheckStart. Without a start they are what they were.
FitParams WithStart(const FitParams& params);

/// @return what FitSurface returns of a start, and of edges without one.
Status CheckStart(const PointCloud& cloud, const FitParams& params);
}
