// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "FacetClusters.h"

namespace knotwork
{
/// Clusters of facets on one surface.
struct GrownRegion
{
  AnalyticSurface Surface;
  bool Reversed = false; ///< the facets' normals are opposite to the surface's
  std::vector<int> Clusters;
  int NumPoints = 0;
  double MeanSag = 0.0; ///< root mean square distance of the middles of the edges inside
};

/// Guesses surfaces at facets, and grows them.
class SurfaceGrowth
{
public:
  /// @param noise  largest distance of points. @param sag  of the middles of edges.
  /// What is given must outlive this.
  SurfaceGrowth(const DiscMesh& surface, const FacetClusters& facets, double noise, double sag);

  /// The simplest surface through a cluster that covers about as many points as any that was found.
  /// @param regions  of the clusters; those below 0 are to be had.
  GrownRegion BestRegion(int seed, const std::vector<int>& regions) const;

  /// Largest distances of points, and of the middles of edges and triangles.
  void Measure(const GrownRegion& region, double& distance, double& sag) const;

  /// Whether the points of a cluster are as near to a surface.
  bool IsWithin(int cluster, const AnalyticSurface& surface, double distance) const;
  /// Whether the facets of a cluster are so flat that their normals say nothing.
  bool IsSliver(int cluster) const;
  /// Whether a cluster may lie on a surface.
  bool Fits(int cluster, const AnalyticSurface& surface, bool reversed) const;
  /// How badly it does: mean square distance of its points, and what its lean adds.
  double Cost(int cluster, const AnalyticSurface& surface) const;
  /// Fits the surface to the region's points again.
  void Refit(GrownRegion& region) const;
  /// Takes the plane of a region that fits one.
  void Flatten(GrownRegion& region) const;
  /// Takes a cylinder, sphere or cone that the region lies on as well, if it is simpler than its
  /// surface and the edges inside are no farther from it, or a cone to which they are much nearer:
  /// a strip between two circles lies on many surfaces, but is straight on one.
  /// @param isSingleRow  all points lie in other regions, too: a chamfer rather than a zone of a
  /// sphere, so a cone to which the edges are no farther is enough.
  void Reconsider(bool isSingleRow, GrownRegion& region) const;
  /// Takes the surface of a profile next to the region's points.
  /// @param flat  a flag a cluster of all: it is part of a flat face, so that its edges lie on the
  /// surface. @return false: there is none on which all clusters lie; the region is as it was.
  bool FitProfile(SurfaceType type, const std::vector<char>& flat, GrownRegion& region) const;
  /// Takes the surface of a type next to all points of a region, if its clusters lie on it.
  /// @param parts  regions that it is made of: their surfaces, and circles through the points of
  /// each, are starts beside a guess.
  bool FitType(
    SurfaceType type, const std::vector<const GrownRegion*>& parts, GrownRegion& region) const;
  /// Sum of the squared distances of clusters' points from a surface.
  double Squares(const std::vector<int>& clusters, const AnalyticSurface& surface) const;
  double LengthOf(const ClusterSide& side) const
  {
    return (this->Surface.Point(side.Edge[0]) - this->Surface.Point(side.Edge[1])).norm();
  }
  /// Largest and root mean square distance of the region's points.
  std::array<double, 2> Residuals(const GrownRegion& region) const;

private:
  using Guess = std::vector<int>; ///< clusters
  bool Grow(const AnalyticSurface& guess, const Guess& from, const std::vector<int>& regions,
    GrownRegion& region) const;
  bool Try(SurfaceType type, const Guess& from, const std::vector<int>& regions,
    std::vector<GrownRegion>& found) const;
  /// A flat face and the first facets of a rounding beside it lie on a shallow sphere but for the
  /// noise: surfaces that leave the plane in its middle are dropped. The plane is the first of
  /// them.
  void DropThroughPlane(std::vector<GrownRegion>& found) const;
  void AddNeighbours(const std::vector<int>& regions, Guess& clusters) const;
  /// A region with a new surface takes the place of the one before where all of its clusters fit.
  bool Settle(GrownRegion& made, GrownRegion& region) const;
  /// Twice where they are of two facets, ascending.
  std::vector<std::array<int, 2>> EdgesOf(const std::vector<int>& clusters) const;
  /// Those of two facets.
  std::vector<std::array<int, 2>> EdgesInside(const std::vector<int>& clusters) const;
  double MeanSag(const GrownRegion& region) const;
  std::vector<int> NeighboursOf(int cluster, const std::vector<int>& regions) const;
  std::vector<int> PointIdsOf(const std::vector<int>& clusters) const; ///< ascending
  std::vector<Eigen::Vector3d> PointsOf(const std::vector<int>& clusters) const;
  std::vector<FlatPiece> PiecesOf(const std::vector<int>& clusters) const;

  const DiscMesh& Surface;
  const FacetClusters& Facets;
  double Noise;
  double Sag;
};
}
