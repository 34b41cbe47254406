// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "SurfaceGrowth.h"

#include <limits>

namespace knotwork
{
/// Of a curved surface at least, for each of its parameters.
inline constexpr int PointsOfParameter = 5;
inline constexpr int PointsOfFacet = 4; ///< of a plane that says little

/// The facets of a mesh as regions of one surface each.
struct Division
{
  std::vector<GrownRegion> Regions;
  std::vector<int> RegionOfCluster;
};

/// When a division stops, and leaves clusters without a region.
struct DivisionLimits
{
  std::size_t Most = std::numeric_limits<std::size_t>::max(); ///< regions
  /// Whether the first regions, of the largest facets, must cover half of the area: those of
  /// machined parts do, those of free shapes cover little each.
  bool CoversSoon = false;
};

/// Regions grown from the largest facets that are left, one after the other.
Division Divide(
  const SurfaceGrowth& growth, const FacetClusters& facets, const DivisionLimits& limits);

/// Triangles that are planes of their own for they sag too much, and whose corners lie on the
/// surface of a neighbour, go over to it: wide triangles between the holes of a cylinder. So do two
/// that noise makes one plane, where others of that surface sag as much: no flat on a shaft.
void TakeWideTriangles(const DiscMesh& surface, const FacetClusters& facets,
  const SurfaceGrowth& growth, double noise, Division& division);

/// Planes of four points say nothing where these are as near to the surface beside them as its own:
/// single strips that seemed flat.
void TakeStrips(const FacetClusters& facets, const SurfaceGrowth& growth, Division& division);

/// What is left of a curved surface when all but one facet have gone over to others is flat.
void FlattenSingles(const FacetClusters& facets, Division& division);

/// Curved surfaces become planes that are no worse: noise bends what is flat. The test is Fisher's,
/// of one per cent.
void FlattenDoubtful(const SurfaceGrowth& growth, Division& division);

/// A flat face between two roundings and the first strips of both lie on one wide cylinder, too:
/// where facets lie on larger curved regions beside it, and nearer to them by much than the largest
/// one sags from what it is said to lie on, they go over if the others are flat.
void ShareOut(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division);

/// Neighbours that are one surface become one region.
/// @param exact  whether points lie on surfaces but for rounding.
void JoinEqual(const DiscMesh& surface, const FacetClusters& facets, double noise, bool exact,
  const SurfaceGrowth& growth, Division& division);

/// Regions that have lost all clusters are dropped.
void DropEmpty(Division& division);

/// Surfaces that say what they are better than those that were grown: `SurfaceGrowth::Reconsider`.
void Reconsider(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division);

/// Clusters go over to regions beside them until nothing changes; regions that have lost all are
/// dropped.
void MoveBorders(const SurfaceGrowth& growth, const FacetClusters& facets, Division& division);
}
