// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "ElementRule.h"
#include "GalerkinProblem.h"

/// Edges of bodies in space.
namespace knotwork
{
/// An edge of a facet.
struct FacetEdge
{
  ElementEdge Place;
  std::vector<int> Functions;        ///< that are not 0 on it, ascending
  std::array<int, 2> Ends{ -1, -1 }; ///< functions that are 1 at its ends, ascending; -1: none
};

/// Whether an edge is wanted. @param facet  that it is an edge of. @param samples  parameters of
/// its ends and middle.
using EdgeFilter = std::function<bool(const CellSide& facet, const FacetEdge& edge,
  const std::array<std::array<double, 3>, 3>& samples)>;

/// Edges of facets that are wanted, each once; where elements of several levels of a patch meet
/// along an edge, those of the smaller ones.
/// @complexity O(n log n) for n edges whose functions differ.
std::vector<FacetEdge> ChooseEdges(
  const GalerkinSpace& space, const std::vector<CellSide>& facets, const EdgeFilter& filter);

/// Calls for Gauss points of an edge with the lengths that they stand for. @param tolerance  as
/// NumRulePoints.
void VisitEdge(const GalerkinSpace& space, const ElementEdge& edge, double tolerance,
  const std::function<void(double length, const PointValues& values)>& visit);
}
