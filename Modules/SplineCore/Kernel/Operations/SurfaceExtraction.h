// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/LROperations.h>

namespace knotwork
{
/// What to make of a surface, in this order.
struct ExtractionParams
{
  bool Restrict = false; ///< to Box, which becomes the domain
  ParametricBox<2> Box;
  bool Swap = false;                               ///< exchange the parameters
  std::array<bool, 2> Reverse{ { false, false } }; ///< parameters, as they are then
  bool MoveDomain = false;                         ///< to Domain, by scale and shift
  ParametricBox<2> Domain;
  bool ExpandToTensor = false; ///< LR surfaces; others are tensor products anyway
  /// Parameter that is constant on a curve, -1 for a surface.
  int IsoDirection = -1;
  double IsoValue = 0.0;
  int MaxFunctions = DefaultMaxFunctions; ///< of an expanded surface, >= 1
  int Threads = 0;                        ///< 0 = all cores; the result is the same for any number
};

/// The surface or curve. A tensor-product surface stays a tensor product.
/// @return what the functions of LROperations.h return; DimensionMismatch for hierarchical and
/// Bezier surfaces; InvalidKnots for a tensor product whose ends have not multiplicity p + 1.
Result<AnySpline> ExtractFromSurface(const Spline<2>& surface, const ExtractionParams& params);
}
