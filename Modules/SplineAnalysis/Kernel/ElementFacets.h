// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementRule.h"

/// What sides of elements have to do with each other.
namespace knotwork
{
/// Sides that do not lie inside a parameter domain.
struct MatchedSides
{
  std::vector<CellSide> Alone; ///< ascending
  std::vector<std::array<CellSide, 2>> Pairs;
};
/// Sides of two elements have their functions in common, those that are not 0 on the side, and its
/// middle. @return InvalidTopology for a side of three elements.
Result<MatchedSides> MatchSides(const GalerkinSpace& space);

/// Where two elements meet: a whole side of one of them at least.
struct InnerFacet
{
  std::array<CellSide, 2> Sides;
  /// The facet in the parameters of both: the same point of the unit interval, square or triangle
  /// is the same point of the body. The normal is the first one's, as long as the facet is large
  /// there.
  std::array<FacetFrame, 2> Frames;
};
/// Facets of all elements.
struct ElementFacets
{
  /// Matched sides, then those in parameter domains, also where elements of other levels meet a
  /// side in part.
  std::vector<InnerFacet> Inner;
  std::vector<CellSide> Boundary; ///< ascending
};
/// @param withSmooth  whether facets count that all functions are C^1 across.
/// @return as MatchSides.
/// @complexity O(n log n) for n sides of elements in the plane, O(n^(4/3)) in space.
Result<ElementFacets> FindFacets(const GalerkinSpace& space, bool withSmooth = true);
}
