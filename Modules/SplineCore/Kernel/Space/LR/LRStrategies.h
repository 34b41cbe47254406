// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <knotwork/SplineCore/LRRefinement.h>

namespace knotwork
{
/// How far the segments that halve an element or a function reach. All of them are legal in any
/// order.
/// @source  Johannessen, Kvamsdal, Dokken, CMAME 269 (2014) 471-514; Skytt, Dokken, "Scattered data
/// approximation by LR B-spline surfaces: a study on refinement strategies for efficient
/// approximation" (2022; full span does best, restricted mesh).
enum class LRStrategy
{
  FullSpan,       ///< across the supports of all functions alive on the element
  MinimumSpan,    ///< across the smallest support alive on the element
  StructuredMesh, ///< all knot spans of a function halved, across its support
  /// The knot spans of a function that hold marked elements halved, across its support, but for
  /// those of at most half the length of the longest of them.
  RestrictedMesh
};

struct LRStrategyParams
{
  LRStrategy Strategy = LRStrategy::FullSpan;
  /// Directions of the new lines: parameter 0 constant, parameter 1 constant. Alternating
  /// directions: one of them a step.
  std::array<bool, 2> Directions{ true, true };
};

/// Segments that halve elements in the chosen directions. StructuredMesh and RestrictedMesh take
/// the function of the smallest support on the element; with RestrictedMesh an element in a short
/// span waits until longer ones have been halved.
/// @param space  of kind LocallyRefined. @return DimensionMismatch, InvalidParameter for a bad id.
Result<std::vector<LRSegment>> SegmentsForElements(const SplineSpace<2>& space,
  const std::vector<int>& elements, const LRStrategyParams& params = {});

/// Segments that split functions. StructuredMesh halves every knot span, RestrictedMesh those
/// longer than half the longest one, MinimumSpan the longest one, all across the support; FullSpan
/// halves the elements of the support.
/// @return as SegmentsForElements.
Result<std::vector<LRSegment>> SegmentsForFunctions(const SplineSpace<2>& space,
  const std::vector<int>& functions, const LRStrategyParams& params = {});
}
