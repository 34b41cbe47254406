// SPDX-License-Identifier: BSD-3-Clause
#include "ReferenceSurface.h"

#include <Eigen/Geometry>

#include <cmath>

namespace knotwork
{
ReferenceSurface::ReferenceSurface(
  const DiscMesh& surface, const MeshFeatures& features, const std::vector<double>& sizes)
{
  std::vector<std::vector<MeshTriangle>> triangles(static_cast<std::size_t>(features.NumRegions));
  std::vector<std::vector<int>> ids(triangles.size());
  for (std::size_t t = 0; t < surface.Triangles.size(); ++t)
  {
    const auto region = static_cast<std::size_t>(features.Regions[t]);
    triangles[region].push_back(surface.Triangles[t]);
    ids[region].push_back(static_cast<int>(t));
  }
  std::vector<int> numbers(static_cast<std::size_t>(surface.NumPoints()), -1);
  for (std::size_t region = 0; region < triangles.size(); ++region)
  {
    this->Regions.push_back(MakePiece(surface, sizes, std::move(triangles[region]), numbers));
    this->Regions.back().TriangleIds = std::move(ids[region]);
  }
  for (const FeatureChain& chain : features.Chains)
  {
    std::vector<MeshTriangle> segments; // as triangles without an area
    const std::size_t n = chain.Points.size();
    for (std::size_t i = 0; i + (chain.Closed ? 0 : 1) < n; ++i)
    {
      segments.push_back({ chain.Points[i], chain.Points[(i + 1) % n], chain.Points[(i + 1) % n] });
    }
    this->Chains.push_back(MakePiece(surface, sizes, std::move(segments), numbers));
  }
}

/// @param numbers  all -1, before and after.
ReferenceSurface::Piece ReferenceSurface::MakePiece(const DiscMesh& surface,
  const std::vector<double>& sizes, std::vector<MeshTriangle> triangles, std::vector<int>& numbers)
{
  std::vector<int> used;
  for (MeshTriangle& corners : triangles)
  {
    for (int& corner : corners)
    {
      int& number = numbers[static_cast<std::size_t>(corner)];
      if (number < 0)
      {
        number = static_cast<int>(used.size());
        used.push_back(corner);
      }
      corner = number;
    }
  }
  Piece piece;
  PointMatrix points(static_cast<Eigen::Index>(used.size()), 3);
  for (std::size_t i = 0; i < used.size(); ++i)
  {
    points.row(static_cast<Eigen::Index>(i)) = surface.Points.row(used[i]);
    piece.Sizes.push_back(sizes[static_cast<std::size_t>(used[i])]);
    numbers[static_cast<std::size_t>(used[i])] = -1;
  }
  piece.Index = TriangleIndex<3>(std::move(points), std::move(triangles));
  return piece;
}

ReferenceFoot ReferenceSurface::Foot(const Piece& piece, const Eigen::Vector3d& point, int hint)
{
  TriangleFoot foot;
  if (hint >= 0)
  {
    // a little more, so that it is found again
    const double bound = piece.Index.Foot(hint, point.data()).SquaredDistance * (1.0 + 1e-12);
    foot = piece.Index.Nearest(point.data(), bound);
  }
  if (foot.Triangle < 0)
  {
    foot = piece.Index.Nearest(point.data());
  }
  ReferenceFoot found;
  found.Place = piece.Index.PointAt(foot.Triangle, foot.Second, foot.Third).transpose();
  found.Distance = std::sqrt(foot.SquaredDistance);
  found.Hint = foot.Triangle;
  const MeshTriangle& corners = piece.Index.Triangles()[static_cast<std::size_t>(foot.Triangle)];
  const auto size = [&](std::size_t k)
  { return piece.Sizes[static_cast<std::size_t>(corners[k])]; };
  found.Size =
    (1.0 - foot.Second - foot.Third) * size(0) + foot.Second * size(1) + foot.Third * size(2);
  using Map = Eigen::Map<const Eigen::Vector3d>;
  const Map a(piece.Index.Corner(foot.Triangle, 0));
  const Map b(piece.Index.Corner(foot.Triangle, 1));
  const Map c(piece.Index.Corner(foot.Triangle, 2));
  found.Normal = (b - a).cross(c - a).normalized();
  return found;
}
}
