// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "PointSlide.h"
#include <knotwork/SplineCore/CellMesh.h>
#include <knotwork/SplineCore/TriangleIndex.h>

#include <Eigen/Core>

namespace knotwork
{
/// A quadrilateral of the surface of a mesh.
struct SurfaceQuad
{
  std::array<int, 4> Corners; ///< in cyclic order
  bool IsFolded;              ///< it, or the hexahedron that it is a face of
};

/// How far the points of a mesh may move without a change of its shape: those of a surface slide
/// on it, those of sharp edges and of rims along them, corners stay.
class MeshSlide final : public PointSlide
{
public:
  enum class Freedom : std::uint8_t
  {
    Space,   ///< inside of hexahedra
    Plane,   ///< inside of quadrilaterals whose points have one third coordinate
    Surface, ///< on the surface, within what its sharp edges bound
    Edge,    ///< along a sharp edge or a rim
    None     ///< where edges end, cross, or turn sharply
  };

  /// @param quads  the quadrilaterals, or the boundary of the hexahedra.
  /// @param points  n x 3, finite.
  /// @param angle  degrees between normals from which on an edge is sharp; normals that are
  /// opposite beside a folded cell say that it has turned over, not that the edge is sharp.
  /// @param marked  edges that are sharp at any angle.
  MeshSlide(const std::vector<SurfaceQuad>& quads, const PointMatrix& points, double angle,
    const std::vector<std::array<int, 2>>& marked);

  Freedom Of(int point) const { return this->Freedoms[static_cast<std::size_t>(point)]; }
  bool IsFixed(int point) const override { return this->Of(point) == Freedom::None; }
  Eigen::RowVector3d Nearest(int point, const Eigen::RowVector3d& at) const override;
  Eigen::Matrix<double, 3, Eigen::Dynamic> Directions(
    int point, const Eigen::RowVector3d& at) const override;

private:
  using Edge = std::array<int, 2>;
  /// Degrees between edges of a chain from which on their common point is a corner.
  static constexpr double CornerAngle = 30.0;
  /// Degrees from which on normals, and edges of a chain, beside a folded cell are opposite.
  static constexpr double OppositeAngle = 170.0;

  const TriangleIndex<3>& GuideOf(int point) const
  {
    return this->Guides[static_cast<std::size_t>(this->Guide[static_cast<std::size_t>(point)])];
  }
  std::vector<Edge> FindEdges(const std::vector<SurfaceQuad>& quads, const PointMatrix& points,
    double angle, const std::vector<Edge>& marked, std::vector<int>& region) const;
  void FindCorners(const std::vector<SurfaceQuad>& quads, const std::vector<Edge>& edges,
    const PointMatrix& points);
  void MakeRegions(const std::vector<SurfaceQuad>& quads, const PointMatrix& points,
    const std::vector<int>& region);
  void MakeChains(const std::vector<Edge>& edges, const PointMatrix& points);

  std::vector<Freedom> Freedoms;
  std::vector<int> Guide; ///< what a point slides on, -1: nothing
  std::vector<TriangleIndex<3>> Guides;
};
}
