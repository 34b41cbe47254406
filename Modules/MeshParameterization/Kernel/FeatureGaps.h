// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FeatureEdges.h"

namespace knotwork
{
/// Points of the shortest way along edges between two points of a surface, both included; empty:
/// there is none.
std::vector<int> ShortestWay(const DiscMesh& surface, int from, int to);

struct GapParams
{
  double Length = 0.0;     ///< of a gap at most, unit of the points
  double LeastAngle = 0.0; ///< degrees that each edge of a gap has at least
};

/// Marks the ways that close gaps in chains: from a point where a chain ends within a region along
/// edges of LeastAngle at least to the nearest point of another chain, of a rim, or of its own
/// chain where that is three times as far along the chain. The way is no longer than Length and the
/// chain; it begins and ends within 60 degrees of the chain's direction.
/// @return number of gaps that were closed.
int CloseGaps(
  const SurfaceParts& parts, const EdgeAngle& angle, const GapParams& params, EdgeMarks& marks);

/// Takes marks of chains away that end within a region and are shorter than the patches which the
/// normals beside them were fitted to: they are noise.
/// @param sizes  one a triangle: diameter of its patch; 0: its normal is its own.
/// @param kept  edges that stay.
void DropSpurs(const SurfaceParts& parts, const std::vector<double>& sizes, const EdgeMarks& kept,
  EdgeMarks& marks);
}
