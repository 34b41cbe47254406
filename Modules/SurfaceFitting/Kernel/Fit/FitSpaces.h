// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceFit.h"

namespace knotwork
{
/// The space of a fit and what is carried from one to the next, larger one.
struct FitState
{
  SplineSpacePtr<2> Space;
  PointMatrix Coefficients; ///< NumFunctions x c
  PointMatrix DomainPoints; ///< NumFunctions x 2
  PointMatrix Start;        ///< NumFunctions x columns of FitStart::Surface, in this space; 0 x 0
};

/// An element to be split and by lines of which directions (parameter 0 constant, 1 constant).
struct SplitMark
{
  int Element = 0;
  std::array<bool, 2> Directions{ true, true };
};

/// The first space: equal elements over a domain. Coefficients are 0.
Result<FitState> MakeFirstState(const FitParams& params, const ParametricBox<2>& domain,
  int numComponents, std::size_t numPoints);

/// The same of a fit with a start: its space and coefficients.
/// @return InvalidKnots.
Result<FitState> MakeStartState(const FitParams& params, int numComponents);

/// The same surface in a space in which elements are split.
/// @param iteration  that the space is for.
/// @return failures of the refinement; of ResolveDependence with params.Independent.
Result<FitState> RefineState(const FitState& state, const std::vector<SplitMark>& marks,
  int iteration, const FitParams& params);
}
