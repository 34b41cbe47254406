// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "RegionChains.h"
#include "RegionEdges.h"

/// Private to ModelRegions: the loops of a region in the parameter plane of its surface.
namespace knotwork
{
enum class LoopStepKind
{
  Chain,
  Seam, ///< where a face that closes around is cut open
  Pole  ///< a side of one point
};

struct LoopStep
{
  LoopStepKind Kind = LoopStepKind::Chain;
  int Chain = -1;
  bool Reversed = false;
  std::array<Eigen::Vector2d, 2> Ends; ///< in the chain's, seam's or pole's own direction
};

struct RegionLoops
{
  AnalyticPatch Patch;
  bool Reversed = false; ///< the mesh's normals are opposite to the surface's
  int Winding = -1;      ///< the parameter around which the region closes, -1: none
  double Seam = 0.0;     ///< where it is cut open
  /// Of the loop that runs on once around, and of the one that runs back: its number, and its
  /// vertex at the seam. -1: there is a pole, or nothing.
  std::array<int, 2> Around{ -1, -1 };
  std::array<int, 2> SeamVertices{ -1, -1 };
  /// The outer loop first. Empty: the whole surface.
  std::vector<std::vector<LoopStep>> Steps;
};

/// Of regions that are there and are not of free form.
template <typename Regions>
std::vector<AnalyticSurface> SurfacesOf(
  const Regions& regions, const std::vector<AnalyticSurface>& surfaces)
{
  std::vector<AnalyticSurface> some;
  for (const int region : regions)
  {
    if (region >= 0 && surfaces[static_cast<std::size_t>(region)].Type != SurfaceType::FreeForm)
    {
      some.push_back(surfaces[static_cast<std::size_t>(region)]);
    }
  }
  return some;
}

/// Chooses the parameter plane of a region, and if the region closes around, where it is cut open:
/// chains get vertices there.
/// @param surfaces  of all regions. @param farthest  as of MoveOnto.
/// @return NotInSpace: the surface has no plane in which the region is a disc with holes.
Status OpenRegion(const std::vector<AnalyticSurface>& surfaces, int region, double farthest,
  RegionChains& chains, RegionLoops& loops);

/// Lays the loops out when all chains have their vertices and shapes, and sets the patch's range.
/// @return NotInSpace.
Status LayOutLoops(
  int region, const RegionChains& chains, const std::vector<EdgeShape>& shapes, RegionLoops& loops);
}
