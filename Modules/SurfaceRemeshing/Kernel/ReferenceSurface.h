// SPDX-License-Identifier: BSD-3-Clause
// The surface that points move on, private to the kernel.
#pragma once
#include <knotwork/MeshParameterization/MeshFeatures.h>
#include <knotwork/SplineCore/TriangleIndex.h>

namespace knotwork
{
/// The nearest point of a region or a chain of sharp edges.
struct ReferenceFoot
{
  Eigen::Vector3d Place = Eigen::Vector3d::Zero();
  Eigen::Vector3d Normal = Eigen::Vector3d::Zero(); ///< of the triangle; of chains none
  double Size = 0.0;                                ///< of edges there
  double Distance = 0.0;
  int Hint = -1; ///< begins the next search nearby
};

/// A surface with an index for each region between sharp edges, so that a point of one side of an
/// edge, or of a sheet, is never taken to the other, and one for each chain of edges.
class ReferenceSurface
{
public:
  /// @param sizes  of edges, one a point.
  ReferenceSurface(
    const DiscMesh& surface, const MeshFeatures& features, const std::vector<double>& sizes);

  /// @param hint  of a foot on the same region; -1: none.
  ReferenceFoot OnRegion(int region, const Eigen::Vector3d& point, int hint = -1) const
  {
    return Foot(this->Regions[static_cast<std::size_t>(region)], point, hint);
  }
  ReferenceFoot OnChain(int chain, const Eigen::Vector3d& point) const
  {
    return Foot(this->Chains[static_cast<std::size_t>(chain)], point, -1);
  }
  /// Triangle of the surface of a hint.
  int TriangleOf(int region, int hint) const
  {
    return this->Regions[static_cast<std::size_t>(region)]
      .TriangleIds[static_cast<std::size_t>(hint)];
  }

private:
  struct Piece
  {
    TriangleIndex<3> Index;
    std::vector<double> Sizes;    ///< one a point
    std::vector<int> TriangleIds; ///< of the surface, none of chains
  };
  static Piece MakePiece(const DiscMesh& surface, const std::vector<double>& sizes,
    std::vector<MeshTriangle> triangles, std::vector<int>& numbers);
  static ReferenceFoot Foot(const Piece& piece, const Eigen::Vector3d& point, int hint);

  std::vector<Piece> Regions;
  std::vector<Piece> Chains;
};
}
